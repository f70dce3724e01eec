"""The first schema: participants, places, trials, the log."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None


def upgrade() -> None:
    op.create_table(
        "randomisation",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("seed", sa.Integer(), nullable=False),
        sa.Column("block_size", sa.Integer(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_randomisation")),
    )
    op.create_table(
        "studies",
        sa.Column("hash", sa.String(), nullable=False),
        sa.Column("definition", sa.JSON(), nullable=False),
        sa.Column("pool_hash", sa.String(), nullable=False),
        sa.Column("first_used_at", sa.DateTime(), nullable=False),
        sa.PrimaryKeyConstraint("hash", name=op.f("pk_studies")),
    )
    op.create_table(
        "tallies",
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("count", sa.Integer(), nullable=False),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_tallies")),
    )
    op.create_table(
        "participants",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("pseudonym", sa.String(), nullable=False),
        sa.Column("arrival", sa.String(), nullable=True),
        sa.Column("stream", sa.String(), nullable=False),
        sa.Column("step", sa.String(), nullable=False),
        sa.Column("study_hash", sa.String(), nullable=False),
        sa.Column("app_version", sa.String(), nullable=False),
        sa.Column("consent_hash", sa.String(), nullable=True),
        sa.Column("consented_at", sa.DateTime(), nullable=True),
        sa.Column("finished_at", sa.DateTime(), nullable=True),
        sa.Column("control_tries", sa.Integer(), nullable=False),
        sa.Column("user_agent", sa.String(), nullable=True),
        sa.Column("viewport_width", sa.Integer(), nullable=True),
        sa.Column("viewport_height", sa.Integer(), nullable=True),
        sa.Column("pixel_ratio", sa.Float(), nullable=True),
        sa.Column("refresh_rate_hz", sa.Float(), nullable=True),
        sa.Column("pointer_type", sa.String(), nullable=True),
        sa.ForeignKeyConstraint(
            ["study_hash"], ["studies.hash"], name=op.f("fk_participants_study_hash")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_participants")),
        sa.UniqueConstraint("arrival", name=op.f("uq_participants_arrival")),
        sa.UniqueConstraint("pseudonym", name=op.f("uq_participants_pseudonym")),
    )
    op.create_table(
        "demographics",
        sa.Column("participant_id", sa.Integer(), nullable=False),
        sa.Column("age", sa.Integer(), nullable=True),
        sa.Column("gender", sa.String(), nullable=False),
        sa.Column("nationality", sa.String(), nullable=False),
        sa.Column("education", sa.String(), nullable=False),
        sa.Column("occupation", sa.String(), nullable=False),
        sa.Column("robot_familiarity", sa.String(), nullable=False),
        sa.ForeignKeyConstraint(
            ["participant_id"], ["participants.id"], name=op.f("fk_demographics_participant_id")
        ),
        sa.PrimaryKeyConstraint("participant_id", name=op.f("pk_demographics")),
    )
    op.create_table(
        "events",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("participant_id", sa.Integer(), nullable=False),
        sa.Column("message_key", sa.String(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("trial_index", sa.Integer(), nullable=True),
        sa.Column("type", sa.String(), nullable=False),
        sa.Column("server_time", sa.DateTime(), nullable=False),
        sa.Column("client_time_ms", sa.Float(), nullable=True),
        sa.Column("details", sa.JSON(), nullable=False),
        sa.Column("stimulus", sa.String(), nullable=True),
        sa.Column("study_hash", sa.String(), nullable=False),
        sa.Column("app_version", sa.String(), nullable=False),
        sa.ForeignKeyConstraint(
            ["participant_id"], ["participants.id"], name=op.f("fk_events_participant_id")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_events")),
        sa.UniqueConstraint(
            "participant_id",
            "message_key",
            "ordinal",
            name=op.f("uq_events_participant_id_message_key_ordinal"),
        ),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "places",
        sa.Column("stream", sa.String(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("condition", sa.String(), nullable=False),
        sa.Column("scenarios", sa.JSON(), nullable=False),
        sa.Column("participant_id", sa.Integer(), nullable=True),
        sa.Column("dealt_at", sa.DateTime(), nullable=True),
        sa.Column("played_at", sa.DateTime(), nullable=True),
        sa.ForeignKeyConstraint(
            ["participant_id"], ["participants.id"], name=op.f("fk_places_participant_id")
        ),
        sa.PrimaryKeyConstraint("stream", "number", name=op.f("pk_places")),
        sa.UniqueConstraint("participant_id", name=op.f("uq_places_participant_id")),
    )
    op.create_index("ix_places_free", "places", ["stream", "dealt_at", "number"], unique=False)
    op.create_table(
        "recruits",
        sa.Column("participant_id", sa.Integer(), nullable=False),
        sa.Column("stream", sa.String(), nullable=False),
        sa.Column("recruiter_id", sa.String(), nullable=False),
        sa.Column("recruiter_study", sa.String(), nullable=True),
        sa.Column("recruiter_session", sa.String(), nullable=True),
        sa.ForeignKeyConstraint(
            ["participant_id"], ["participants.id"], name=op.f("fk_recruits_participant_id")
        ),
        sa.PrimaryKeyConstraint("participant_id", name=op.f("pk_recruits")),
        sa.UniqueConstraint("stream", "recruiter_id", name=op.f("uq_recruits_stream_recruiter_id")),
    )
    op.create_table(
        "sessions",
        sa.Column("token_hash", sa.String(), nullable=False),
        sa.Column("participant_id", sa.Integer(), nullable=False),
        sa.Column("current", sa.Boolean(), nullable=False),
        sa.Column("began_at", sa.DateTime(), nullable=False),
        sa.ForeignKeyConstraint(
            ["participant_id"], ["participants.id"], name=op.f("fk_sessions_participant_id")
        ),
        sa.PrimaryKeyConstraint("token_hash", name=op.f("pk_sessions")),
    )
    op.create_index(
        op.f("ix_sessions_participant_id"), "sessions", ["participant_id"], unique=False
    )
    op.create_table(
        "trials",
        sa.Column("participant_id", sa.Integer(), nullable=False),
        sa.Column("trial_index", sa.Integer(), nullable=False),
        sa.Column("stimulus", sa.String(), nullable=False),
        sa.Column("study_hash", sa.String(), nullable=False),
        sa.Column("app_version", sa.String(), nullable=False),
        sa.Column("step_ms", sa.Integer(), nullable=False),
        sa.Column("length_ms", sa.Integer(), nullable=False),
        sa.Column("lead_in_ms", sa.Integer(), nullable=False),
        sa.Column("played_at", sa.DateTime(), nullable=False),
        sa.Column("position_ms", sa.Float(), nullable=False),
        sa.Column("stopped_at", sa.DateTime(), nullable=True),
        sa.Column("stop_time_ms", sa.Float(), nullable=True),
        sa.Column("reached_end", sa.Boolean(), nullable=True),
        sa.Column("pauses", sa.Integer(), nullable=True),
        sa.Column("paused_ms", sa.Float(), nullable=True),
        sa.Column("focus_losses", sa.Integer(), nullable=True),
        sa.Column("frames_dropped", sa.Integer(), nullable=True),
        sa.Column("reduced_motion", sa.Boolean(), nullable=True),
        sa.Column("answered_at", sa.DateTime(), nullable=True),
        sa.Column("guess", sa.String(), nullable=True),
        sa.Column("confidence", sa.Integer(), nullable=True),
        sa.Column("guess_latency_ms", sa.Float(), nullable=True),
        sa.Column("confidence_latency_ms", sa.Float(), nullable=True),
        sa.ForeignKeyConstraint(
            ["participant_id"], ["participants.id"], name=op.f("fk_trials_participant_id")
        ),
        sa.ForeignKeyConstraint(
            ["study_hash"], ["studies.hash"], name=op.f("fk_trials_study_hash")
        ),
        sa.PrimaryKeyConstraint("participant_id", "trial_index", name=op.f("pk_trials")),
    )
