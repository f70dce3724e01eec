"""Finds the system's Chromium; run as a module, installs it where there is none.

Standard library only: `make test` runs it before anything else is needed.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

COMMANDS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
APPLICATIONS = (
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
)
FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


def find() -> str | None:
    """Path of a Chromium: $CHROMIUM if set, else a command or application of the system's."""
    named = os.environ.get("CHROMIUM")
    if named:
        return shutil.which(named)
    found = (shutil.which(name) for name in (*COMMANDS, *APPLICATIONS))
    return next(filter(None, found), None)


def install() -> None:
    """Install Chromium with the system's package manager; SystemExit says what is missing."""
    commands = _installation()
    if not commands:
        raise SystemExit(
            "No Chromium found, and no way to install one here: "
            "install Chromium or Chrome, or set CHROMIUM to its path."
        )
    for command in commands:
        print("Installing Chromium:", " ".join(command), file=sys.stderr)
        if subprocess.run(command, check=False, stdout=subprocess.DEVNULL).returncode:
            raise SystemExit(f"Installing Chromium failed at: {' '.join(command)}")


def _installation() -> list[list[str]]:
    if sys.platform == "darwin":
        return [["brew", "install", "--cask", "chromium"]] if shutil.which("brew") else []
    if not shutil.which("apt-get"):
        return []
    if os.geteuid() == 0:
        root: list[str] = []
    elif (
        shutil.which("sudo") and not subprocess.run(["sudo", "-n", "true"], check=False).returncode
    ):
        root = ["sudo", "-n"]
    else:
        return []
    apt = [*root, "apt-get", "-qq", "-y"]
    return [[*apt, "update"], [*apt, "install", "--no-install-recommends", "chromium"]]


def main() -> None:
    """Make sure that there is a Chromium."""
    if os.environ.get("CHROMIUM") and not find():
        raise SystemExit(f"CHROMIUM={os.environ['CHROMIUM']}: expected a Chromium's path.")
    if find():
        return
    install()
    if not find():
        apps = ", ".join(Path(name).name for name in COMMANDS)
        raise SystemExit(f"Chromium was installed, but none of these commands is there: {apps}.")


if __name__ == "__main__":
    main()
