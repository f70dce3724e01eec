"""README.md: its commands work, its settings are the settings there are."""

import json
import os
import re
import shlex
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from app.settings import Settings

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```sh\n(.*?)^```", README, re.MULTILINE | re.DOTALL)
COMMANDS = [line for block in BLOCKS for line in block.splitlines()]
ELSEWHERE = {
    "git clone <this repository> goalguess && cd goalguess": "the checkout that is tested",
    "make test": "the run that runs this test",
    "make serve": "test_make_serve_prints_the_address_of_a_study_that_answers",
    "goalguess serve --host 0.0.0.0 --port 8000": "test_wheel, on a free port",
}
NEEDS = {
    "goalguess analyse results --to report": ["goalguess export --to results"],
    "goalguess analyse rehearsal --simulated --to rehearsal-report": [
        "goalguess simulate --participants 8",
        "goalguess export --to rehearsal --simulated",
    ],
    "goalguess backup --to backup.sqlite": ["rm -f backup.sqlite"],
    "goalguess restore backup.sqlite": [
        "rm -f backup.sqlite",
        "goalguess backup --to backup.sqlite",
    ],
}
"""What must have been run before a command that reads its files."""
SMALLER = {
    "--pairs 100 --simulations 500": "--pairs 2 --simulations 20",
    "teach samples": "teach samples --sets 3",
    "--starts 25": "--starts 2",
    "--sets 50": "--sets 2",
    "--participants 40,60": "--participants 8 --simulations 5",
    "--tests two_way_difference,two_way_auc": "--tests two_way_difference --replicates 5",
}
"""What keeps a command that takes minutes short in a test."""
BIN = Path(sys.executable).parent


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder to run commands in, with what the README's commands read."""
    folder = tmp_path_factory.mktemp("readme")
    for name in ("analysis", "policies", "tests"):
        (folder / name).symlink_to(ROOT / name)
    return folder


@pytest.fixture(scope="module")
def environment(folder):
    variables = {k: v for k, v in os.environ.items() if not k.startswith("GOALGUESS_")}
    return {**variables, "PATH": f"{BIN}:{variables['PATH']}", "MPLCONFIGDIR": str(folder)}


@pytest.fixture(scope="module")
def recorded(folder, environment):
    """A few participants, so that there is something to export and analyse."""
    code = (
        "from tests.app.conftest import *\n"
        "settings = Settings(database_url='sqlite:///goalguess.sqlite', seed=1)\n"
        "with TestClient(create_app(settings), base_url=ORIGIN) as client:\n"
        "    for link in ('?PROLIFIC_PID=5f1e0c2a9b3d4e6f7a8b9c0d', '', '', ''):\n"
        "        Browser(TestClient(client.app, base_url=ORIGIN)).take_part(link)\n"
    )
    subprocess.run([sys.executable, "-c", code], cwd=folder, env=environment, check=True)


def test_every_command_is_run_by_a_test():
    runnable = [command for command in COMMANDS if command.startswith("goalguess ")]
    assert set(COMMANDS) - set(runnable) <= set(ELSEWHERE)
    assert set(ELSEWHERE) <= set(COMMANDS)


@pytest.mark.usefixtures("recorded")
@pytest.mark.parametrize("command", [c for c in COMMANDS if c not in ELSEWHERE])
def test_a_command_of_the_readme_works(command, folder, environment):
    for before in NEEDS.get(command, ()):
        subprocess.run(shlex.split(before), cwd=folder, env=environment, check=True)
    if command.startswith("goalguess stimuli build"):
        command += " --to built"
    for long, short in SMALLER.items():
        command = command.replace(long, short)
    done = subprocess.run(
        shlex.split(command),
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_the_table_of_settings_is_complete_and_right():
    rows = re.findall(r"^\| `GOALGUESS_(\w+)` \|(.*?)\| (.*?) \|$", README, re.MULTILINE)
    documented = {name.lower(): (default.strip(" `"), text) for name, default, text in rows}
    declared = {
        name: ("" if field.default in (None, "") else str(field.default), field.description)
        for name, field in Settings.model_fields.items()
    }
    assert documented == declared


def test_make_serve_prints_the_address_of_a_study_that_answers(tmp_path, environment):
    url = f"sqlite:///{tmp_path}/study.sqlite"
    with subprocess.Popen(
        ["make", "serve", "PORT=0"],
        cwd=ROOT,
        env={**environment, "GOALGUESS_DATABASE_URL": url, "PYTHONUNBUFFERED": "1"},
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as server:
        try:
            assert server.stdout
            found = (re.search(r"http://\S+", line) for line in server.stdout)
            address = next(match[0] for match in found if match)
            page = urllib.request.urlopen(address, timeout=30).read().decode()
        finally:
            os.killpg(server.pid, 15)
    assert "I agree and take part" in page


def test_files_and_links_of_the_readme_exist():
    for target in re.findall(r"\]\((?!http)(.*?)\)", README):
        assert (ROOT / target).exists(), target


def test_tests_and_benchmarks_named_in_the_readme_exist():
    files = set(re.findall(r"`((?:\w+/)*\w+\.py)`", README))
    modules = {f"{name.replace('.', '/')}.py" for name in re.findall(r"python -m ([\w.]+)", README)}
    folders = ("app", "analysis", "policies", "tests")
    paths = [str(p.relative_to(ROOT)) for name in folders for p in (ROOT / name).rglob("*.py")]
    assert files | modules
    for name in files | modules:
        assert any(path == name or path.endswith(f"/{name}") for path in paths), name


def test_numbers_of_the_readme_are_those_of_the_pool():
    pool = json.loads((ROOT / "policies/stimuli/manifest.json").read_text(encoding="utf-8"))
    assert f"stimuli build --seed {pool['seed']}" in README
