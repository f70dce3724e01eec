"""The study: web server, database, export, command line."""

from importlib.metadata import version

VERSION = version("goalguess")
