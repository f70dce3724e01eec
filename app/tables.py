"""The schema: raw facts only; whatever can be derived is derived in analysis.measures."""

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    JSON,
    Boolean,
    Column,
    DateTime,
    Dialect,
    Float,
    ForeignKey,
    Index,
    Integer,
    MetaData,
    String,
    Table,
    TypeDecorator,
    UniqueConstraint,
    true,
)


class UtcTime(TypeDecorator[datetime]):
    """A point in time, stored in UTC and read back aware of it."""

    impl = DateTime
    cache_ok = True

    def process_result_value(self, value: Any, _dialect: Dialect) -> datetime | None:
        """Name the time zone that SQLite does not store."""
        return None if value is None else value.replace(tzinfo=UTC)


metadata = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s",
        "pk": "pk_%(table_name)s",
    }
)


def _participant(**options: Any) -> Column[int]:
    return Column("participant_id", Integer, ForeignKey("participants.id"), **options)


studies = Table(
    "studies",
    metadata,
    Column("hash", String, primary_key=True),
    Column("definition", JSON, nullable=False),
    Column("pool_hash", String, nullable=False),
    Column("first_used_at", UtcTime, nullable=False),
)
"""Every definition of the study that this database was used with: what its hashes stand for."""

randomisation = Table(
    "randomisation",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("seed", Integer, nullable=False),
    Column("block_size", Integer, nullable=False),
)
"""One row: what the dealing of places is drawn from."""

participants = Table(
    "participants",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("pseudonym", String, nullable=False, unique=True),
    Column("arrival", String, unique=True),
    Column("stream", String, nullable=False),
    Column("step", String, nullable=False),
    Column("study_hash", String, ForeignKey("studies.hash"), nullable=False),
    Column("app_version", String, nullable=False),
    Column("consent_hash", String),
    Column("consented_at", UtcTime),
    Column("finished_at", UtcTime),
    Column("control_tries", Integer, nullable=False, default=0),
    Column("user_agent", String),
    Column("viewport_width", Integer),
    Column("viewport_height", Integer),
    Column("pixel_ratio", Float),
    Column("refresh_rate_hz", Float),
    Column("pointer_type", String),
    Column("pilot_before", Boolean),
)
"""`arrival` is the consent form's nonce: sent twice, it is still one participant.
`pilot_before`: the same recruiter's id had been a pilot when this participant consented.

Of somebody who withdrew only the row itself stays, emptied: the tombstone.
"""

recruits = Table(
    "recruits",
    metadata,
    _participant(primary_key=True),
    Column("stream", String, nullable=False),
    Column("recruiter_id", String, nullable=False),
    Column("recruiter_study", String),
    Column("recruiter_session", String),
    UniqueConstraint("stream", "recruiter_id"),
)
"""The recruiter's ids, apart from everything that is exported."""

sessions = Table(
    "sessions",
    metadata,
    Column("token_hash", String, primary_key=True),
    _participant(nullable=False, index=True),
    Column("current", Boolean, nullable=False),
    Column("began_at", UtcTime, nullable=False),
    Column("proven", Boolean, nullable=False, server_default=true()),
)
"""`proven`: the browser has shown that it is the participant's, see `app.sessions`."""

demographics = Table(
    "demographics",
    metadata,
    _participant(primary_key=True),
    Column("age", Integer),
    Column("gender", String, nullable=False),
    Column("nationality", String, nullable=False),
    Column("education", String, nullable=False),
    Column("occupation", String, nullable=False),
    Column("robot_familiarity", String, nullable=False),
)
"""`age` is empty for: prefer not to say."""

places = Table(
    "places",
    metadata,
    Column("stream", String, primary_key=True),
    Column("number", Integer, primary_key=True),
    Column("condition", String, nullable=False),
    Column("scenarios", JSON, nullable=False),
    _participant(unique=True),
    Column("dealt_at", UtcTime),
    Column("played_at", UtcTime),
    Column("ticket", String),
    Index("ix_places_free", "stream", "dealt_at", "number"),
)
"""Dealt in the order of `number` within a stream; one given back has no `dealt_at` again.

`ticket` is drawn at random each time the place is dealt; those dealt before there were any have
none.
"""

trials = Table(
    "trials",
    metadata,
    _participant(primary_key=True),
    Column("trial_index", Integer, primary_key=True),
    Column("stimulus", String, nullable=False),
    Column("study_hash", String, ForeignKey("studies.hash"), nullable=False),
    Column("app_version", String, nullable=False),
    Column("step_ms", Integer, nullable=False),
    Column("length_ms", Integer, nullable=False),
    Column("lead_in_ms", Integer, nullable=False),
    Column("played_at", UtcTime, nullable=False),
    Column("position_ms", Float, nullable=False),
    Column("stopped_at", UtcTime),
    Column("stop_time_ms", Float),
    Column("reached_end", Boolean),
    Column("pauses", Integer),
    Column("paused_ms", Float),
    Column("focus_losses", Integer),
    Column("frames_dropped", Integer),
    Column("reduced_motion", Boolean),
    Column("answered_at", UtcTime),
    Column("guess", String),
    Column("confidence", Integer),
    Column("guess_latency_ms", Float),
    Column("confidence_latency_ms", Float),
    Column("pointer_moved", Boolean),
    Column("press_ms", Float),
    Column("last_frame_ms", Float),
    Column("frame_interval_ms", Float),
    Column("played_waited_ms", Float),
    Column("stopped_waited_ms", Float),
    Column("times_clamped", Boolean),
)
"""A row begins with the first frame played, gets its stop, then its answer; nothing is replaced.

`position_ms` is the motion time known to have been seen, from which a broken-off trial goes on.
`press_ms` and `last_frame_ms` are positions on the same line: of the press on Stop as the page sent
it, and of the last frame it had drawn; `stop_time_ms` is derived of both. `..._waited_ms` is how
long the page kept a message before it could send it, or how long that of the first frame took.
`times_clamped`: a time that the page sent could not be, and is stored at the bound.
"""

events = Table(
    "events",
    metadata,
    Column("id", Integer, primary_key=True),
    _participant(nullable=False),
    Column("message_key", String, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("trial_index", Integer),
    Column("type", String, nullable=False),
    Column("server_time", UtcTime, nullable=False),
    Column("client_time_ms", Float),
    Column("details", JSON, nullable=False),
    Column("stimulus", String),
    Column("study_hash", String, nullable=False),
    Column("app_version", String, nullable=False),
    UniqueConstraint("participant_id", "message_key", "ordinal"),
    # Numbers of deleted events are never given again: an export's ids stay what they were.
    sqlite_autoincrement=True,
)
"""The log, append-only. A message delivered twice is logged once: see its unique constraint."""

tallies = Table(
    "tallies",
    metadata,
    Column("name", String, primary_key=True),
    Column("count", Integer, nullable=False),
)
"""Anonymous counts, such as arrivals that gave no consent."""

declined = Table("declined", metadata, Column("arrival", String, primary_key=True))
"""Consent forms, by their nonce, that were answered with no: sent twice, it is counted once."""
