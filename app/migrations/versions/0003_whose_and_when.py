"""What tells whose an answer is, and whether its times can be: facts of rows made from here on."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    for name in (
        "press_ms",
        "last_frame_ms",
        "frame_interval_ms",
        "played_waited_ms",
        "stopped_waited_ms",
    ):
        op.add_column("trials", sa.Column(name, sa.Float(), nullable=True))
    op.add_column("trials", sa.Column("times_clamped", sa.Boolean(), nullable=True))
    op.add_column("participants", sa.Column("pilot_before", sa.Boolean(), nullable=True))
    op.add_column("places", sa.Column("ticket", sa.String(), nullable=True))
    # Whoever had a session before this was asked for is not turned away from withdrawing.
    op.add_column(
        "sessions", sa.Column("proven", sa.Boolean(), nullable=False, server_default=sa.true())
    )
    # Ids are read without the blanks around them now; of two that become one, both stay.
    for name in ("recruiter_id", "recruiter_study", "recruiter_session"):
        op.execute(f"UPDATE OR IGNORE recruits SET {name} = trim({name})")
    op.create_table(
        "declined",
        sa.Column("arrival", sa.String(), nullable=False),
        sa.PrimaryKeyConstraint("arrival", name=op.f("pk_declined")),
    )
