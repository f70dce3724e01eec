"""The baseline as reported, against its pseudo-code in plain Python and exact expectations."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from policies import Bandit, ModelError, format_maze, parse_maze, play_lmdp, random_maze
from policies.lmdp_bandit import BanditSearch

CORRIDOR = """\
+---+---+---+---+
| A   .   .   B |
+---+---+---+---+
"""
MOVES = ((-1, 0), (1, 0), (0, -1), (0, 1))


class Plain:
    """The mode's pseudo-code with lists and dictionaries, sharing nothing with the package.

    Its draws come in the order of the compiled bandit's: a uniform for an action of the optimal
    policy, and one for whether an action that leads away fails.
    """

    def __init__(self, text, goal, *, depth=10):
        lines = text.splitlines()
        cells = [(i, j) for i in range(len(lines) // 2) for j in range(len(lines[0]) // 4)]
        self.number = {cell: x for x, cell in enumerate(cells)}
        self.after = {
            x: [self.number[self._step(lines, cell, move)] for move in MOVES]
            for cell, x in self.number.items()
        }
        letters = {lines[2 * i + 1][4 * j + 2]: self.number[i, j] for i, j in cells}
        self.goals = {letter: letters[letter] for letter in sorted(set(letters) - {"."})}
        self.q = {letter: self._values(x) for letter, x in self.goals.items()}
        self.goal, self.depth = goal, depth

    @staticmethod
    def _step(lines, cell, move):
        (i, j), (di, dj) = cell, move
        wall = lines[2 * i + 1 + di][4 * j + 2 + 2 * dj]
        return cell if wall in "|-" else (i + di, j + dj)

    def _values(self, goal):
        """Q of a goal by value iteration."""
        v = dict.fromkeys(self.after, 0.0)
        for _ in range(600):
            q = {
                x: [(x == goal) + 0.9 * (0.15 * v[x] + 0.85 * v[y]) for y in after]
                for x, after in self.after.items()
            }
            v = {x: max(values) for x, values in q.items()}
        return q

    def best(self, x):
        values = self.q[self.goal][x]
        return [a for a in range(4) if values[a] >= max(values) - 1e-9]

    def updated(self, belief, x, a):
        weight = {m: belief[m] * math.exp(0.5 * self.q[m][x][a]) for m in belief}
        return {m: w / sum(weight.values()) for m, w in weight.items()}

    def reward(self, belief):
        return -math.sqrt(1 - belief[self.goal] ** 2)

    def drawn_return(self, x, a, rng):
        belief, total = dict.fromkeys(self.goals, 1 / len(self.goals)), 0.0
        for k in range(self.depth):
            if k:
                best = self.best(x)
                a = best[int(rng.random() * len(best))]
            belief = self.updated(belief, x, a)
            total += 0.9**k * self.reward(belief)
            if x == self.goals[self.goal]:
                break
            if self.after[x][a] != x and rng.random() >= 0.15:
                x = self.after[x][a]
        return total

    def search(self, x, simulations, rng):
        q, n = [0.0] * 4, [1] * 4
        for i in range(4 + simulations):
            spread = [math.sqrt(2 * math.log(sum(n)) / n[a]) for a in range(4)]
            index = [q[a] + q[a] * spread[a] for a in range(4)]
            a = i if i < 4 else index.index(max(index))
            n[a] += 1
            q[a] += (self.drawn_return(x, a, rng) - q[a]) / n[a]
        return q, n

    def expected_return(self, x, a, belief=None, k=0):
        """By enumerating every history."""
        belief = self.updated(belief or dict.fromkeys(self.goals, 1 / len(self.goals)), x, a)
        total = 0.9**k * self.reward(belief)
        if x == self.goals[self.goal] or k + 1 == self.depth:
            return total
        for y, share in ((x, 0.15), (self.after[x][a], 0.85)):
            best = self.best(y)
            for following in best:
                later = self.expected_return(y, following, belief, k + 1)
                total += share / len(best) * later
        return total


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
