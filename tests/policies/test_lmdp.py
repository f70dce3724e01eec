"""L-MDP's plays; the search itself is judged in test_lmdp_search.py."""

import subprocess
import sys
from dataclasses import replace
from itertools import count

import numpy as np
import pytest
from joblib import Parallel, delayed

from policies import (
    ACTION_SETS,
    MazeError,
    ModelError,
    Search,
    action_beliefs,
    draw_rollout,
    goal_values,
    measure_legibility,
    play_lmdp,
    random_maze,
    shortest_path_policy,
)
from policies import lmdp as lmdp_module
from policies import searching as searching_module

ACTIONS = ACTION_SETS["udlrn"]
QUICK = Search(simulations=300)


def draw_pair(rows: int, cols: int, goals: int, seed: int):
    """A fresh maze, a start that is not the goal, and the goal's letter."""
    rng = np.random.default_rng(seed)
    maze = random_maze(rows, cols, goals, rng)
    letter = maze.letters[seed % goals]
    others = np.delete(np.arange(maze.states), maze.goals[letter])
    return maze, int(rng.choice(others)), letter


def play(rows: int, cols: int, goals: int, seed: int, search: Search = QUICK):
    maze, start, letter = draw_pair(rows, cols, goals, seed)
    return play_lmdp(maze, start, letter, np.random.default_rng(seed), search)


def same(one, other) -> bool:
    return (
        one.rollout.states.tobytes() == other.rollout.states.tobytes()
        and one.rollout.actions.tobytes() == other.rollout.actions.tobytes()
        and one.beliefs.tobytes() == other.beliefs.tobytes()
        and (one.ended, one.simulations) == (other.ended, other.simulations)
    )


class TestAPlay:
    @pytest.mark.parametrize("seed", range(5))
    def test_its_beliefs_are_those_of_the_observer_who_sees_the_actions(self, seed):
        maze, _, _ = draw_pair(5, 8, 3, seed)
        played = play(5, 8, 3, seed)
        q = goal_values(maze, 0.9, ACTIONS)
        way = played.rollout
        seen = action_beliefs(maze, q, way.states, way.actions, ACTIONS)
        assert played.beliefs == pytest.approx(seen, abs=1e-12)

    @pytest.mark.parametrize("seed", range(5))
    def test_it_ends_on_arriving_and_says_so(self, seed):
        maze, _, letter = draw_pair(5, 8, 3, seed)
        played = play(5, 8, 3, seed)
        assert (played.ended, played.rollout.arrived) == ("arrived", True)
        assert np.flatnonzero(played.rollout.states == maze.goals[letter]).tolist() == [
            played.rollout.steps
        ]
        assert played.simulations == 300 * played.rollout.steps

    def test_at_the_goal_there_is_nothing_to_do(self):
        maze, _, letter = draw_pair(5, 8, 3, 1)
        played = play_lmdp(maze, maze.goals[letter], letter, np.random.default_rng(1))
        assert (played.ended, played.rollout.steps, played.simulations) == ("arrived", 0, 0)
        assert played.beliefs.tolist() == [[1 / 3] * 3]

    def test_it_gives_up_after_the_steps_allowed(self, monkeypatch):
        monkeypatch.setattr(lmdp_module, "steps_allowed", lambda _: 2)
        played = play(10, 10, 6, 3)
        assert (played.ended, played.rollout.steps, played.rollout.arrived) == (
            "step limit",
            2,
            False,
        )

    def test_it_gives_up_after_the_moves_that_are_asked_for(self):
        maze, start, letter = draw_pair(10, 10, 6, 3)
        played = play_lmdp(maze, start, letter, np.random.default_rng(3), QUICK, most_moves=2)
        assert (played.ended, played.rollout.steps) == ("step limit", 2)

    def test_a_goal_entered_with_the_last_step_allowed_counts(self, monkeypatch):
        steps = play(5, 8, 3, 0).rollout.steps
        monkeypatch.setattr(lmdp_module, "steps_allowed", lambda _: steps)
        assert play(5, 8, 3, 0).ended == "arrived"

    def test_the_same_seed_gives_the_same_play_and_another_one_another(self):
        assert same(play(10, 10, 6, 1), play(10, 10, 6, 1))
        maze, start, letter = draw_pair(10, 10, 6, 1)
        other = play_lmdp(maze, start, letter, np.random.default_rng(2), QUICK)
        assert not same(play(10, 10, 6, 1), other)

    def test_two_workers_play_as_one(self):
        seeds = range(4)
        alone = [play(5, 8, 3, seed) for seed in seeds]
        shared = Parallel(n_jobs=2)(delayed(play)(5, 8, 3, seed) for seed in seeds)
        assert all(map(same, alone, shared))


