"""Whether the participant moved the pointer, of each trial answered from here on."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    op.add_column("trials", sa.Column("pointer_moved", sa.Boolean(), nullable=True))
