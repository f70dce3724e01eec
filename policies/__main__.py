"""`python -m policies`: the commands of this package without the rest."""

from policies.cli import commands
from policies.command_line import run_commands
from policies.errors import PolicyError

if __name__ == "__main__":
    run_commands(commands, "python -m policies", (PolicyError,))
