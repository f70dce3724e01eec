"""`python -m policies`: the commands of this package without the rest."""

from policies.cli import commands

if __name__ == "__main__":
    commands(prog_name="python -m policies")
