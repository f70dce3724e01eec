"""Errors of the decision science.

PolicyError
├── MazeError        a maze text that breaks the format
├── ModelError       parameters or arrays that describe no valid model
├── StimulusError    a stimulus pool that breaks its own rule
└── ResultError      result files that are there already, or are another run's
"""


class PolicyError(Exception):
    """Anything that a caller of `policies` can mend; the message says what, expected and where."""


class MazeError(PolicyError):
    """A maze text that breaks the format; the message begins with source:line:column.

    Of a folder's mazes the message has a line for each bad file.
    """


class ModelError(PolicyError):
    """Parameters or arrays that describe no valid model."""


class StimulusError(PolicyError):
    """A stimulus pool, or a file of it, that breaks the rule the manifest states."""


class ResultError(PolicyError):
    """Result files that are there already, or that belong to another run."""
