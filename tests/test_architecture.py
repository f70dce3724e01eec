"""The packages' directions, read from their imports, and what serving pages must not load."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MAY_IMPORT = {"policies": set[str](), "analysis": set[str](), "app": {"policies", "analysis"}}
FILES = sorted(file for package in MAY_IMPORT for file in (ROOT / package).rglob("*.py"))


def module_of(file: Path) -> str:
    parts = file.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_of(file) for file in FILES}


def imports_of(file: Path) -> Iterator[str]:
    """Modules of ours that a file imports, anywhere in it."""
    package = module_of(file) if file.stem == "__init__" else module_of(file).rpartition(".")[0]
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package.rsplit(".", node.level - 1)[0] if node.level else ""
            source = ".".join(filter(None, (base, node.module)))
            for alias in node.names:
                whole = f"{source}.{alias.name}"
                yield whole if whole in MODULES else source


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(ROOT)))
def test_a_file_imports_only_what_its_package_may(file):
    own = file.relative_to(ROOT).parts[0]
    for name in imports_of(file):
        package = name.partition(".")[0]
        assert package == own or package not in MAY_IMPORT or package in MAY_IMPORT[own], name
        assert package != "tests", name


@pytest.mark.parametrize("file", [f for f in FILES if "app" in f.parts], ids=lambda f: f.stem)
def test_the_app_uses_only_public_names_of_the_other_packages(file):
    foreign = {name for name in imports_of(file) if name.startswith(("policies", "analysis"))}
    assert foreign <= {"policies", "analysis"}


@pytest.mark.parametrize("package", sorted(MAY_IMPORT))
def test_no_package_imports_in_a_circle(package):
    graph = {
        module_of(file): {name for name in imports_of(file) if name in MODULES}
        for file in FILES
        if file.relative_to(ROOT).parts[0] == package
    }
    done: set[str] = set()
    while len(done) < len(graph):
        ready = {name for name in graph if name not in done and graph[name] & set(graph) <= done}
        assert ready, f"a circle among {sorted(set(graph) - done)}"
        done |= ready


def test_serving_pages_loads_no_heavy_library(tmp_path):
    code = f"""
import sys
from starlette.testclient import TestClient
from app.main import create_app
from app.settings import Settings
url = "sqlite:///{tmp_path}/study.sqlite"
with TestClient(create_app(Settings(database_url=url))) as client:
    assert client.get("/").status_code == 200
heavy = {{"scipy", "polars", "matplotlib", "numba", "statsmodels", "pandas"}}
print(sorted(heavy & set(sys.modules)))
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert done.stdout.strip() == "[]"
