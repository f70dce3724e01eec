"""The teaching experiment (paper, 4.3): after how many examples does a learner name the goal?

Two teachers, the legible policy `polmdp` and the `optimal` one, show the same learner the same
starts (`sequences`: rollouts, which go on after arrival) or the same sets of states (`samples`:
one action in each, unconnected).
"""

import hashlib
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from importlib.resources import as_file, files
from pathlib import Path
from typing import Literal, get_args

import joblib
import numpy as np

from policies.errors import MazeError, ModelError
from policies.experiments.store import Store
from policies.irl import ACTIONS, Indices, Learner, Predictor
from policies.maze import Maze, format_maze
from policies.maze_files import read_mazes
from policies.mdp import Array
from policies.polmdp import plan_legible
from policies.pool import CONDITIONS
from policies.pool_rule import generator
from policies.rollout import draw_rollout

Lessons = Literal["sequences", "samples"]
Row = Mapping[str, object]

EXAMPLES = 20
TRAJECTORIES = 10

KEY = ("maze", "unit", "goal", "teacher", "trajectory")
COLUMNS = (*KEY, "guesses")
"""`guesses`: the letters of the goals guessed after 1, 2, ... EXAMPLES examples."""


@dataclass(frozen=True)
class TeachingDesign:
    """What is run: kind of lessons, number of units a maze, the learner, the seed.

    A unit is a start (a random cell without a goal) or a set of EXAMPLES random states, drawn
    independently with replacement, none in a closed room; its lessons are for every goal by both
    teachers. Starts have TRAJECTORIES rollouts each, sets one draw of actions.
    """

    lessons: Lessons
    units: int = 250
    predictor: Predictor = "bayes"
    eta: float = 10.0
    seed: int = 0

    def __post_init__(self) -> None:
        if self.lessons not in get_args(Lessons):
            raise ModelError(
                f"expected lessons in {', '.join(get_args(Lessons))}; came {self.lessons!r}"
            )
        if self.units < 2:
            raise ModelError(f"expected at least 2 units for an interval, came {self.units}")

    @property
    def name(self) -> str:
        """The stem of its result files."""
        return f"{self.lessons}-{self.predictor}"

    @property
    def trajectories(self) -> int:
        """Lessons of one unit, goal and teacher."""
        return TRAJECTORIES if self.lessons == "sequences" else 1


@dataclass(frozen=True, eq=False)
class Classroom:
    """A maze under its name, who learns in it, and the teachers' `policies[teacher][n]`, (S, A)."""

    name: str
    learner: Learner
    policies: Mapping[str, list[Array]]

    @property
    def maze(self) -> Maze:
        """Where it all happens."""
        return self.learner.maze


def classroom_mazes() -> dict[str, Maze]:
    """The four 10 x 10 mazes that come with the package: random ones, six goals each."""
    with as_file(files("policies.experiments").joinpath("mazes")) as folder:
        return read_mazes(folder)


def unteachable(maze: Maze) -> str | None:
    """Why nothing can be taught in a maze, or None: two goals and a cell without one are needed."""
    if len(maze.goals) > 1 and len(maze.free_cells):
        return None
    return (
        "expected at least 2 goals and a cell without one, came "
        f"{len(maze.goals)} goals in {maze.reaches_goal.sum()} cells"
    )


def run_teaching(
    design: TeachingDesign,
    mazes: Mapping[str, Maze],
    folder: Path,
    workers: int = 1,
    *,
    resume: bool = False,
    progress: Callable[[int, int], None] = lambda _done, _of: None,
) -> Path:
    """Run what is not there yet; returns the file of rows, the same whatever the workers.

    Every unit has a generator of its own, and its rows are appended in the order of the units:
    a killed run that is resumed ends with the file of an unbroken one. `progress` gets the
    units done and how many there are.
    """
    faults = [f"{name}: {said}" for name, maze in mazes.items() if (said := unteachable(maze))]
    if faults:
        raise MazeError("\n".join(faults))
    rooms = [_furnish(design, name, maze) for name, maze in mazes.items()]
    store = Store(folder, design.name, _parameters(design, mazes), COLUMNS, resume=resume)
    done = store.done(KEY)
    rows_of = Counter(key[:2] for key in done)
    open_units = [
        (room, unit)
        for room in rooms
        for unit in range(design.units)
        if rows_of[room.name, str(unit)] < _rows_of_a_unit(design, room)
    ]
    total = design.units * len(rooms)
    finished = total - len(open_units)
    progress(finished, total)
    run = joblib.Parallel(n_jobs=workers, return_as="generator")
    for rows in run(joblib.delayed(unit_rows)(design, room, unit) for room, unit in open_units):
        # The last unit of a killed run may be there in part.
        store.append(row for row in rows if tuple(str(row[name]) for name in KEY) not in done)
        finished += 1
        progress(finished, total)
    return store.file


def unit_rows(design: TeachingDesign, room: Classroom, unit: int) -> list[Row]:
    """All lessons of a unit and what the learner guessed in them."""
    # Apart, so that learners who draw more or fewer lots are shown the same.
    drawing, guessing = generator(design.seed, design.lessons, room.name, unit).spawn(2)
    states = _draw_states(design, room.maze, drawing)
    rows: list[Row] = []
    for n, goal in enumerate(room.maze.letters):
        for teacher in CONDITIONS:
            for trajectory in range(design.trajectories):
                x, a = _lesson(room.maze, room.policies[teacher][n], states, drawing)
                guessed = room.learner.guesses(x, a, guessing)
                letters = "".join(room.maze.letters[m] for m in guessed)
                cells = (room.name, unit, goal, teacher, trajectory, letters)
                rows.append(dict(zip(COLUMNS, cells, strict=True)))
    return rows


def _draw_states(design: TeachingDesign, maze: Maze, rng: np.random.Generator) -> Indices:
    """A start without a goal, alone; or EXAMPLES states."""
    if design.lessons == "samples":
        cells = np.flatnonzero(maze.reaches_goal)
        return cells[rng.integers(len(cells), size=EXAMPLES)]
    return rng.choice(maze.free_cells, size=1)


def _lesson(
    maze: Maze, policy: Array, states: Indices, rng: np.random.Generator
) -> tuple[Indices, Indices]:
    """EXAMPLES states and the teacher's actions: along a rollout from one start, or in each."""
    if len(states) == 1:
        rollout = draw_rollout(maze, policy, int(states[0]), None, rng, ACTIONS, EXAMPLES)
        return rollout.states[:-1], rollout.actions
    upto = np.cumsum(policy[states], axis=1)
    return states, (rng.random((len(states), 1)) * upto[:, -1:] >= upto).sum(axis=1)


def _furnish(design: TeachingDesign, name: str, maze: Maze) -> Classroom:
    plans = [plan_legible(maze, goal) for goal in maze.letters]
    policies = {
        "polmdp": [plan.policy_legible for plan in plans],
        "optimal": [plan.policy_optimal for plan in plans],
    }
    return Classroom(name, Learner(maze, design.predictor, design.eta), policies)


def _rows_of_a_unit(design: TeachingDesign, room: Classroom) -> int:
    return len(room.maze.goals) * len(CONDITIONS) * design.trajectories


def _parameters(design: TeachingDesign, mazes: Mapping[str, Maze]) -> dict[str, object]:
    """What a run can only be resumed with: the design, and the mazes by their content."""
    digests = {
        name: hashlib.sha256(format_maze(maze).encode()).hexdigest()[:16]
        for name, maze in mazes.items()
    }
    return {**asdict(design), "mazes": digests}
