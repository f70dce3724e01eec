import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from policies import (
    ACTION_SETS,
    ModelError,
    Rollout,
    action_beliefs,
    draw_rollout,
    legible_rewards,
    measure_legibility,
    parse_maze,
    plan_legible,
    steps_allowed,
)

ROW = parse_maze("+---+---+---+\n| A   .   B |\n+---+---+---+\n")
R_LEG = np.linspace(0.1, 0.9, 2 * 3 * 5).reshape(2, 3, 5)
WAY = Rollout(np.array([1, 1, 2]), np.array([3, 3]), arrived=True)
BELIEFS = np.array([[0.5, 0.5], [0.4, 0.6], [0.1, 0.9]])


def measured(**changes):
    return measure_legibility(
        **{"rollout": WAY, "goal": 1, "r_leg": R_LEG, "beliefs": BELIEFS, **changes}
    )


def test_both_frameworks_measures_by_hand():
    seen = measured(gamma=0.5)
    r = R_LEG[1, 1, 3]
    assert seen.polmdp == pytest.approx(r + 0.5 * r)
    assert seen.polmdp_per_step == pytest.approx(r)
    assert seen.lmdp == pytest.approx(0.5 + 0.5 * 0.4 + 0.25 * 0.1)


def test_the_lmdp_measure_by_the_distance_asked_for():
    kl = measured(gamma=1.0, distance="kl").lmdp
    assert kl == pytest.approx(-np.log(0.5 * 0.6 * 0.9))
    assert measured(gamma=1.0, distance="euclid").lmdp == pytest.approx(np.sqrt(2))


def test_the_curve_and_when_it_is_half_sure_and_sure():
    seen = measured()
    assert seen.belief_curve.tolist() == [0.5, 0.6, 0.9]
    assert (seen.steps_until_half, seen.steps_until_sure) == (1, 2)
    assert (seen.share_until_half, seen.share_until_sure) == (0.5, 1.0)
    assert seen.belief_area == pytest.approx((0.55 + 0.75) / 2)


def test_never_sure_counts_all_steps():
    seen = measured(goal=0)
    assert (seen.steps_until_half, seen.share_until_sure) == (2, 1.0)


@given(st.lists(st.floats(0, 1), min_size=2, max_size=30))
def test_the_area_lies_between_the_least_and_the_largest_belief(curve):
    T = len(curve) - 1
    way = Rollout(np.zeros(T + 1, int), np.zeros(T, int), arrived=False)
    beliefs = np.stack([np.array(curve), 1 - np.array(curve)], axis=1)
    area = measured(rollout=way, goal=0, beliefs=beliefs).belief_area
    assert min(curve) - 1e-12 <= area <= max(curve) + 1e-12


def test_without_a_step_there_is_no_mean_and_no_share():
    here = Rollout(np.array([2]), np.array([], int), arrived=True)
    seen = measured(rollout=here, beliefs=BELIEFS[:1])
    assert (seen.polmdp, seen.lmdp, seen.belief_area) == (0, 0.5, 0.5)
    assert np.isnan([seen.polmdp_per_step, seen.share_until_half, seen.share_until_sure]).all()


def test_a_belief_of_zero_makes_the_kl_measure_infinite():
    wrong = np.array([[0.5, 0.5], [1.0, 0.0], [0.5, 0.5]])
    assert measured(beliefs=wrong, distance="kl").lmdp == np.inf


def test_the_value_of_the_legible_policy_is_its_mean_measure(draw_maze):
    # In the reward formulation r_leg is collected for ever, so a long run has V_leg(start).
    plan = plan_legible(draw_maze(4, 4, 3, seed=2), "A")
    rng = np.random.default_rng(1)
    actions = ACTION_SETS["udlrn"]
    measures = []
    for _ in range(400):
        way = draw_rollout(plan.maze, plan.policy_legible, 0, None, rng, actions, 150)
        beliefs = action_beliefs(plan.maze, plan.q, way.states, way.actions, actions)
        seen = measure_legibility(way, 0, legible_rewards(plan.q, 0.5), beliefs)
        measures.append(seen.polmdp)
    error = np.std(measures) / np.sqrt(len(measures))
    assert np.mean(measures) == pytest.approx(plan.v_legible[0], abs=5 * error + 1e-5)


def test_beliefs_of_another_trajectory_are_refused():
    with pytest.raises(ModelError, match=r"shape \(3, 2\) for 2 steps and 2 goals, came \(2, 2\)"):
        measured(beliefs=BELIEFS[:2])


def test_a_goal_that_is_none_is_refused():
    with pytest.raises(ModelError, match="index from 0 to 1, came 2"):
        measured(goal=2)


@pytest.mark.parametrize(("distance", "steps"), [(0, 0), (1, 5), (17, 80), (18, 85)])
def test_steps_allowed_are_four_times_the_optimal_policys_mean(distance, steps):
    assert steps_allowed(distance) == steps
