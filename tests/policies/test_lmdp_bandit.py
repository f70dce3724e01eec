"""The baseline as reported, against its pseudo-code in plain Python and exact expectations."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from policies import Bandit, ModelError, format_maze, parse_maze, play_lmdp, random_maze
from policies.lmdp_bandit import BanditSearch
from tests.policies.plain import Plain

CORRIDOR = """\
+---+---+---+---+
| A   .   .   B |
+---+---+---+---+
"""


def searched(text, goal, x, seed, **effort):
    """The package's bandit after a run from x."""
    searching = BanditSearch(parse_maze(text), goal, Bandit(**effort))
    searching.run(x, None, np.random.default_rng(seed))
    return searching


class TestOneStep:
    @settings(max_examples=25, deadline=None)
    @given(st.integers(0, 10**6))
    def test_is_the_pseudo_codes_with_the_same_random_stream(self, seed):
        rng = np.random.default_rng(seed)
        text = format_maze(random_maze(3, 4, 3, rng, openness=0.4))
        goal, x = "ABC"[seed % 3], int(rng.integers(12))
        q, n = Plain(text, goal).search(x, 60, np.random.default_rng(seed))
        searching = searched(text, goal, x, seed, simulations=60)
        assert searching.q == pytest.approx(q, abs=1e-9)
        assert searching.arms.n.tolist() == n

    @pytest.mark.parametrize("x", range(4))
    @pytest.mark.parametrize("depth", [1, 3])
    def test_its_values_are_expected_returns_drawn_towards_zero(self, x, depth):
        plain = Plain(CORRIDOR, "A", depth=depth)
        searching = searched(CORRIDOR, "A", x, 1, simulations=20_000, depth=depth)
        for a, (q, n) in enumerate(zip(searching.q, searching.arms.n, strict=True)):
            # Half the range of a return bounds its standard deviation.
            error = 4 * depth / 2 / math.sqrt(n - 1)
            exact = plain.expected_return(x, a) * (n - 1) / n
            assert q == pytest.approx(exact, abs=1e-9 if x == 0 or depth == 1 else error)

    def test_at_the_goal_nothing_follows_the_action(self):
        plain = Plain(CORRIDOR, "A")
        searching = searched(CORRIDOR, "A", 0, 0, simulations=50)
        rewards = [
            plain.reward(plain.updated({"A": 0.5, "B": 0.5}, 0, a)) * (n - 1) / n
            for a, n in enumerate(searching.arms.n)
        ]
        assert searching.q == pytest.approx(rewards, abs=1e-12)

    def test_its_index_explores_the_wrong_way(self):
        """What is tried more is tried again: nearly all samples go to one action."""
        n = searched(CORRIDOR, "A", 2, 3, simulations=10_000).arms.n
        assert sorted(n)[:3] == [2, 2, 2]

    def test_every_sample_counts_once_from_one(self):
        n = searched(CORRIDOR, "B", 1, 3, simulations=500).arms.n
        assert n.sum() == 4 + 4 + 500


class TestAPlay:
    @pytest.mark.parametrize("seed", range(4))
    def test_ends_at_the_goal_or_after_502_moves(self, seed):
        rng = np.random.default_rng(seed)
        maze = random_maze(5, 8, 3, rng)
        start = int((maze.goals["A"] + 11) % 40)
        played = play_lmdp(maze, start, "A", rng, Bandit(simulations=20))
        arrived = played.rollout.states == maze.goals["A"]
        assert played.rollout.arrived == arrived[-1]
        assert not arrived[:-1].any()
        assert (played.ended == "step limit") == (played.rollout.steps == 502)
        assert set(played.rollout.actions) <= {0, 1, 2, 3}

    def test_takes_the_least_value_of_a_search_that_forgets(self):
        maze = parse_maze(CORRIDOR)
        played = play_lmdp(maze, 2, "A", np.random.default_rng(5), Bandit(30), most_moves=6)
        rng, plain = np.random.default_rng(5), Plain(CORRIDOR, "A")
        x = 2
        for a, y in zip(played.rollout.actions, played.rollout.states[1:], strict=True):
            q, _ = plain.search(x, 30, rng)
            assert a == q.index(min(q))
            x = x if rng.random() < 0.15 else plain.after[x][a]
            assert x == y

    def test_a_time_limit_ends_it(self):
        maze = parse_maze(CORRIDOR)
        search = Bandit(time_limit_s=1e-9)
        played = play_lmdp(maze, 2, "A", np.random.default_rng(5), search)
        assert (played.ended, played.simulations) == ("time limit", 0)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"simulations": 0}, "simulations of at least 1, came 0"),
        ({"depth": 0}, "depth of at least 1, came 0"),
        ({"time_limit_s": 0.0}, "time limit above 0 s, came 0.0"),
    ],
)
def test_an_effort_that_ends_nowhere_is_refused(wrong, said):
    with pytest.raises(ModelError, match=said):
        Bandit(**wrong)
