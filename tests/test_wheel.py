"""The wheel: installed into a new virtual environment, it serves the study from there."""

import os
import re
import subprocess
import sys
import urllib.request
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    build = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "--quiet",
        "--no-deps",
        "-w",
        str(folder),
        str(ROOT),
    ]
    subprocess.run(build, check=True, timeout=300)
    return next(folder.glob("goalguess-*.whl"))


def test_the_wheel_holds_templates_static_files_mazes_stimuli_and_migrations(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    for folder, target in (("templates", "app/templates"), ("static", "app/static")):
        for file in (ROOT / folder).rglob("*"):
            assert f"{target}/{file.relative_to(ROOT / folder)}" in names
    assert "app/migrations/versions/0001_first_schema.py" in names
    assert "app/consent.txt" in names
    assert "policies/stimuli/pool.json" in names
    assert "analysis/plan.toml" in names
    assert "analysis/nationalities.csv" in names
    assert sum(name.startswith("policies/mazes/") for name in names) == 5
    assert not any(name.startswith("tests/") for name in names)


def test_an_installed_wheel_serves_a_page_and_its_style_sheet(wheel, tmp_path):
    environment = tmp_path / "venv"
    subprocess.run([sys.executable, "-m", "venv", environment], check=True, timeout=120)
    python = environment / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", wheel], check=True, timeout=500)
    variables = {**os.environ, "PYTHONUNBUFFERED": "1"}
    variables.pop("PYTHONPATH", None)
    with subprocess.Popen(
        [environment / "bin" / "goalguess", "serve", "--port", "0"],
        cwd=tmp_path,
        env=variables,
        stdout=subprocess.PIPE,
        text=True,
    ) as server:
        try:
            assert server.stdout
            address = next(
                found[0] for line in server.stdout if (found := re.search(r"http://\S+", line))
            )
            page = urllib.request.urlopen(address, timeout=30).read().decode()
            assert "I agree and take part" in page
            style = re.search(r'href="/(static/\w+/style\.css)"', page)
            assert style
            css = urllib.request.urlopen(address + style[1], timeout=30)
            assert css.headers["content-type"].startswith("text/css")
            assert b"prefers-color-scheme" in css.read()
        finally:
            server.terminate()
    assert (tmp_path / "goalguess.sqlite").exists()
