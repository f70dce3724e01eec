"""Building the pool: mazes and a seed in, the bytes of its two files out."""

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict
from importlib.resources import as_file, files
from typing import Any

import numpy as np
from scipy import stats

from policies.errors import StimulusError
from policies.maze import ACTION_SETS, FAILURE, Maze, format_maze
from policies.maze_files import read_maze_files
from policies.mdp import Array
from policies.observer import OBSERVER_BETA, movement_beliefs, steps_until_sure
from policies.pool import CONDITIONS, content_hash
from policies.pool_rule import (
    DESIGN,
    MAZES,
    PARAMETERS,
    PRACTICE_MAZE,
    RULE,
    SECOND_OPTIMAL,
    Candidate,
    Planner,
    candidates,
    choose,
    fault,
    generator,
    practice_fault,
)
from policies.solvers import goal_values

SURE = 0.8
"""The belief in the true goal above which the predicted observer counts as sure."""


def build(seed: int, progress: Callable[[str], None] = lambda _: None) -> dict[str, str]:
    """The files of the pool, name to text: the same bytes for the same seed and mazes."""
    mazes = package_mazes()
    planner = Planner({name: mazes[name] for name in (*MAZES, PRACTICE_MAZE)}, seed)
    shown = {name: mazes[name] for name in MAZES}
    fit = []
    for name in MAZES:
        progress(f"drawing every start and goal of maze {name}")
        fit += passing(planner, name)
    chosen = choose(fit, shown, seed)
    scenes = {name: scene(maze) for name, maze in planner.mazes.items()}
    scenarios = [
        {"id": f"s{i:02}", "maze": c.maze, "start": c.start, "goal": c.goal}
        for i, c in enumerate(chosen, start=1)
    ]
    stimuli = [
        stimulus(scenes, f"s{i:02}", condition, candidate, planner.draw(candidate, condition))
        for i, candidate in enumerate(chosen, start=1)
        for condition in CONDITIONS
    ]
    pool = {
        "scenes": scenes,
        "scenarios": scenarios,
        # In the order of their ids, which says nothing of scenario or condition.
        "stimuli": sorted(stimuli, key=lambda fields: str(fields["id"])),
        "practice": practice(planner, scenes),
    }
    return {"pool.json": as_lines(pool), "manifest.json": as_lines(manifest(pool, planner))}


def package_mazes() -> dict[str, Maze]:
    """The mazes that come with the package, by name."""
    with as_file(files("policies").joinpath("mazes")) as folder:
        return read_maze_files(folder / f"{name}.txt" for name in (*MAZES, PRACTICE_MAZE))


def passing(planner: Planner, name: str) -> list[Candidate]:
    """The candidates of a maze whose draws keep the rule."""
    return [
        candidate
        for candidate in candidates(planner.mazes[name], name)
        if fault([planner.draw(candidate, c) for c in CONDITIONS], planner.goal(candidate)) is None
    ]


def practice(planner: Planner, scenes: Mapping[str, Any]) -> dict[str, Any]:
    """The practice rollout, which belongs to neither condition."""
    tried = candidates(planner.mazes[PRACTICE_MAZE], PRACTICE_MAZE)
    for i in generator(planner.seed, "practice order").permutation(len(tried)):
        cells = planner.draw(tried[i], PRACTICE_MAZE)
        if practice_fault(cells, planner.goal(tried[i])) is None:
            return stimulus(scenes, PRACTICE_MAZE, PRACTICE_MAZE, tried[i], cells)
    raise StimulusError("expected a practice rollout that keeps the rule, found none")


def stimulus(
    scenes: Mapping[str, Any], scenario: str, condition: str, candidate: Candidate, cells: list[int]
) -> dict[str, Any]:
    """A stimulus as the file holds it; its id is a hash of all that is shown and meant."""
    fields = {
        "scenario": scenario,
        "condition": condition,
        "maze": candidate.maze,
        "goal": candidate.goal,
        "cells": cells,
    }
    return {"id": content_hash([scenes[candidate.maze], fields])[:12], **fields}


def scene(maze: Maze) -> dict[str, Any]:
    """A maze as it is drawn: straight walls merged, border included, and areas by letter."""
    below = np.ones((maze.rows + 1, maze.cols), bool)
    below[1:-1] = maze.wall_below
    right = np.ones((maze.rows, maze.cols + 1), bool)
    right[:, 1:-1] = maze.wall_right
    across = [[x1, y, x2, y] for y, line in enumerate(below) for x1, x2 in _runs(line)]
    down = [[x, y1, x, y2] for x, line in enumerate(right.T) for y1, y2 in _runs(line)]
    return {
        "rows": maze.rows,
        "cols": maze.cols,
        "walls": across + down,
        "areas": dict(maze.goals),
    }


