"""Wrong uses of every command: exit code 2, one line, no traceback, no inner names."""

import re
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from app import cli
from tests.browser.serving import served

ROOT = Path(__file__).parents[2]
FILES = {
    "MAZE": ROOT / "policies/mazes/wings.txt",
    "TABLE": ROOT / "tests/analysis/paper_fixture.csv",
}
INNER = re.compile(r"Errno|Traceback|[╭│]|/tmp\w{8}\b|\.tmp\b|File \"")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder to be in, with what is often there in place of what was meant."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "broken.json").write_text("{")
    (tmp_path / "broken.toml").write_text("x = = 1")
    (tmp_path / "maze.txt").write_text("nonsense")
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    return tmp_path


def says(capsys, *words):
    """What a wrong use says, on stderr alone."""
    code, said = ended(capsys, words)
    assert (code, said.out) == (2, "")
    return said.err


def ended(capsys, words):
    """The exit code of the command line, and what it said."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["goalguess", *map(str, words)])
        with pytest.raises(SystemExit) as end:
            cli.main()
    return end.value.code or 0, capsys.readouterr()


WRONG = [
    "--nothing",
    "nothing",
    "serv",
    "serve --prot 3",
    "serve --port",
    "serve --port x",
    "serve --port 70000",
    "serve --host no.such.host.invalid",
    "serve --host 192.0.2.1",
    "serve --host 999.1.1.1",
    "serve extra",
    "export",
    "export --to",
    "backup",
    "backup --to copy.sqlite",
    "restore none",
    "restore folder",
    "restore file",
    "recruits --csv folder",
    "withdraw",
    "withdraw --recruiter-id x",
    "simulate --participants 0",
    "simulate --mix",
    "simulate --mix attentive=x",
    "simulate --seed -1",
    "simulate --url nonsense",
    "simulate --url http://no.such.host.invalid/",
    "simulate --url http://127.0.0.1:9/",
    "simulate --url ftp://study.test",
    "solve",
    "solve maze.txt",
    "solve maze.txt --goal A",
    "solve none.txt --goal A",
    "solve folder --goal A",
    "solve MAZE --goal Q",
    "solve MAZE --goal A --beta x",
    "solve MAZE --goal A --formulation z",
    "solve MAZE --goal A --json folder",
    "solve MAZE --goal A --json none/solved.json",
    "solve MAZE --goal A --json file/solved.json",
    "stimuli nothing",
    "stimuli check none",
    "stimuli check folder",
    "stimuli check file",
    "stimuli show",
    "stimuli show zz",
    "stimuli sheet --to pool.bmp",
    "stimuli sheet --to none/pool.svg",
    "stimuli build --to file",
    "stimuli build --seed x",
    "compare",
    "compare nothing",
    "compare goals --pairs x",
    "compare goals --mazes none",
    "compare goals --mazes folder",
    "compare goals --mazes file",
    "teach nothing",
    "teach samples --sets x",
    "teach samples --predictor z",
    "analyse",
    "analyse none",
    "analyse folder",
    "analyse file",
    "analyse other.csv",
    "analyse broken.json",
    "analyse TABLE --plan none",
    "analyse TABLE --plan folder",
    "analyse TABLE --plan broken.toml",
    "analyse TABLE --mapping broken.toml",
    "power --measure z",
    "power --measure correct --p1 2 --p2 .5",
    "power --participants x",
    "level --sds a",
    "level --tests z",
    "reconstruct",
    "reconstruct --chi2 x",
]


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("words", WRONG)
def test_a_wrong_use_is_told_in_one_line_that_begins_with_our_name(capsys, words):
    said = says(capsys, *(FILES.get(word, word) for word in words.split()))
    assert said.startswith("goalguess: ")
    assert said.count("\n") == 1
    assert not INNER.search(said), said


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("variable", "value", "message"),
    [
        ("CODES", "C1", '{"completed": "C1A2B3"}'),
        ("CODES", "[1]", '{"completed": "C1A2B3"}'),
        ("CODES", '{"finished": "C1"}', '{"completed": "C1A2B3"}'),
        ("RETURN_URL", "javascript:alert(1)", "begins with https://"),
        ("RETURN_URL", "JavaScript://host/%0aalert(1)", "begins with https://"),
        ("RETURN_URL", "data:text/html,x", "begins with https://"),
        ("RETURN_URL", "https:///no/host", "begins with https://"),
        ("RETURN_URL", "//host/path", "begins with https://"),
        ("RETURN_URL", "http://[", "begins with https://"),
        ("ROOT_PATH", "study", "a path like /study"),
        ("ROOT_PATH", "/study/", "a path like /study"),
        ("ROOT_PATH", "/trial", "none of the study's own"),
        ("KEEP_ALIVE_S", "0", "KEEP_ALIVE_S"),
        ("WITHDRAWALS", "folder", "folder: "),
        ("DATABASE_URL", "sqlite:///folder", "folder: "),
        ("DATABASE_URL", "sqlite:///other.csv", "other.csv: "),
        ("DATABASE_URL", "sqlite:///none/study.sqlite", "none/study.sqlite: "),
        ("DATABASE_URL", "postgres://host/study", "expected a SQLite file"),
        ("NOTHING", "1", "GOALGUESS_NOTHING: expected one of"),
    ],
)
def test_a_wrong_setting_is_told_in_one_line(capsys, monkeypatch, variable, value, message):
    monkeypatch.setenv(f"GOALGUESS_{variable}", value)
    said = says(capsys, "serve", "--port", 0)
    assert said.startswith("goalguess: ")
    assert said.count("\n") == 1
    assert message in said
    assert not INNER.search(said), said


@pytest.mark.parametrize(
    "value", ["", "https://app.prolific.com/x?cc={code}", "http://localhost:8000/{code}"]
)
def test_addresses_of_the_web_are_taken_to_return_to(capsys, monkeypatch, value):
    monkeypatch.setenv("GOALGUESS_RETURN_URL", value)
    monkeypatch.setenv("GOALGUESS_STEP_MS", "none")
    assert "GOALGUESS_STEP_MS" in says(capsys, "serve", "--port", 0)


@pytest.mark.usefixtures("folder")
def test_a_port_in_use_is_told_as_that(capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        said = says(capsys, "serve", "--port", port)
    assert said == f"goalguess: --port {port}: expected a free port, this one is in use\n"


def test_simulated_participants_do_not_come_to_a_closed_study(capsys, settings):
    with served(settings.model_copy(update={"study_open": False})) as url:
        said = says(capsys, "simulate", "--participants", 2, "--url", url)
    assert said.startswith("goalguess: expected a study that takes participants")
    assert said.count("\n") == 1


@pytest.mark.parametrize("package", ["policies", "analysis"])
@pytest.mark.parametrize("words", [["nothing"], ["--nothing"]])
def test_the_packages_alone_say_it_in_the_same_way(package, words):
    done = subprocess.run(
        [sys.executable, "-m", package, *words], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("goalguess: ")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(("words", "code"), [([], 2), (["stimuli"], 2), (["serve", "--help"], 0)])
def test_help_is_help(capsys, words, code):
    given, said = ended(capsys, words)
    assert (given, said.err) == (code, "")
    assert "Usage: goalguess" in said.out
