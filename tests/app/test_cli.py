"""The command `goalguess`: examples in every help, one line for everything a user can mend."""

import os
import socket
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from app.cli import commands


def all_commands(group=None, words=()):
    group = group or typer.main.get_command(commands)
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from all_commands(command, (*words, name))
        else:
            yield (*words, name)


def run(*arguments, **environment):
    code = [sys.executable, "-m", "app.cli", *map(str, arguments)]
    return subprocess.run(
        code,
        capture_output=True,
        text=True,
        env={**os.environ, **environment, "COLUMNS": "200"},
        timeout=120,
        check=False,
    )


def test_the_commands_of_all_three_packages_are_one_command():
    names = {words[0] for words in all_commands()}
    assert names == {
        "serve",
        "simulate",
        "export",
        "recruits",
        "withdraw",
        "backup",
        "restore",
        "solve",
        "stimuli",
        "compare",
        "teach",
        "analyse",
        "power",
        "level",
        "reconstruct",
    }


@pytest.mark.parametrize("words", list(all_commands()), ids=" ".join)
def test_every_command_has_help_with_an_example(words):
    help_text = CliRunner(env={"COLUMNS": "200"}).invoke(commands, [*words, "--help"]).output
    assert "Example" in help_text
    assert f"goalguess {' '.join(words)}" in " ".join(help_text.split())


def test_help_loads_none_of_the_heavy_libraries():
    code = (
        "import sys\nsys.argv = ['goalguess', '--help']\nfrom app.cli import main\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'polars', 'matplotlib', 'sqlalchemy', 'fastapi'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    ("arguments", "environment", "message"),
    [
        (
            ["export", "--to", "out"],
            {"GOALGUESS_DATABASE_URL": "sqlite:///none.sqlite"},
            "no such file",
        ),
        (
            ["export", "--to", "out"],
            {"GOALGUESS_DATABASE_URL": "mysql://x/y"},
            "expected a SQLite file",
        ),
        (["export", "--to", "out"], {"GOALGUESS_STEP_MS": "slow"}, "GOALGUESS_STEP_MS"),
        (["simulate", "--mix", "careful=1"], {}, "--mix: expected kinds of attentive"),
        (["simulate", "--url", "http://127.0.0.1:9/"], {}, "expected the address of a running"),
        (["serve"], {"GOALGUESS_CODES": "C1"}, "GOALGUESS_CODES: expected JSON"),
        (["serve"], {"GOALGUESS_STEPMS": "3"}, "GOALGUESS_STEPMS: expected one of"),
        (["serve"], {"GOALGUESS_SEED": "1" + 30 * "0"}, "GOALGUESS_SEED"),
        (["serve"], {"GOALGUESS_DATABASE_URL": "sqlite:///:memory:"}, "expected a SQLite file"),
        (["serve"], {"GOALGUESS_CODES": '{"finished": "C1"}'}, "GOALGUESS_CODES, 'finished'"),
        (
            ["serve"],
            {"GOALGUESS_DATABASE_URL": "sqlite:////no/such/folder/x.sqlite"},
            "folder that exists",
        ),
    ],
)
def test_what_a_user_can_mend_is_one_line_and_exit_code_2(
    tmp_path, monkeypatch, arguments, environment, message
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2]))
    done = run(*arguments, **environment)
    assert done.returncode == 2
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_simulated_participants_fill_a_database_of_their_own(tmp_path):
    url = f"sqlite:///{tmp_path}/study.sqlite"
    done = run("simulate", "--participants", 3, "--seed", 5, GOALGUESS_DATABASE_URL=url)
    assert done.returncode == 0, done.stderr
    assert "answers acknowledged" in done.stdout
    with sqlite3.connect(tmp_path / "study.sqlite") as connection:
        assert connection.execute("SELECT seed FROM randomisation").fetchall() == [(5,)]
        assert connection.execute("SELECT count(*) FROM participants").fetchone()[0] >= 2


def test_a_port_in_use_is_one_line_and_exit_code_2(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        url = f"sqlite:///{tmp_path}/study.sqlite"
        done = run("serve", "--port", port, GOALGUESS_DATABASE_URL=url)
    assert done.returncode == 2
    assert "in use" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
