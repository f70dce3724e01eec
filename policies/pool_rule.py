"""The rule by which the pool of stimuli is drawn: decided before any look at predictions."""

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from policies.errors import StimulusError
from policies.maze import ACTION_SETS, Maze
from policies.mdp import Array
from policies.polmdp import LegiblePlan, Parameters, plan_legible
from policies.rollout import draw_rollout

MAZES = ("nave", "pinwheel", "wings", "yards")
PRACTICE_MAZE = "practice"
PARAMETERS = Parameters(guard=True)
SECOND_OPTIMAL = "optimal again"
"""A second draw of the optimal policy, never shown: what two draws of one policy differ by."""

SCENARIOS = 37
STEPS = (14, 26)
STEPS_APART = 3
FROM_EQUAL_USE = 1
PRACTICE_STEPS = (8, 12)

DESIGN = (
    "The mazes were made for the question: rooms, doors and passages that several goals share, "
    "and more than one way. Mirrored or turned room plans were shaped by a computer search for a "
    "large expected saving over many draws of other seeds, and four unlike ones were taken.",
    "Pools on earlier mazes were looked at and given up with them; the seed stayed the same, and "
    "on these mazes it was drawn once.",
    "Preset `paper`, with the guard: no other variant or formulation tells clearly sooner on these "
    "mazes, which were shaped with it.",
)

RULE = (
    "Candidates: every maze, start and goal where the start is no goal's cell.",
    "Each candidate has one draw per condition, from a generator seeded by the SHA-256 of "
    "'seed maze start goal condition'. A draw is never repeated.",
    f"A candidate is dropped unless both draws arrive, both take {STEPS[0]} to {STEPS[1]} steps, "
    f"their steps differ by at most {STEPS_APART}, and the sets of cells they visit differ.",
    f"Of the others {SCENARIOS} are taken in an order shuffled from the seed, passing over those "
    f"with which mazes and goals could no longer all stay within {FROM_EQUAL_USE} of equal use.",
    "Practice: the first of its maze's candidates, in an order shuffled from the seed, whose one "
    f"draw from both policies in equal parts arrives in {PRACTICE_STEPS[0]} to "
    f"{PRACTICE_STEPS[1]} steps.",
    "Predictions play no part in the choice.",
)


@dataclass(frozen=True)
class Candidate:
    """A maze's name, a start state and a goal's letter."""

    maze: str
    start: int
    goal: str


class Planner:
    """The plans for every goal of every maze, each computed once; draws from a pool's seed."""

    def __init__(self, mazes: Mapping[str, Maze], seed: int) -> None:
        self.mazes = mazes
        self.seed = seed
        self._plans: dict[tuple[str, str], LegiblePlan] = {}

    def plan(self, maze: str, goal: str) -> LegiblePlan:
        """The plan for a goal, by the maze's name and the goal's letter."""
        if (maze, goal) not in self._plans:
            self._plans[maze, goal] = plan_legible(self.mazes[maze], goal, PARAMETERS)
        return self._plans[maze, goal]

    def policy(self, maze: str, goal: str, condition: str) -> Array:
        """What is played: `polmdp`, `optimal`, its second draw, or both in equal parts."""
        plan = self.plan(maze, goal)
        return {
            "polmdp": plan.policy_legible,
            "optimal": plan.policy_optimal,
            SECOND_OPTIMAL: plan.policy_optimal,
            PRACTICE_MAZE: (plan.policy_legible + plan.policy_optimal) / 2,
        }[condition]

    def goal(self, candidate: Candidate) -> int:
        """The state of a candidate's goal."""
        return self.mazes[candidate.maze].goals[candidate.goal]

    def draw(self, candidate: Candidate, condition: str) -> list[int]:
        """The cells of a candidate's one draw under a condition."""
        maze = self.mazes[candidate.maze]
        rollout = draw_rollout(
            maze,
            self.policy(candidate.maze, candidate.goal, condition),
            candidate.start,
            self.goal(candidate),
            generator(self.seed, candidate.maze, candidate.start, candidate.goal, condition),
            ACTION_SETS[PARAMETERS.actions],
        )
        return [int(x) for x in rollout.states]


def generator(*key: object) -> np.random.Generator:
    """A random generator of its own for a key such as (seed, maze, start, goal, condition)."""
    digest = hashlib.sha256(" ".join(map(str, key)).encode()).digest()
    return np.random.default_rng(int.from_bytes(digest, "big"))


def candidates(maze: Maze, name: str) -> list[Candidate]:
    """Every start and goal of a maze where the start is no goal's cell, nor in a closed room."""
    starts = maze.free_cells.tolist()
    return [Candidate(name, x, letter) for x in starts for letter in maze.goals]


def fault(pair: Sequence[Sequence[int]], goal: int) -> str | None:
    """How the cells of a scenario's two rollouts break the rule, or None if they keep it."""
    steps = [len(cells) - 1 for cells in pair]
    if not all(_arrives(cells, goal) for cells in pair):
        return "expected both rollouts to end on entering the goal"
    if min(steps) < STEPS[0] or max(steps) > STEPS[1]:
        return f"expected {STEPS[0]} to {STEPS[1]} steps, came {steps}"
    if max(steps) - min(steps) > STEPS_APART:
        return f"expected steps that differ by at most {STEPS_APART}, came {steps}"
    if len({frozenset(cells) for cells in pair}) == 1:
        return "expected rollouts that differ in the cells visited"
    return None


def practice_fault(cells: Sequence[int], goal: int) -> str | None:
    """How the cells of the practice rollout break the rule, or None if they keep it."""
    steps = len(cells) - 1
    if not _arrives(cells, goal):
        return "expected the practice rollout to end on entering the goal"
    if not PRACTICE_STEPS[0] <= steps <= PRACTICE_STEPS[1]:
        return f"expected {PRACTICE_STEPS[0]} to {PRACTICE_STEPS[1]} steps, came {steps}"
    return None


def choose(passing: Sequence[Candidate], mazes: Mapping[str, Maze], seed: int) -> list[Candidate]:
    """The scenarios of the pool, in a seeded order; StimulusError when there are too few."""
    goals = sorted(set(chain.from_iterable(maze.goals for maze in mazes.values())))
    chosen: list[Candidate] = []
    for i in generator(seed, "order").permutation(len(passing)):
        grown = [*chosen, passing[i]]
        left = SCENARIOS - len(grown)
        if can_balance([c.maze for c in grown], tuple(mazes), left) and can_balance(
            [c.goal for c in grown], goals, left
        ):
            chosen = grown
        if len(chosen) == SCENARIOS:
            return chosen
    raise StimulusError(
        f"expected {SCENARIOS} scenarios that keep the rule, found {len(chosen)} among "
        f"{len(passing)} candidates: the mazes need another design"
    )


def can_balance(used: Sequence[str], names: Sequence[str], left: int) -> bool:
    """Whether `left` more can bring the use of every name within the allowed span of equal use."""
    counts = Counter(used)
    equal = (len(used) + left) / len(names)
    missing = sum(max(0, np.ceil(equal - FROM_EQUAL_USE) - counts[name]) for name in names)
    return missing <= left and all(counts[name] <= equal + FROM_EQUAL_USE for name in names)


def _arrives(cells: Sequence[int], goal: int) -> bool:
    return cells.index(goal) == len(cells) - 1 if goal in cells else False
