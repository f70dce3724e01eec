"""The committed pool of stimuli, read with the standard library only: pages import this."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from types import MappingProxyType
from typing import Any

from policies.errors import StimulusError

CONDITIONS = ("polmdp", "optimal")
"""The two policies that a participant can be shown."""

Segment = tuple[int, int, int, int]


@dataclass(frozen=True)
class Area:
    """A lettered goal and the cell (state) it covers."""

    letter: str
    cell: int


@dataclass(frozen=True)
class Scene:
    """A maze as it is drawn.

    `walls`: straight segments (x1, y1, x2, y2) in cell units from the top-left corner, border
    included; `areas`: the goals in the order of their letters. Cells are numbered row-major.
    """

    rows: int
    cols: int
    walls: tuple[Segment, ...]
    areas: tuple[Area, ...]


@dataclass(frozen=True)
class Scenario:
    """A maze, a start cell and a goal's letter, the same for both conditions."""

    id: str
    maze: str
    start: int
    goal: str


@dataclass(frozen=True)
class Stimulus:
    """One rollout to be shown: `cells` are the T + 1 cells at steps 0 to T.

    `id` is a hash of the content and says nothing about condition or goal.
    """

    id: str
    scenario: str
    condition: str
    maze: str
    goal: str
    cells: tuple[int, ...]

    @property
    def steps(self) -> int:
        """Number of steps T, failed actions counted."""
        return len(self.cells) - 1


@dataclass(frozen=True)
class Pool:
    """Everything a study shows. `hash` identifies the content, whatever the file's line ends."""

    hash: str
    scenes: Mapping[str, Scene]
    scenarios: tuple[Scenario, ...]
    stimuli: Mapping[str, Stimulus]
    practice: Stimulus

    def stimulus(self, scenario_id: str, condition: str) -> Stimulus:
        """The scenario's rollout under a condition; StimulusError when the pool has none."""
        try:
            return self._by_condition[scenario_id, condition]
        except KeyError:
            raise StimulusError(
                f"expected a scenario of the pool and one of {', '.join(CONDITIONS)}; "
                f"came {scenario_id!r} and {condition!r}"
            ) from None

    @cached_property
    def _by_condition(self) -> dict[tuple[str, str], Stimulus]:
        return {(s.scenario, s.condition): s for s in self.stimuli.values()}


def load_pool() -> Pool:
    """The pool that comes with the package; StimulusError when its file is damaged."""
    return parse_pool(files("policies").joinpath("stimuli/pool.json").read_text(encoding="utf-8"))


def parse_pool(text: str) -> Pool:
    """A pool from the text of its file; StimulusError says what is missing or not as expected."""
    try:
        content = json.loads(text)
        stimuli = [_stimulus(fields) for fields in content["stimuli"]]
        return Pool(
            hash=content_hash(content),
            scenes=MappingProxyType({name: _scene(s) for name, s in content["scenes"].items()}),
            scenarios=tuple(Scenario(**fields) for fields in content["scenarios"]),
            stimuli=MappingProxyType({stimulus.id: stimulus for stimulus in stimuli}),
            practice=_stimulus(content["practice"]),
        )
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise StimulusError(
            f"pool.json: expected scenes, scenarios, stimuli and practice as `goalguess stimuli "
            f"build` writes them: {type(error).__name__}: {error}"
        ) from error


def content_hash(content: Any) -> str:
    """SHA-256 of a JSON value in canonical form: sorted keys, no blanks, ASCII."""
    canonical = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(canonical.encode("ascii")).hexdigest()


def _scene(fields: Mapping[str, Any]) -> Scene:
    walls = tuple((x1, y1, x2, y2) for x1, y1, x2, y2 in fields["walls"])
    areas = tuple(Area(letter, cell) for letter, cell in fields["areas"].items())
    return Scene(fields["rows"], fields["cols"], walls, areas)


def _stimulus(fields: Mapping[str, Any]) -> Stimulus:
    return Stimulus(**{**fields, "cells": tuple(fields["cells"])})
