import ast
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import policies

PACKAGE = Path(policies.__file__).parent
MODULES = {
    ".".join(("policies", *path.relative_to(PACKAGE).with_suffix("").parts)): path
    for path in sorted(PACKAGE.rglob("*.py"))
    if not path.stem.startswith("__")
}


def imported(path: Path) -> set[str]:
    """The modules that a file imports, wherever in it the import stands."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module)
    return found


def test_imports_run_one_way():
    graph = {
        name: {module for module in imported(path) if module.startswith("policies.")}
        for name, path in MODULES.items()
    }
    assert set(TopologicalSorter(graph).static_order()) == set(MODULES)


@pytest.mark.parametrize("name", MODULES)
def test_nothing_of_the_other_packages_is_imported(name):
    tops = {module.split(".")[0] for module in imported(MODULES[name])}
    assert not tops & {"app", "analysis"}


@pytest.mark.parametrize("name", dir(policies))
def test_every_public_name_loads(name):
    assert getattr(policies, name) is not None


def test_the_stub_and_the_package_list_the_same_names():
    tree = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    stub = {a.asname or a.name for n in tree.body if isinstance(n, ast.ImportFrom) for a in n.names}
    assert stub == set(dir(policies))


@pytest.mark.parametrize("name", ["commands", "load_pool", "CONDITIONS", "PolicyError", "Pool"])
def test_light_names_load_no_numerical_library(name):
    code = (
        f"import sys; from policies import {name};"
        "sys.exit(any(m in sys.modules for m in ('numpy', 'scipy', 'matplotlib')))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
