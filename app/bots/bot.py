"""One simulated participant: who they are, drawn from the seed before anything happens."""

from dataclasses import dataclass

import numpy as np

from app.assignment import LIST_LENGTH
from app.bots.kinds import Kind
from app.bots.observer import CARELESS, Judgement, Observer, Playback
from app.schemas import Device
from app.steps import Phase

MOMENTS = (
    "/",
    "/about-you",
    "/instructions",
    "/practice",
    *(f"{phase} {index}" for index in range(1, LIST_LENGTH + 1) for phase in Phase),
    "/end",
)
"""Where somebody can be: at a page, or in a phase of a round."""

CONSENT = MOMENTS[0]

_DESKTOPS = ((1920, 1080, 1.0), (1536, 864, 1.25), (1280, 800, 2.0))
_PHONES = ((390, 844, 3.0), (360, 740, 3.0))


@dataclass(frozen=True)
class Bot:
    """`leaves_at` is the moment at which one who leaves, withdraws or returns later does so."""

    number: int
    recruiter_id: str
    kind: Kind
    observer: Observer
    device: Device
    leaves_at: str | None
    rng: np.random.Generator

    @classmethod
    def draw(cls, seed: int, number: int, kind: Kind, rng: np.random.Generator) -> "Bot":
        """The bot of a number; `rng` is its own and goes with it."""
        return cls(
            number=number,
            recruiter_id=f"simulated-{seed}-{number}",
            kind=kind,
            observer=Observer.draw(rng),
            device=_device(rng),
            leaves_at=_moment(kind, rng),
            rng=rng,
        )

    @property
    def returns_later(self) -> bool:
        """Whether it leaves to come back in another browser when all others are done."""
        return self.kind == Kind.RETURNING and self.leaves_at is not None

    def judge(self, playback: Playback) -> Judgement:
        """What this bot does in a round."""
        return CARELESS.get(self.kind, self.observer.judge)(playback, self.rng)

    def happens(self, chance: float) -> bool:
        """Whether something happens to this bot now."""
        return bool(self.rng.random() < chance)


def _device(rng: np.random.Generator) -> Device:
    phone = rng.random() < 0.4
    screens = _PHONES if phone else _DESKTOPS
    width, height, ratio = screens[rng.integers(len(screens))]
    pointers = ("touch",) if phone else ("mouse", "mouse", "mouse", "keyboard")
    return Device(
        viewport_width=width,
        viewport_height=height,
        pixel_ratio=ratio,
        refresh_rate_hz=float(rng.choice([60.0, 60.0, 120.0])),
        pointer_type=str(rng.choice(pointers)),
        reduced_motion=bool(rng.random() < 0.03),
    )


def _moment(kind: Kind, rng: np.random.Generator) -> str | None:
    possible = {
        Kind.DROPPING_OUT: MOMENTS[:-1],
        Kind.RETURNING: MOMENTS[1:-1],
        Kind.WITHDRAWING: MOMENTS[1:],
    }.get(kind)
    return str(rng.choice(possible)) if possible else None
