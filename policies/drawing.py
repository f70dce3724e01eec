"""Mazes, policies and rollouts drawn with characters."""

from collections.abc import Mapping, Sequence

import numpy as np

from policies.certificate import LARGEST_STRETCH
from policies.maze import FAILURE, Action, Maze
from policies.mdp import Array
from policies.polmdp import LegiblePlan
from policies.solvers import distances

LEGEND = "↑ ↓ ← → moves (↕ ↔ two in one), o stay, * more than fit, letters goals"

_PLAIN = str.maketrans("↑↓←→↕↔", "^v<>:=")


def in_encoding(text: str, encoding: str | None) -> str:
    """The text with plain signs for arrows where the output cannot show them."""
    try:
        text.encode(encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return text.translate(_PLAIN)
    return text


def draw_cells(maze: Maze, content: Mapping[int, str], width: int) -> list[str]:
    """The lines of a maze with `content[x]`, at most `width` characters, in its cells."""
    border = ("+" + "-" * width) * maze.cols + "+"
    lines = [border]
    for i in range(maze.rows):
        cells = [content.get(i * maze.cols + j, "")[:width].center(width) for j in range(maze.cols)]
        walls = ["|" if wall else " " for wall in maze.wall_right[i]] + ["|"]
        lines.append("|" + "".join(c + w for c, w in zip(cells, walls, strict=True)))
        if i < maze.rows - 1:
            below = [("-" if wall else " ") * width for wall in maze.wall_below[i]]
            lines.append("+" + "+".join(below) + "+")
    return [*lines, border]


def draw_policy(maze: Maze, policy: Array, actions: Sequence[Action]) -> list[str]:
    """The lines of an arrow map: every action that the policy can take, per cell, (S, A).

    Closed rooms stay blank.
    """
    content = {
        int(x): arrows({actions[int(a)] for a in np.flatnonzero(policy[x])})
        for x in maze.free_cells
    }
    content |= {state: letter for letter, state in maze.goals.items()}
    return draw_cells(maze, content, width=2)


def arrows(taken: set[Action]) -> str:
    """The sign of a set of tied actions, at most two characters."""
    upright = {Action.UP: "↑", Action.DOWN: "↓"}
    level = {Action.LEFT: "←", Action.RIGHT: "→"}
    signs = "o" if Action.NOOP in taken else ""
    for pair, both in ((upright, "↕"), (level, "↔")):
        signs += both if set(pair) <= taken else "".join(pair[a] for a in pair if a in taken)
    return signs if len(signs) <= 2 else "*"


def draw_plan(plan: LegiblePlan, actions: Sequence[Action], columns: int) -> str:
    """Arrow maps of the optimal and the legible policy, side by side where the columns allow."""
    maps = {
        f"optimal policy to {plan.goal}": draw_policy(plan.maze, plan.policy_optimal, actions),
        f"legible policy to {plan.goal}": draw_policy(plan.maze, plan.policy_legible, actions),
    }
    width = max(len(line) for title, lines in maps.items() for line in (title, *lines))
    blocks = [[title, *lines] for title, lines in maps.items()]
    if 2 * width + 3 <= columns:
        both = zip(*blocks, strict=True)
        return "\n".join(f"{left:<{width}}   {right}".rstrip() for left, right in both)
    return "\n\n".join("\n".join(block) for block in blocks)


def describe(plan: LegiblePlan) -> list[str]:
    """The prior unless uniform, expected steps and the certificate, in sentences."""
    maze, certificate = plan.maze, plan.certificate
    away = certificate.reaches_goal & (np.arange(maze.states) != maze.goals[plan.goal])
    if not away.any():
        return ["no start but the goal itself"]
    fewest = distances(maze)[maze.goal_index(plan.goal)] / (1 - FAILURE)
    arrive = away & certificate.arrives
    means = [
        f"{name} {steps[arrive].mean():.2f}" if arrive.any() else f"{name} -"
        for name, steps in (("optimal", fewest), ("legible", certificate.expected_steps))
    ]
    lines = [f"expected steps, mean of the {arrive.sum()} starts that arrive: {', '.join(means)}"]
    if np.ptp(plan.prior):
        believed = zip(maze.letters, plan.prior, strict=True)
        lines.insert(0, "prior: " + ", ".join(f"{letter} {p:.3g}" for letter, p in believed))
    closed = int((~certificate.reaches_goal).sum())
    if certificate.certified:
        starts = "every start that reaches the goal" if closed else "every start"
        lines.append(
            f"certified: arrives from {starts}, with at most "
            f"{certificate.stretch[away].max():.2f} times the steps of the optimal policy"
        )
    else:
        fails = np.flatnonzero(certificate.fails_at)
        i, j = maze.cell(int(fails[0]))
        lines.append(
            f"not certified: from {len(fails)} of {away.sum()} starts, row {i + 1} column {j + 1} "
            f"the first, it does not arrive or takes over {LARGEST_STRETCH:g} times as long; "
            "--guard repairs that"
        )
    if closed:
        cells = "1 cell reaches" if closed == 1 else f"{closed} cells reach"
        lines.append(f"{cells} no goal (blank above): no start, and all values there are 0")
    return lines


def draw_path(maze: Maze, cells: Sequence[int]) -> str:
    """A rollout in its maze: the step at which each cell was first entered, letters for goals."""
    content: dict[int, str] = {}
    for step, x in enumerate(cells):
        content.setdefault(x, str(step))
    for letter, x in maze.goals.items():
        content[x] = f"{letter}{content.get(x, '')}"
    return "\n".join(draw_cells(maze, content, width=3))


def draw_beliefs(maze: Maze, cells: Sequence[int], beliefs: Array, goal: str) -> str:
    """A table of the beliefs per step and goal, `beliefs[t, n]`, with a bar for the true one."""
    n = maze.goal_index(goal)
    lines = ["step  cell    " + "".join(f"{letter:>6}" for letter in maze.letters)]
    for step, (x, belief) in enumerate(zip(cells, beliefs, strict=True)):
        i, j = maze.cell(x)
        stood = "." if step and cells[step - 1] == x else " "
        row = "".join(f"{b:6.2f}" for b in belief)
        bar = "#" * round(20 * float(belief[n]))
        lines.append(f"{step:>4}{stood} {i + 1:>2},{j + 1:<2}   {row}  {bar}".rstrip())
    return "\n".join(lines)
