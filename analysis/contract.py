"""The export: every column of its three tables, declared once.

Names are fixed: the app writes them, the analysis reads them, readers of a published data set
rely on them. All times of day are the server's, in UTC; all durations are seconds of motion or
of waiting measured by the page's monotonic clock.
"""

from .columns import Column, Kind, Table
from .quality_columns import OF_PARTICIPANTS, OF_TRIALS

TREATMENT = "polmdp"
REFERENCE = "optimal"
CONDITIONS = (TREATMENT, REFERENCE)
"""The arms, treatment first: a policy that shows its goal, and one that only reaches it."""

COMPLETED = "completed"
STATUSES = (
    "about_you",
    "instructions",
    "practice",
    "trials",
    COMPLETED,
    "screened_out",
    "failed",
    "withdrawn",
)

POINTER_TYPES = ("mouse", "touch", "pen", "keyboard", "other")

TEXT, JSON = Kind.TEXT, Kind.JSON
INTEGER, NUMBER = Kind.INTEGER, Kind.NUMBER
BOOLEAN, TIME = Kind.BOOLEAN, Kind.TIME

_PARTICIPANT = Column(
    "participant",
    TEXT,
    "Pseudonym, the same in all three tables. Recruiters' ids are never exported.",
)
_SIMULATED = Column(
    "simulated", BOOLEAN, "Whether a program played. Left out of the analysis unless asked for."
)
_PREVIEW = Column(
    "preview",
    BOOLEAN,
    "Whether an experimenter tried the study out. Left out of the analysis unless asked for.",
)
_STUDY_HASH = Column("study_hash", TEXT, "Hash of the study's definition in force for this row.")
_APP_VERSION = Column("app_version", TEXT, "Version of Goalguess that recorded the row.")

TRIALS = Table(
    "trials",
    "One row per answered trial. This table alone carries the analysis.",
    ("participant", "trial_index"),
    (
        _PARTICIPANT,
        Column(
            "condition",
            TEXT,
            f"Policy that moved the robot, the same in all trials of a participant: "
            f"{TREATMENT} (treatment) or {REFERENCE} (reference).",
            choices=CONDITIONS,
        ),
        Column(
            "scenario",
            TEXT,
            "Maze, start and goal; both conditions have a stimulus for every scenario.",
        ),
        Column("stimulus", TEXT, "Hash of the animation that was shown."),
        Column("maze", TEXT, "Name of the maze."),
        Column("trial_index", INTEGER, "Place of the trial in the participant's order.", low=1),
        Column("goal", TEXT, "Area the robot was going to.", letter=True),
        Column("guess", TEXT, "Area the participant chose after the stop.", letter=True),
        Column("correct", BOOLEAN, "Whether guess and goal are the same area."),
        Column(
            "stop_time_s",
            NUMBER,
            "Motion seen before Stop was pressed, without lead-in and pauses; "
            "length_s if the animation ran to its end.",
            "s",
            low=0,
        ),
        Column("length_s", NUMBER, "Full motion of the animation, without lead-in.", "s", above=0),
        Column(
            "prediction_time_s",
            NUMBER,
            "stop_time_s if the guess was correct, else length_s, as in the paper.",
            "s",
            low=0,
        ),
        Column(
            "score",
            NUMBER,
            "0 if wrong, else min(10, 10 (T - t) / (2T/3)), t = stop_time_s and T = length_s.",
            "points",
            low=0,
            high=10,
        ),
        Column(
            "confidence",
            INTEGER,
            "How confident in the guess, from not at all sure (1) to completely sure (7).",
            "scale points",
            low=1,
            high=7,
        ),
        Column("reached_end", BOOLEAN, "Whether the animation ran to its end without a stop."),
        Column("steps_seen", INTEGER, "Maze steps begun when stopped.", "steps", low=0),
        Column("started_at", TIME, "When the server learned that the animation moved."),
        Column("stopped_at", TIME, "When the server learned of the stop or the end."),
        Column("answered_at", TIME, "When the server stored the guess and the confidence."),
        Column(
            "guess_latency_s",
            NUMBER,
            "From the stop to the choice of the area that was sent; after a reload, from there.",
            "s",
            low=0,
        ),
        Column(
            "confidence_latency_s",
            NUMBER,
            "From the stop to the choice of the rating that was sent; after a reload, from there.",
            "s",
            low=0,
        ),
        Column("lead_in_s", NUMBER, "Still picture before the motion.", "s", low=0),
        Column("pauses", INTEGER, "Times the motion paused because the page was hidden.", low=0),
        Column("paused_s", NUMBER, "Total of those pauses.", "s", low=0),
        Column("focus_losses", INTEGER, "Times the window lost the focus.", low=0),
        Column(
            "reduced_motion", BOOLEAN, "Whether the robot jumped step by step instead of gliding."
        ),
        Column("frames_dropped", INTEGER, "Frames the browser failed to draw in time.", low=0),
        *OF_TRIALS,
        _SIMULATED,
        _PREVIEW,
        _STUDY_HASH,
        _APP_VERSION,
    ),
)

