"""Proving that a committed pool keeps every rule that its manifest states."""

import json
from collections import Counter
from collections.abc import Callable, Mapping
from importlib.resources import files
from importlib.resources.abc import Traversable
from itertools import combinations, pairwise
from typing import Any, NamedTuple

import numpy as np

from policies.errors import StimulusError
from policies.maze import ACTION_SETS, Maze
from policies.mdp import maze_transitions, policy_transitions
from policies.pool import CONDITIONS, Pool, Stimulus, content_hash, parse_pool
from policies.pool_build import build, manifest, package_mazes, scene, stimulus
from policies.pool_rule import (
    FROM_EQUAL_USE,
    MAZES,
    PARAMETERS,
    PRACTICE_MAZE,
    SCENARIOS,
    Candidate,
    Planner,
    fault,
    practice_fault,
)

GOALS = 6


class Given(NamedTuple):
    """What the checks look at: the files as they are, and what they say."""

    files: Mapping[str, str]
    content: Mapping[str, Any]
    manifest: Mapping[str, Any]
    pool: Pool
    mazes: Mapping[str, Maze]
    planner: Planner


def check(
    folder: Traversable | None = None, progress: Callable[[str], None] = lambda _: None
) -> None:
    """Prove every rule on the files of a folder (the package's own if None).

    `progress` gets each rule proved, in a sentence; StimulusError at the first one broken.
    """
    given = _read(folder or files("policies").joinpath("stimuli"))
    for prove in _CHECKS:
        prove(given)
        progress(str(prove.__doc__))


def _read(folder: Traversable) -> Given:
    texts = {}
    for name in ("pool.json", "manifest.json"):
        try:
            texts[name] = folder.joinpath(name).read_text(encoding="utf-8")
        except OSError as error:
            raise StimulusError(f"{name}: expected a readable file: {error.strerror}") from error
    pool = parse_pool(texts["pool.json"])
    try:
        stated = json.loads(texts["manifest.json"])
        seed = int(stated["seed"])
    except (ValueError, KeyError, TypeError) as error:
        raise StimulusError(f"manifest.json: expected JSON with a seed: {error!r}") from error
    mazes = package_mazes()
    content = json.loads(texts["pool.json"])
    return Given(texts, content, stated, pool, mazes, Planner(mazes, seed))


def _expect(holds: bool, message: str) -> None:
    if not holds:
        raise StimulusError(message)


def _scenes_are_the_mazes(given: Given) -> None:
    """Walls and areas are those of the maze files."""
    _expect(set(given.content["scenes"]) == set(given.mazes), "expected one scene per maze file")
    for name, maze in given.mazes.items():
        _expect(
            given.content["scenes"][name] == scene(maze),
            f"scene {name}: expected the walls and areas of mazes/{name}.txt",
        )


def _mazes_are_fit(given: Given) -> None:
    """Every maze of the pool has 10 x 10 cells and six areas, none next to another."""
    for name, maze in given.mazes.items():
        size = (6, 6) if name == PRACTICE_MAZE else (10, 10)
        _expect((maze.rows, maze.cols) == size, f"{name}: expected {size[0]} x {size[1]} cells")
        _expect(len(maze.goals) == GOALS, f"{name}: expected {GOALS} goals")
        for (one, x), (other, y) in combinations(maze.goals.items(), 2):
            apart = np.abs(np.subtract(maze.cell(x), maze.cell(y))).max()
            _expect(apart > 1, f"{name}: expected areas {one} and {other} not to touch")


def _plans_are_certified(given: Given) -> None:
    """Every policy shown is certified to arrive from every start."""
    for name, maze in given.mazes.items():
        for goal in maze.goals:
            certified = given.planner.plan(name, goal).certificate.certified
            _expect(certified, f"{name}, goal {goal}: expected a certified legible policy")


def _scenarios_are_distinct(given: Given) -> None:
    """There are 37 different scenarios, none of which starts in an area or a closed room."""
    pool = given.pool
    _expect(len(pool.scenarios) == SCENARIOS, f"expected {SCENARIOS} scenarios")
    for what in (
        {s.id for s in pool.scenarios},
        {(s.maze, s.start, s.goal) for s in pool.scenarios},
    ):
        _expect(len(what) == SCENARIOS, f"expected {SCENARIOS} different scenarios")
    for s in pool.scenarios:
        _expect(
            s.maze in MAZES and s.goal in given.mazes[s.maze].goals,
            f"{s.id}: expected a maze of the pool and one of its goals",
        )
        _expect(
            s.start in given.mazes[s.maze].free_cells,
            f"{s.id}: expected a start outside the areas, with a way to them",
        )


def _use_is_equal(given: Given) -> None:
    """Mazes and goals are used equally often, give or take the stated span."""
    scenarios = given.pool.scenarios
    letters = {letter for name in MAZES for letter in given.mazes[name].goals}
    for names, used in (
        (set(MAZES), Counter(s.maze for s in scenarios)),
        (letters, Counter(s.goal for s in scenarios)),
    ):
        for name in sorted(names):
            off = abs(used[name] - len(scenarios) / len(names))
            _expect(
                off <= FROM_EQUAL_USE,
                f"{name}: expected within {FROM_EQUAL_USE} of equal use, used {used[name]} times",
            )


