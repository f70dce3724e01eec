"""What an observer believes of the goals before the robot moves: a prior, uniform or given."""

from collections.abc import Mapping

import numpy as np

from policies.errors import ModelError
from policies.maze import Maze
from policies.mdp import Array


def goal_prior(maze: Maze, weights: Mapping[str, float]) -> Array:
    """The prior over a maze's goals, in their order, (N,): the weights, by letter, over their sum.

    ModelError for a letter that is no goal, a goal without a weight, a weight not above 0.
    """
    if set(weights) != set(maze.goals):
        raise ModelError(
            f"expected a prior weight for each of the goals {' '.join(maze.goals)}, came "
            f"{' '.join(weights) or 'none'}"
        )
    return normalised(np.array([weights[letter] for letter in maze.goals]), len(maze.goals))


def normalised(prior: Array | None, goals: int) -> Array:
    """A prior divided by its sum, uniform if None, shape (N,).

    ModelError unless each of the goals has a finite weight above 0, next to the others too.
    """
    weights = np.ones(goals) if prior is None else prior
    with np.errstate(all="ignore"):
        shares: Array = weights / weights.sum()
    if weights.shape != (goals,) or not ((weights > 0) & (shares > 0)).all():
        raise ModelError(
            f"expected a finite prior weight above 0 for each of {goals} goals, came "
            f"{weights.tolist()}"
        )
    return shares


def parse_weights(text: str) -> dict[str, float]:
    """Weights by letter from text such as A=.5,B=.3,C=.2; ModelError names what is not."""
    weights: dict[str, float] = {}
    for part in text.split(","):
        letter, equals, number = (piece.strip() for piece in part.partition("="))
        try:
            weight = float(number)
        except ValueError:
            equals = ""
        if not (letter and equals) or letter in weights:
            raise ModelError(
                f"expected a prior as A=.5,B=.3,C=.2, each letter once; came {part.strip()!r} "
                f"in {text!r}"
            )
        weights[letter] = weight
    return weights