def manifest(pool: Mapping[str, Any], planner: Planner) -> dict[str, Any]:
    """What the pool is, the rule it was drawn by, and how much sooner its legible half tells."""
    curves = {s["id"]: _curve(planner, s["maze"], s["goal"], s["cells"]) for s in pool["stimuli"]}
    sure = {(s["scenario"], s["condition"]): _sure(curves[s["id"]]) for s in pool["stimuli"]}
    for s in pool["scenarios"]:
        cells = planner.draw(Candidate(s["maze"], s["start"], s["goal"]), SECOND_OPTIMAL)
        sure[s["id"], SECOND_OPTIMAL] = _sure(_curve(planner, s["maze"], s["goal"], cells))
    compared = (*CONDITIONS, SECOND_OPTIMAL)
    steps = {c: np.array([sure[s["id"], c] for s in pool["scenarios"]]) for c in compared}
    return {
        "pool_sha256": content_hash(pool),
        "seed": planner.seed,
        "parameters": {**asdict(PARAMETERS), "failure": FAILURE, "beta_observer": OBSERVER_BETA},
        "design": list(DESIGN),
        "rule": list(RULE),
        "mazes_sha256": {n: content_hash(format_maze(m)) for n, m in planner.mazes.items()},
        "prediction": prediction(steps),
        "steps_until_sure": [
            {"scenario": s["id"], **{c: sure[s["id"], c] for c in compared}}
            for s in pool["scenarios"]
        ],
        "belief_in_true_goal": {key: curve.round(6).tolist() for key, curve in curves.items()},
    }


def prediction(steps: Mapping[str, Array]) -> dict[str, Any]:
    """Mean predicted saving and its baseline from steps until sure, per scenario, (37,) each."""
    optimal, legible = steps["optimal"], steps["polmdp"]
    return {
        "observer": (
            f"Bayesian, sees only the movement, beta {OBSERVER_BETA:g}; sure = belief in the "
            f"true goal above {SURE:g}, and the whole length where it never is"
        ),
        "interval": f"t interval of the mean over the {len(optimal)} scenarios, 95 %",
        "saving": "steps until sure, optimal minus polmdp",
        "baseline": "steps until sure, optimal minus a second draw of the optimal policy",
        "mean_steps_until_sure": {c: round(float(s.mean()), 4) for c, s in steps.items()},
        "saving_steps": mean_with_interval(optimal - legible),
        "saving_percent": round(100 * float(1 - legible.sum() / optimal.sum()), 2),
        "baseline_steps": mean_with_interval(optimal - steps[SECOND_OPTIMAL]),
    }


def beliefs(maze: Maze, cells: Sequence[int]) -> Array:
    """The predicted observer's beliefs at steps 0 to T in every goal, shape (T + 1, N)."""
    actions = ACTION_SETS[PARAMETERS.actions]
    q = goal_values(maze, PARAMETERS.gamma, actions)
    return movement_beliefs(maze, q, np.array(cells), actions)


def mean_with_interval(values: Array) -> dict[str, float]:
    """Mean and its 95 % t interval."""
    mean, error = float(np.mean(values)), float(stats.sem(values))
    half = float(stats.t.ppf(0.975, len(values) - 1)) * error
    return {"mean": round(mean, 4), "low": round(mean - half, 4), "high": round(mean + half, 4)}


def as_lines(content: Mapping[str, Any]) -> str:
    """JSON with one line per entry of each part, so that a difference shows what changed."""
    parts = []
    for key, value in content.items():
        if isinstance(value, dict):
            inner = [f"{json.dumps(k)}: {json.dumps(v)}" for k, v in value.items()]
            parts.append(f"{json.dumps(key)}: {{\n    " + ",\n    ".join(inner) + "\n  }")
        elif isinstance(value, list):
            inner = [json.dumps(entry) for entry in value]
            parts.append(f"{json.dumps(key)}: [\n    " + ",\n    ".join(inner) + "\n  ]")
        else:
            parts.append(f"{json.dumps(key)}: {json.dumps(value)}")
    return "{\n  " + ",\n  ".join(parts) + "\n}\n"


def _curve(planner: Planner, maze: str, goal: str, cells: Sequence[int]) -> Array:
    shown = planner.mazes[maze]
    return beliefs(shown, cells)[:, shown.goal_index(goal)]


def _sure(curve: Array) -> int:
    return steps_until_sure(curve[:, None], 0, SURE)


def _runs(line: Iterable[bool]) -> list[tuple[int, int]]:
    """Begin and end of every run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(line, int), [0]])))
    return [(int(begin), int(end)) for begin, end in edges.reshape(-1, 2)]
