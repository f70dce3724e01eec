"""How fast mazes are solved, ours beside other solvers, interleaved in one process.

Example: python -m tests.benchmarks.solvers --sizes 10 25 75 --repeats 5

Needs the extra `bench`. What is timed, as processor time, for a maze with six goals, beta .5:
for ours, everything from the maze on: distances, q of all goals, r_leg of all goals, and the
legible values of one goal (or all six) with their bound. For a peer only its solving: the six
goals' MDPs and one (or all six) with the legible rewards, which it gets from us; building its
model is not counted, nor is computing the rewards. One run of each is thrown away (compilation).
Times are medians over the repeats. A peer whose smaller maze took too long is left out (-).
Exit code 1 if values differ by more than 1e-6, or ours are not certified to 1e-8.
"""

import argparse
import sys
import time
from dataclasses import dataclass
from statistics import median

import numpy as np

from policies import ACTION_SETS, Maze, maze_rewards, maze_transitions, random_maze, solve_maze
from policies.mdp import Array
from tests.benchmarks.solver_peers import ERROR, PEERS, Solve

ACTIONS = ACTION_SETS["udlrn"]
GOALS = 6
BETA = 0.5
AGREE = 1e-6
GAMMAS = (0.9, 0.99)


@dataclass
class Runs:
    """Processor times of one solver in ms, for one legible target and for all six."""

    one: list[float]
    all: list[float]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[10, 25, 75, 200, 500])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--longest", type=float, default=20, help="Seconds a peer may take.")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    print(f"{'maze':>9} {'gamma':>5} {'solver':>10} {'one, ms':>9} {'ratio':>6}", end=" ")
    print(f"{'all, ms':>9} {'ratio':>6}")
    agreed = True
    for gamma in GAMMAS:
        peers = dict(PEERS)
        for size in given.sizes:
            maze = random_maze(size, size, GOALS, np.random.default_rng(given.seed))
            runs, holds = measure(maze, gamma, list(peers), given.repeats)
            agreed &= holds
            report(f"{size} x {size}", gamma, runs)
            for name in list(peers):
                # Sizes grow at least threefold, and times with their square or faster.
                if median(runs[name].all) * 8 > 1000 * given.longest:
                    del peers[name]
    if not agreed:
        sys.exit("Values differ, or ours are not certified.")


def measure(
    maze: Maze, gamma: float, peers: list[str], repeats: int
) -> tuple[dict[str, Runs], bool]:
    """Times by solver, runs in turn; and whether all values agree and ours are certified."""
    q, r_leg = maze_rewards(maze, gamma, ACTIONS, BETA, "as_printed")
    legible = [solve_maze(maze, r, gamma, ACTIONS) for r in r_leg]
    ours = [*q.max(axis=2), *(solution.v for solution in legible)]
    holds = all(solution.bound <= ERROR for solution in legible)
    P = maze_transitions(maze, ACTIONS)
    at_goal = np.zeros_like(q)
    at_goal[range(GOALS), list(maze.goals.values())] = 1
    problems = [*at_goal, *r_leg]
    prepared = {name: [PEERS[name](P, r, gamma) for r in problems] for name in peers}
    runs = {name: Runs([], []) for name in ("ours", *peers)}
    for repeat in range(repeats + 1):
        timed = {"ours": time_ours(maze, gamma)}
        for name in peers:
            each = []
            for solve, wanted in zip(prepared[name], ours, strict=True):
                ms, v = time_peer(solve)
                each.append(ms)
                holds &= bool(np.abs(v - wanted).max() <= AGREE)
            timed[name] = sum(each[: GOALS + 1]), sum(each)
        for name, (one, six) in timed.items():
            if repeat > 0:
                runs[name].one.append(one)
                runs[name].all.append(six)
    return runs, holds


def time_ours(maze: Maze, gamma: float) -> tuple[float, float]:
    """ms for one legible target and for all, q and r_leg of all goals included in both."""
    begin = time.process_time()
    _, r_leg = maze_rewards(maze, gamma, ACTIONS, BETA, "as_printed")
    each = []
    for r in r_leg:
        solve_maze(maze, r, gamma, ACTIONS)
        each.append(1000 * (time.process_time() - begin))
    return each[0], each[-1]


def time_peer(solve: Solve) -> tuple[float, Array]:
    """ms of one solution, and its values."""
    begin = time.process_time()
    v = solve()
    return 1000 * (time.process_time() - begin), v


def report(size: str, gamma: float, runs: dict[str, Runs]) -> None:
    """One line a solver: medians, and how many times ours they are."""
    one, six = median(runs["ours"].one), median(runs["ours"].all)
    for name in ("ours", *PEERS):
        line = f"{size:>9} {gamma:>5} {name:>10}"
        if name in runs:
            ms, all_ms = median(runs[name].one), median(runs[name].all)
            print(f"{line} {ms:9.2f} {ms / one:6.1f} {all_ms:9.2f} {all_ms / six:6.1f}", flush=True)
        else:
            print(f"{line} {'-':>9} {'-':>6} {'-':>9} {'-':>6}", flush=True)


if __name__ == "__main__":
    main()
