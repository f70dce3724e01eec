"""Other solvers of MDPs: each function builds a problem in the peer's form and returns its solving.

All are asked for values with an error of at most 1e-8. Iterations that stop when values change by
less than a tolerance are given 1e-8 (1 - gamma), which is what that error takes.
"""

from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_array

from policies.mdp import Array

ERROR = 1e-8

Solve = Callable[[], Array]
Prepare = Callable[[csr_array, Array, float], Solve]


def by_state(P: csr_array, r: Array) -> csr_array:
    """The rows of P, (A * S, S), reordered from a * S + x to x * A + a."""
    S, A = r.shape
    rows = np.arange(A * S).reshape(A, S).T.ravel()
    ordered = csr_array(P[rows])
    ordered.sum_duplicates()
    return ordered


def stormpy(P: csr_array, r: Array, gamma: float) -> Solve:
    """Storm's sparse engine: discounted total reward, its default method for it."""
    import stormpy
    from stormpy.datastructures import SparseMatrixBuilder
    from stormpy.models import SparseMdp, SparseModelComponents, SparseRewardModel, StateLabeling

    S, A = r.shape
    rows = by_state(P, r)
    builder = SparseMatrixBuilder[float](force_dimensions=False, has_custom_row_grouping=True)
    for i in range(A * S):
        if i % A == 0:
            builder.new_row_group(i)
        for j in range(rows.indptr[i], rows.indptr[i + 1]):
            builder.add_next_value(i, int(rows.indices[j]), float(rows.data[j]))
    labels = StateLabeling(S)
    labels.add_label("init")
    labels.add_label_to_state("init", 0)
    rewards = SparseRewardModel[float](optional_state_action_reward_vector=r.ravel().tolist())
    model = SparseMdp[float](
        SparseModelComponents[float](
            transition_matrix=builder.build(), state_labeling=labels, reward_models={"r": rewards}
        )
    )
    wanted = stormpy.parse_properties(f'R{{"r"}}max=? [Cdiscount={gamma}]')[0]
    how = stormpy.Environment()
    how.solver().min_max().precision = stormpy.Rational(ERROR * (1 - gamma))
    how.solver().min_max().relative_termination_criterion = False

    def solve() -> Array:
        return np.array(stormpy.model_checking(model, wanted, environment=how).get_value_vector())

    return solve


def quantecon(P: csr_array, r: Array, gamma: float) -> Solve:
    """QuantEcon's value iteration; its modified policy iteration stops by span, off by up to 1."""
    from quantecon.markov import DiscreteDP
    from scipy.sparse import csr_matrix

    x, a = np.divmod(np.arange(r.size), r.shape[1])
    problem = DiscreteDP(r.ravel(), csr_matrix(by_state(P, r)), gamma, x, a)

    def solve() -> Array:
        result = problem.solve("value_iteration", epsilon=2 * ERROR, max_iter=10**6)
        return np.asarray(result.v)

    return solve


def mdpsolver(P: csr_array, r: Array, gamma: float) -> Solve:
    """The solver's own modified policy iteration, on one core like all others."""
    from mdpsolver import model

    S, A = r.shape
    rows = by_state(P, r)
    cut = [slice(*rows.indptr[i : i + 2]) for i in range(A * S)]
    problem = model()
    problem.mdp(
        discount=gamma,
        rewards=r.tolist(),
        tranMatProbs=[[rows.data[cut[x * A + a]].tolist() for a in range(A)] for x in range(S)],
        tranMatColumns=[
            [rows.indices[cut[x * A + a]].tolist() for a in range(A)] for x in range(S)
        ],
    )

    def solve() -> Array:
        # Without a start it would begin with what it found the last time.
        problem.solve(
            algorithm="mpi",
            tolerance=ERROR * (1 - gamma),
            initPolicy=[0] * S,
            initValueVector=[0.0] * S,
            parallel=False,
        )
        return np.array(problem.getValueVector())

    return solve


PEERS: dict[str, Prepare] = {"stormpy": stormpy, "quantecon": quantecon, "mdpsolver": mdpsolver}