def _one_stimulus_per_condition(given: Given) -> None:
    """Every scenario has one rollout per condition, named by the hash of its content."""
    pool = given.pool
    wanted = Counter((s.id, condition) for s in pool.scenarios for condition in CONDITIONS)
    came = Counter((s["scenario"], s["condition"]) for s in given.content["stimuli"])
    _expect(wanted == came, "expected one rollout per scenario and condition")
    by_id = {s.id: s for s in pool.scenarios}
    for s in pool.stimuli.values():
        scenario = by_id[s.scenario]
        _expect(
            (s.maze, s.goal, s.cells[0]) == (scenario.maze, scenario.goal, scenario.start),
            f"{s.id}: expected maze, goal and start of scenario {s.scenario}",
        )
    for s in (*pool.stimuli.values(), pool.practice):
        hashed = stimulus(given.content["scenes"], s.scenario, s.condition, _of(s), list(s.cells))
        _expect(s.id == hashed["id"], f"{s.id}: expected the hash of its content, {hashed['id']}")


def _pairs_keep_the_rule(given: Given) -> None:
    """Both rollouts arrive, in 14 to 26 steps, at most 3 apart, over different cells."""
    for s in given.pool.scenarios:
        pair = [given.pool.stimulus(s.id, condition).cells for condition in CONDITIONS]
        broken = fault(pair, given.mazes[s.maze].goals[s.goal])
        _expect(broken is None, f"{s.id}: {broken}")


def _practice_keeps_the_rule(given: Given) -> None:
    """The practice rollout has a maze of its own and takes 8 to 12 steps."""
    practice = given.pool.practice
    _expect(practice.maze == PRACTICE_MAZE, f"expected practice in maze {PRACTICE_MAZE}")
    broken = practice_fault(practice.cells, given.mazes[PRACTICE_MAZE].goals[practice.goal])
    _expect(broken is None, f"practice: {broken}")


def _steps_are_possible(given: Given) -> None:
    """Every step can happen under the policy it is said to come from."""
    actions = ACTION_SETS[PARAMETERS.actions]
    for s in (*given.pool.stimuli.values(), given.pool.practice):
        policy = given.planner.policy(s.maze, s.goal, s.condition)
        chain = policy_transitions(maze_transitions(given.mazes[s.maze], actions), policy)
        for x, y in pairwise(s.cells):
            _expect(chain[x, y] > 0, f"{s.id}: expected a step that can happen, came {x} to {y}")


def _draws_come_from_the_seed(given: Given) -> None:
    """Every rollout is the one draw of its seed, scenario and condition."""
    for s in (*given.pool.stimuli.values(), given.pool.practice):
        _expect(
            list(s.cells) == given.planner.draw(_of(s), s.condition),
            f"{s.id}: expected the draw of seed {given.planner.seed}",
        )


def _manifest_is_recomputed(given: Given) -> None:
    """Rule, hashes, belief curves and predictions of the manifest come out again."""
    again = json.loads(json.dumps(manifest(given.content, given.planner)))
    for key, value in again.items():
        _expect(given.manifest.get(key) == value, f"manifest.json: expected {key} as recomputed")
    _expect(set(given.manifest) == set(again), "manifest.json: expected no other entries")


def _tells_sooner(given: Given) -> None:
    """The predicted saving is clearly above that of a second draw of the optimal policy."""
    prediction = given.manifest["prediction"]
    saving, baseline = prediction["saving_steps"], prediction["baseline_steps"]
    _expect(
        saving["low"] > baseline["high"],
        f"expected the saving's interval (from {saving['low']}) above the baseline's "
        f"(to {baseline['high']}): the mazes need another design",
    )


def _builds_again(given: Given) -> None:
    """Building from the seed gives the same bytes."""
    for name, text in build(given.planner.seed).items():
        same = given.files[name] == text
        _expect(same, f"{name}: expected the bytes that seed {given.planner.seed} builds")


def _hash_is_stated(given: Given) -> None:
    """The manifest belongs to this pool."""
    stated = given.manifest.get("pool_sha256")
    _expect(stated == content_hash(given.content), "manifest.json: expected the pool's hash")


def _of(s: Stimulus) -> Candidate:
    return Candidate(s.maze, s.cells[0], s.goal)


_CHECKS: tuple[Callable[[Given], None], ...] = (
    _scenes_are_the_mazes,
    _mazes_are_fit,
    _plans_are_certified,
    _scenarios_are_distinct,
    _use_is_equal,
    _one_stimulus_per_condition,
    _pairs_keep_the_rule,
    _practice_keeps_the_rule,
    _steps_are_possible,
    _draws_come_from_the_seed,
    _hash_is_stated,
    _manifest_is_recomputed,
    _tells_sooner,
    _builds_again,
)