_OR_DECLINED = 'May be "prefer not to say".'

PARTICIPANTS = Table(
    "participants",
    "One row per person who gave consent, with how far they came and on which device.",
    ("participant",),
    (
        _PARTICIPANT,
        Column(
            "condition",
            TEXT,
            "Policy of the place held; empty if none was dealt, or it was given back unplayed.",
            choices=CONDITIONS,
            nullable=True,
        ),
        Column("status", TEXT, "The step the participant is at or ended with.", choices=STATUSES),
        Column(
            "age",
            INTEGER,
            "Age; empty if not answered or the answer was: prefer not to say.",
            "years",
            low=0,
            high=130,
            nullable=True,
        ),
        Column("gender", TEXT, f"Gender. {_OR_DECLINED}", nullable=True),
        Column("nationality", TEXT, f"Nationality. {_OR_DECLINED}", nullable=True),
        Column("education", TEXT, f"Highest education. {_OR_DECLINED}", nullable=True),
        Column("occupation", TEXT, f"Occupation. {_OR_DECLINED}", nullable=True),
        Column(
            "robot_familiarity", TEXT, f"Familiarity with robots. {_OR_DECLINED}", nullable=True
        ),
        Column("consented_at", TIME, "When consent was given.", nullable=True),
        Column("dealt_at", TIME, "When the condition and the trials were dealt.", nullable=True),
        Column("first_played_at", TIME, "First frame of the first trial in motion.", nullable=True),
        Column("finished_at", TIME, "When the last step was reached.", nullable=True),
        Column("control_tries", INTEGER, "Answers given to the control question.", low=0),
        Column("trials_answered", INTEGER, "Trials answered so far.", low=0),
        Column("score", NUMBER, "Sum of the trials' scores.", "points", low=0, nullable=True),
        *OF_PARTICIPANTS,
        Column("user_agent", TEXT, "What the browser says it is.", nullable=True),
        Column("viewport_width", INTEGER, "Width of the page's area.", "px", low=0, nullable=True),
        Column(
            "viewport_height", INTEGER, "Height of the page's area.", "px", low=0, nullable=True
        ),
        Column(
            "pixel_ratio", NUMBER, "Device pixels per CSS pixel.", "ratio", above=0, nullable=True
        ),
        Column(
            "refresh_rate_hz", NUMBER, "Refresh rate of the screen.", "Hz", above=0, nullable=True
        ),
        Column(
            "pointer_type",
            TEXT,
            "How Play was pressed; other if the browser calls it by a name of its own.",
            choices=POINTER_TYPES,
            nullable=True,
            lenient=True,
        ),
        _SIMULATED,
        _PREVIEW,
        Column("consent_hash", TEXT, "Hash of the consent text agreed to.", nullable=True),
        _STUDY_HASH,
        _APP_VERSION,
    ),
)

EVENTS = Table(
    "events",
    "The log, in the order in which the server wrote it; nothing in it is ever changed.",
    ("event_id",),
    (
        _PARTICIPANT,
        Column("event_id", INTEGER, "Order of the log.", low=0),
        Column(
            "trial_index",
            INTEGER,
            "Trial during which it happened; empty outside of trials.",
            low=1,
            nullable=True,
        ),
        Column("type", TEXT, "What happened: played, stopped, hidden, resized, answered, ..."),
        Column("server_time", TIME, "When the server wrote it."),
        Column(
            "client_time_ms",
            NUMBER,
            "The page's monotonic clock, which starts anew with every loading of the page.",
            "ms",
            low=0,
            nullable=True,
        ),
        Column("details", JSON, "What else is known about it, as a JSON object."),
        Column("stimulus", TEXT, "Hash of the animation on the page, if any.", nullable=True),
        _STUDY_HASH,
        _APP_VERSION,
    ),
)

TABLES = (TRIALS, PARTICIPANTS, EVENTS)
