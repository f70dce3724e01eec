"""The columns on data quality: signs of how attentively somebody took part, and of odd times."""

from functools import partial

from .columns import Column, Kind

_added = partial(Column, later=True, lenient=True)
_sign = partial(_added, kind=Kind.BOOLEAN, nullable=True)
_lasted = partial(_added, kind=Kind.NUMBER, unit="s", low=0, nullable=True)
_OLDER = "Empty in rows of older versions."

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
    _lasted(
        "press_s",
        meaning="Where in the motion Stop was pressed by the page's clock, before anything was "
        f"capped. {_OLDER}",
    ),
    _lasted(
        "last_frame_s",
        meaning=f"Where in the motion the last frame was that the page had drawn by then. {_OLDER}",
    ),
    _lasted("frame_interval_s", meaning=f"Usual time from one frame to the next. {_OLDER}"),
    _lasted(
        "played_waited_s",
        meaning="How long the page's message that the motion had begun waited in the page, or took "
        f"until the server had it. {_OLDER}",
    ),
    _lasted(
        "stopped_waited_s",
        meaning=f"How long the page kept its message of the stop before it could send it. {_OLDER}",
    ),
    _lasted(
        "server_stretch_s",
        meaning="The longest motion that the server's clock can confirm: until it learned of the "
        "stop, from when the page says that the motion began, but never from before the animation "
        "was given out. Empty if that clock was set back in between.",
    ),
    _sign(
        "impossible_time",
        meaning="Whether stop_time_s exceeds what the server's clock can confirm by more than 2 s, "
        "or lies before what the page had reported as seen. Empty for simulated participants, and "
        "where it cannot be judged.",
    ),
    _sign(
        "times_clamped",
        meaning="Whether the page sent a time that could not be, which is stored as the nearest "
        "one that could; also a press later than one frame_interval_s after the last frame drawn. "
        f"{_OLDER}",
    ),
    _added(
        "watched_elsewhere",
        Kind.BOOLEAN,
        "Whether another browser of the participant played the animation, too: it went on in this "
        "one from where it can have been seen, or began anew because the other could not say so in "
        "time. What was seen is then less sure.",
    ),
)

_count = partial(_added, kind=Kind.INTEGER, low=0)
_BY_SERVER = (
    "by the server's clock, breaks included; empty if not finished, or if that clock was set back."
)

OF_PARTICIPANTS = (
    _sign(
        "never_moved_pointer",
        meaning="Whether pointer_moved is false in all answered trials, as for whoever plays by "
        "keyboard alone. Empty without trials, or if it is true in none and empty in some.",
    ),
    _sign(
        "same_guess",
        meaning="Whether all answered trials have the same guess; empty with fewer than two.",
    ),
    _sign(
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
    _sign(
        "recruited",
        meaning="Whether the participant came with a recruiter's id, which is never exported. "
        "Empty for whoever withdrew.",
    ),
    _sign(
        "pilot_before",
        meaning="Whether somebody with the same recruiter's id had taken part as a pilot before. "
        "Empty for whoever withdrew, and in rows of older versions.",
    ),
    _sign(
        "impossible_time",
        meaning="Whether any answered trial has impossible_time, or all together, with their "
        "lead-ins, are longer by more than 2 s than the time in which they were answered. Empty "
        "for simulated participants, and where it cannot be judged.",
    ),
)
