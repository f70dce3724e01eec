"""The study: what is shown, asked and paid, and the hash that names this definition."""

from dataclasses import asdict, dataclass
from functools import cached_property
from hashlib import sha256
from importlib.resources import files
from typing import Any

from app.assignment import LIST_LENGTH
from app.questions import ABOUT_YOU, CONTROL, CONTROL_RIGHT
from app.settings import Settings
from app.steps import CONTROL_TRIES
from policies import Pool, Stimulus, content_hash, load_pool

AREA_STYLES = {
    "A": ("blue", "dots"),
    "B": ("orange", "stripes"),
    "C": ("green", "grid"),
    "D": ("purple", "rings"),
    "E": ("sky", "waves"),
    "F": ("vermillion", "crosses"),
}
"""Colour and pattern of each area; the style sheet gives the names their values."""


PARTICIPANT, PREVIEW, SIMULATED = "participant", "preview", "simulated"
"""Streams: real participants and the two kinds of pilots, dealt and exported apart."""

PILOTS = (PREVIEW, SIMULATED)


@dataclass(frozen=True)
class Section:
    """A part of the consent text."""

    heading: str
    paragraphs: tuple[str, ...]


@dataclass(frozen=True)
class Study:
    """What a participant meets; built once from the settings and the committed pool."""

    settings: Settings
    pool: Pool
    consent_text: str
    title: str = "Guess where the robot is going"
    minutes: int = 10
    trials: int = LIST_LENGTH

    @property
    def researchers(self) -> str:
        """Who runs the study."""
        return self.settings.researchers

    @property
    def contact(self) -> str:
        """How participants reach them."""
        return self.settings.contact

    @cached_property
    def consent(self) -> tuple[Section, ...]:
        """The consent text in sections; a line that starts with # begins one."""
        sections: list[tuple[str, list[str]]] = [("", [])]
        for line in filter(None, self.consent_text.splitlines()):
            if line.startswith("# "):
                sections.append((line[2:], []))
            else:
                sections[-1][1].append(line)
        return tuple(Section(heading, tuple(paragraphs)) for heading, paragraphs in sections)

    @cached_property
    def consent_hash(self) -> str:
        """SHA-256 of the consent text."""
        return sha256(self.consent_text.encode()).hexdigest()

    @cached_property
    def definition(self) -> dict[str, Any]:
        """Everything that makes this study this study, as it is stored beside the answers."""
        return {
            "title": self.title,
            "trials": self.trials,
            "consent_text": self.consent_text,
            "about_you": [asdict(question) for question in ABOUT_YOU],
            "control": {**asdict(CONTROL), "right": CONTROL_RIGHT, "tries": CONTROL_TRIES},
            "areas": AREA_STYLES,
            "step_ms": self.settings.step_ms,
            "lead_in_ms": self.settings.lead_in_ms,
            "pool": self.pool.hash,
        }

    @cached_property
    def hash(self) -> str:
        """Short name of the definition; recorded with every row."""
        return content_hash(self.definition)[:16]

    def length_ms(self, stimulus: Stimulus) -> int:
        """Full motion of a stimulus, ms, without lead-in."""
        return stimulus.steps * self.settings.step_ms

    def picture(self, stimulus: Stimulus) -> dict[str, Any]:
        """The maze, its areas and the path through it, cells as (row, column).

        Pages get this before the guess: nothing in it may name condition or goal.
        """
        scene = self.pool.scenes[stimulus.maze]
        return {
            "rows": scene.rows,
            "cols": scene.cols,
            "walls": scene.walls,
            "areas": [
                {
                    "letter": area.letter,
                    "colour": AREA_STYLES[area.letter][0],
                    "pattern": AREA_STYLES[area.letter][1],
                    "cell": divmod(area.cell, scene.cols),
                }
                for area in scene.areas
            ],
            "path": [divmod(cell, scene.cols) for cell in stimulus.cells],
        }


def load_study(settings: Settings) -> Study:
    """The study that comes with the package, under these settings."""
    consent_text = files("app").joinpath("consent.txt").read_text(encoding="utf-8")
    return Study(settings, load_pool(), consent_text)
