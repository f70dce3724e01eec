"""How a simulated participant judges a round: from what the page was sent, and nothing else."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.special import softmax

from app.bots.kinds import Kind
from policies import (
    ACTION_SETS,
    OBSERVER_BETA,
    Area,
    Maze,
    Scene,
    goal_values,
    movement_beliefs,
    scene_maze,
)

ACTIONS = ACTION_SETS["udlrn"]
GAMMA = 0.9

Playback = Mapping[str, Any]


@dataclass(frozen=True)
class Judgement:
    """What somebody does in a round: when they stop, where they think it goes, how sure."""

    stop_time_ms: float
    reached_end: bool
    guess: str
    confidence: int
    guess_latency_ms: float
    confidence_latency_ms: float


@dataclass(frozen=True)
class Observer:
    """A noisy Bayesian observer.

    `beta`: how strictly they expect shortest ways; `threshold`: the belief at which they stop;
    `noise`: SD of a step's misjudgement, log belief; `lapse`: chance of guessing at random in a
    round; `bias`: added to their confidence, scale points.
    """

    beta: float
    threshold: float
    noise: float
    lapse: float
    bias: float

    @classmethod
    def draw(cls, rng: np.random.Generator) -> "Observer":
        """One person out of many."""
        return cls(
            beta=OBSERVER_BETA * float(rng.lognormal(0, 0.5)),
            threshold=float(rng.uniform(0.6, 0.95)),
            noise=float(rng.uniform(0.1, 0.6)),
            lapse=float(rng.beta(1, 15)),
            bias=float(rng.normal(0, 0.8)),
        )

    def judge(self, playback: Playback, rng: np.random.Generator) -> Judgement:
        """Stop when one area is believed in enough, and rate by that belief."""
        letters = letters_of(playback)
        beliefs = softmax(
            np.log(self.beliefs(playback)) + self.noise * rng.standard_normal(len(letters)), axis=1
        )
        sure = beliefs.max(axis=1) > self.threshold
        reaction_ms = float(rng.lognormal(np.log(450), 0.3))
        step = int(sure.argmax()) if sure.any() else len(beliefs) - 1
        stop_ms = step * playback["step_ms"] + reaction_ms
        guess, belief = int(beliefs[step].argmax()), float(beliefs[step].max())
        if rng.random() < self.lapse:
            guess = int(rng.integers(len(letters)))
        chance = 1 / len(letters)
        rating = 1 + 6 * (belief - chance) / (1 - chance) + self.bias + rng.normal(0, 0.6)
        return _judged(playback, stop_ms, letters[guess], round(rating), rng)

    def beliefs(self, playback: Playback) -> np.ndarray[Any, Any]:
        """What they would believe without noise at steps 0 to T, shape (T + 1, N)."""
        maze, q = _world(
            playback["rows"],
            playback["cols"],
            tuple(map(tuple, playback["walls"])),
            tuple((area["letter"], *area["cell"]) for area in playback["areas"]),
        )
        cells = np.array([row * maze.cols + col for row, col in playback["path"]])
        return movement_beliefs(maze, q, cells, ACTIONS, self.beta)


def guess_at_random(playback: Playback, rng: np.random.Generator) -> Judgement:
    """Stop at any moment and answer anything."""
    stop_ms = float(rng.uniform(0, length_ms(playback)))
    letter, rating = _any_answer(playback, rng)
    return _judged(playback, stop_ms, letter, rating, rng)


def speed(playback: Playback, rng: np.random.Generator) -> Judgement:
    """Get it over with: stop as soon as the button is there and answer anything."""
    stop_ms = float(rng.uniform(80, 600))
    letter, rating = _any_answer(playback, rng)
    return _judged(playback, stop_ms, letter, rating, rng, thought_ms=120)


def watch_to_the_end(playback: Playback, rng: np.random.Generator) -> Judgement:
    """Never stop: the robot says itself where it goes."""
    cell = playback["path"][-1]
    letter = next(area["letter"] for area in playback["areas"] if area["cell"] == cell)
    return _judged(playback, length_ms(playback), letter, 7, rng)


Judge = Callable[[Playback, np.random.Generator], Judgement]

CARELESS: Mapping[Kind, Judge] = {
    Kind.GUESSING: guess_at_random,
    Kind.SPEEDING: speed,
    Kind.NEVER_STOPPING: watch_to_the_end,
}
"""Kinds that judge otherwise than by what they believe."""


def letters_of(playback: Playback) -> list[str]:
    """The areas' letters in their order."""
    return [area["letter"] for area in playback["areas"]]


def length_ms(playback: Playback) -> int:
    """Full motion of an animation, as the page computes it."""
    return (len(playback["path"]) - 1) * int(playback["step_ms"])


def _any_answer(playback: Playback, rng: np.random.Generator) -> tuple[str, int]:
    return str(rng.choice(letters_of(playback))), int(rng.integers(1, 8))


def _judged(
    playback: Playback,
    stop_ms: float,
    letter: str,
    rating: float,
    rng: np.random.Generator,
    thought_ms: float = 1500,
) -> Judgement:
    whole = length_ms(playback)
    chosen_ms = round(float(rng.lognormal(np.log(thought_ms), 0.4)), 1)
    rated_ms = round(chosen_ms + float(rng.lognormal(np.log(thought_ms), 0.4)), 1)
    return Judgement(
        stop_time_ms=min(round(stop_ms, 1), whole),
        reached_end=stop_ms >= whole,
        guess=letter,
        confidence=int(np.clip(rating, 1, 7)),
        guess_latency_ms=chosen_ms,
        confidence_latency_ms=rated_ms,
    )


@lru_cache(maxsize=64)
def _world(
    rows: int,
    cols: int,
    walls: tuple[Any, ...],
    areas: tuple[tuple[str, int, int], ...],
) -> tuple[Maze, np.ndarray[Any, Any]]:
    """The maze on the page and every goal's values in it."""
    cells = tuple(Area(letter, row * cols + col) for letter, row, col in areas)
    maze = scene_maze(Scene(rows, cols, walls, cells))
    return maze, goal_values(maze, GAMMA, ACTIONS)
