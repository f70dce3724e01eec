"""What the paper's authors computed, in plain Python: a second opinion for the tests."""

import math

import numpy as np

MOVES = ((-1, 0), (1, 0), (0, -1), (0, 1))


class Plain:
    """One goal of a maze, four moves, gamma .9, beta .5, as the paper's authors computed it.

    Lists, dictionaries and value iteration; nothing is shared with the package.
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
        self.goal, self.depth = goal, depth
        self.q = {
            letter: self._values({x: [float(x == state)] * 4 for x in self.after})
            for letter, state in self.goals.items()
        }
        self.r_leg = {x: [self.posterior(x, a) for a in range(4)] for x in self.after}
        self.q_legible = self._values(self.r_leg)

    @staticmethod
    def _step(lines, cell, move):
        (i, j), (di, dj) = cell, move
        wall = lines[2 * i + 1 + di][4 * j + 2 + 2 * dj]
        return cell if wall in "|-" else (i + di, j + dj)

    def _values(self, r):
        """Q of rewards r[x][a] by value iteration."""
        v = dict.fromkeys(self.after, 0.0)
        for _ in range(600):
            q = {
                x: [r[x][a] + 0.9 * (0.15 * v[x] + 0.85 * v[y]) for a, y in enumerate(after)]
                for x, after in self.after.items()
            }
            v = {x: max(values) for x, values in q.items()}
        return q

    def posterior(self, x, a):
        """The paper's r_leg of the goal."""
        return math.exp(0.5 * self.q[self.goal][x][a]) / sum(
            math.exp(0.5 * q[x][a]) for q in self.q.values()
        )

    def best(self, x, q=None):
        """The actions that tie, of the goal's own values or of others."""
        values = (q or self.q[self.goal])[x]
        return [a for a in range(4) if values[a] >= max(values) - 1e-10]

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
        """The bandit's values and counts.

        Draws come in the order of the compiled one's: a uniform for an action of the optimal
        policy, and one for whether an action that leads away fails.
        """
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

    def play(self, q, start):
        """States, and actions with the one drawn at the end, by uniforms from the seed 2021."""
        rng, states, taken = np.random.default_rng(2021), [start], []
        while True:
            x, best = states[-1], self.best(states[-1], q)
            taken.append(best[int(rng.random() * len(best))])
            if x == self.goals[self.goal] or len(states) == 503:
                return states, taken
            u, y = rng.random(), self.after[x][taken[-1]]
            # Over all states in order: where x comes first, small uniforms are failures.
            states.append(x if (u < 0.15 if x < y else u >= 0.85) else y)

    def measures(self, states, taken):
        """The PoLMDP and the L-MDP measure of the authors."""
        belief = dict.fromkeys(self.goals, 1 / len(self.goals))
        polmdp = lmdp = 0.0
        for t, (x, a) in enumerate(zip(states, taken, strict=True)):
            belief = self.updated(belief, x, a)
            polmdp += 0.9**t * self.r_leg[x][a]
            lmdp -= 0.9**t * self.reward(belief)
        return polmdp, lmdp
