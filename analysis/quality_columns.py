"""The columns on data quality: signs of how attentively somebody took part."""

from functools import partial

from .columns import Column, Kind

_added = partial(Column, later=True)

OF_TRIALS = (
    _added(
        "pointer_moved",
        Kind.BOOLEAN,
        "Whether a mouse, finger or pen moved or pressed during the round; false for whoever "
        "plays by keyboard alone. Empty if the page did not tell.",
        nullable=True,
    ),
    _added(
        "first_decision_s",
        Kind.NUMBER,
        "Motion until the robot had completed its first step by choice: out of a cell with "
        "another way on (back is none), or past an area; length_s if there was no choice. Before, "
        "only the beginning of that step can tell one goal from another.",
        "s",
        low=0,
    ),
    _added("too_fast", Kind.BOOLEAN, "Whether stop_time_s is less than first_decision_s."),
)

_count = partial(_added, kind=Kind.INTEGER, low=0)
_alike = partial(_added, kind=Kind.BOOLEAN, nullable=True)
_lasted = partial(_added, kind=Kind.NUMBER, unit="s", low=0, nullable=True)
_BY_SERVER = "by the server's clock, breaks included; empty if not finished."

OF_PARTICIPANTS = (
    _alike(
        "never_moved_pointer",
        meaning="Whether pointer_moved is false in all answered trials, as for whoever plays by "
        "keyboard alone. Empty without trials, or if it is true in none and empty in some.",
    ),
    _alike(
        "same_guess",
        meaning="Whether all answered trials have the same guess; empty with fewer than two.",
    ),
    _alike(
        "same_confidence",
        meaning="Whether all answered trials have the same confidence; empty with fewer than two.",
    ),
    _count("too_fast_trials", meaning="Answered trials that are too_fast."),
    _count("pauses", meaning="Pauses of all answered trials."),
    _count("focus_losses", meaning="Focus losses of all answered trials."),
    _count("frames_dropped", meaning="Dropped frames of all answered trials."),
    _lasted("about_you_s", meaning=f"From consent to the answers about oneself, {_BY_SERVER}"),
    _lasted(
        "instructions_s",
        meaning=f"From the answers about oneself to the end of the instructions, {_BY_SERVER}",
    ),
    _lasted(
        "practice_s",
        meaning="From the end of the instructions to the control question passed or failed, "
        f"{_BY_SERVER}",
    ),
    _lasted(
        "trials_s", meaning=f"From the control question passed to the last answer, {_BY_SERVER}"
    ),
)