class TestTimeLimit:
    def test_the_clock_is_looked_at_within_every_10_000_simulated_steps(self, monkeypatch):
        looks = count()
        for module in (lmdp_module, searching_module):
            monkeypatch.setattr(module, "perf_counter", lambda: next(looks) * 1e-3)
        search = Search(simulations=10**5, depth=20, time_limit_s=0.05)
        played = play(25, 25, 6, 4, search)
        # Each look costs a millisecond of this clock and is followed by 500 simulations.
        assert played.ended == "time limit"
        assert played.rollout.steps == 0
        assert played.simulations == pytest.approx(48 * 500, abs=2 * 500)

    def test_it_is_kept_by_the_real_clock(self):
        play(25, 25, 6, 4)  # compiles what is not compiled yet
        played = play(25, 25, 6, 4, Search(simulations=10**6, time_limit_s=0.2))
        assert played.ended == "time limit"
        assert 0.2 <= played.solve_time_s + played.search_time_s < 2

    def test_solving_alone_can_use_it_up(self):
        played = play(5, 8, 3, 1, Search(time_limit_s=1e-9))
        assert (played.ended, played.simulations, played.rollout.steps) == ("time limit", 0, 0)

    def test_a_limit_that_is_not_reached_changes_nothing(self):
        assert same(play(5, 8, 3, 2), play(5, 8, 3, 2, replace(QUICK, time_limit_s=3600)))


class TestSearching:
    def test_miura_beats_the_optimal_policy_on_its_own_measure_and_arrives(self):
        gained, arrived = [], 0
        for seed in range(60):
            maze, start, letter = draw_pair(10, 10, 6, seed)
            n, goal = maze.goal_index(letter), maze.goals[letter]
            q = goal_values(maze, 0.9, ACTIONS)
            rng = np.random.default_rng(seed)
            played = play_lmdp(maze, start, letter, rng, QUICK)
            optimal = shortest_path_policy(maze, goal, ACTIONS)
            best = draw_rollout(maze, optimal, start, goal, rng, ACTIONS)
            watched = action_beliefs(maze, q, best.states, best.actions, ACTIONS)
            lmdp = measure_legibility(played.rollout, n, q, played.beliefs).lmdp
            gained.append(measure_legibility(best, n, q, watched).lmdp - lmdp)
            arrived += played.rollout.arrived
        assert np.mean(gained) > 2 * np.std(gained) / np.sqrt(60)
        assert arrived >= 57

    def test_miura_nearly_always_arrives_in_small_mazes(self):
        assert sum(play(5, 8, 3, seed).rollout.arrived for seed in range(100)) >= 98

    def test_miura_arrives_in_large_mazes(self):
        search = replace(QUICK, simulations=1000)
        # Seeds are fixed; a search that wanders arrives in few of these.
        assert sum(play(25, 25, 6, seed, search).rollout.arrived for seed in range(30)) >= 24


class TestBadInput:
    @pytest.mark.parametrize(
        ("wrong", "said"),
        [
            ({"simulations": 0}, "simulations of at least 1, came 0"),
            ({"depth": 0}, "depth of at least 1, came 0"),
            ({"exploration": -1.0}, "finite exploration of at least 0, came -1.0"),
            ({"task": float("nan")}, "finite task of at least 0, came nan"),
            ({"beta": 0.0}, "finite beta above 0, came 0.0"),
            ({"gamma": 1.0}, r"gamma in \[0, 1\), came 1.0"),
            ({"time_limit_s": 0.0}, "time limit above 0 s, came 0.0"),
            ({"distance": "far"}, "distance in tv, euclid, kl; came 'far'"),
            ({"rollouts": "good"}, "rollouts in optimal, random; came 'good'"),
            ({"actions": "lr"}, "actions in udlr, udlrn; came 'lr'"),
        ],
    )
    def test_parameters_are_refused_with_what_is_expected(self, wrong, said):
        with pytest.raises(ModelError, match=said):
            Search(**wrong)

    @pytest.mark.parametrize("start", [-1, 40])
    def test_a_start_outside_the_maze_is_refused(self, start):
        maze, _, letter = draw_pair(5, 8, 3, 0)
        with pytest.raises(ModelError, match=f"a start from 0 to 39, came {start}"):
            play_lmdp(maze, start, letter, np.random.default_rng(0))

    def test_an_unknown_goal_is_refused(self):
        maze, start, _ = draw_pair(5, 8, 3, 0)
        with pytest.raises(MazeError, match="came 'Z'"):
            play_lmdp(maze, start, "Z", np.random.default_rng(0))


def test_the_compiler_loads_only_for_a_search():
    code = (
        "import sys; from policies import Search, play_lmdp; Search();"
        "sys.exit('numba' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
