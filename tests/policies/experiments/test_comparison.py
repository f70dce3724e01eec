import pytest

from policies import Bandit, ModelError, Search
from policies.experiments.comparison import POLMDPS, PRESETS, Comparison, design_comparison


class TestVariants:
    def test_each_is_a_framework_in_one_order_however_they_are_told(self):
        told = design_comparison(variants=["advantage", "as_printed", "advantage"])
        assert told.frameworks == ("polmdp", "polmdp_advantage", "lmdp", "optimal")
        assert told == design_comparison(variants=["as_printed", "advantage"])

    def test_all_are_all(self):
        comparison = design_comparison(variants=["all"])
        assert comparison.variants == tuple(POLMDPS)
        assert {p.variant for p in comparison.polmdps.values()} == set(POLMDPS)

    def test_the_first_one_measures_all_frameworks(self):
        assert design_comparison(variants=["all"]).measured_by.variant == "as_printed"
        assert design_comparison(variants=["advantage"]).measured_by.variant == "advantage"


class TestChoices:
    def test_reach_the_parameters_of_polmdp(self):
        comparison = design_comparison(
            beta=0.7, gamma=0.8, formulation="cost", guard=True, actions="udlrn"
        )
        (parameters,) = comparison.polmdps.values()
        assert vars(parameters) == {
            **{"beta": 0.7, "gamma": 0.8, "formulation": "cost", "guard": True},
            **{"actions": "udlrn", "variant": "as_printed"},
        }

    def test_reach_the_search_of_miura(self):
        comparison = design_comparison(
            gamma=0.8, distance="kl", observer_beta=2.0, actions="udlrn", simulations=7, limit_s=3
        )
        assert comparison.search == Search(
            "kl", gamma=0.8, beta=2.0, actions="udlrn", simulations=7, time_limit_s=3
        )

    def test_leave_the_baseline_as_it_was_reported(self):
        comparison = design_comparison(mode="as_reported", gamma=0.8, distance="kl", simulations=7)
        assert comparison.search == Bandit(simulations=7, time_limit_s=60)

    @pytest.mark.parametrize(
        ("chosen", "allowed"),
        [
            ({}, 48),
            ({"mode": "as_reported"}, 502),
            ({"preset": "authors"}, 502),
            ({"most_moves": 9}, 9),
            ({"mode": "as_reported", "most_moves": 9}, 9),
        ],
    )
    def test_decide_how_many_moves_are_allowed_at_a_distance_of_10(self, chosen, allowed):
        assert design_comparison(**chosen).moves_allowed(10) == allowed

    def test_name_the_files_by_the_test_else_by_the_mazes(self):
        assert Comparison("goals").name == "goals"
        assert Comparison().name == "mazes"


class TestThePresetOfTheAuthors:
    def test_settles_its_choices(self):
        comparison = design_comparison("authors")
        assert all(getattr(comparison, name) == v for name, v in PRESETS["authors"].items())

    def test_leaves_effort_and_pairs_open(self):
        comparison = design_comparison("authors", simulations=5, pairs=3, seed=1, limit_s=2)
        assert (comparison.simulations, comparison.pairs) == (5, 3)

    def test_takes_a_choice_that_is_its_own(self):
        assert design_comparison("authors", beta=0.5) == design_comparison("authors")

    @pytest.mark.parametrize(
        ("chosen", "said"),
        [
            ({"mode": "miura"}, "expected mode as_reported with preset authors, came miura"),
            ({"beta": 0.7}, "expected beta 0.5 with preset authors, came 0.7"),
            ({"gamma": 0.8}, "expected gamma 0.9 with"),
            (
                {"variants": ["all"]},
                "expected variants as_printed with preset authors, came as_printed p",
            ),
            ({"formulation": "cost"}, "expected formulation reward with"),
            ({"guard": True}, "expected guard False with"),
            ({"distance": "tv"}, "expected distance reported with"),
            ({"observer_beta": 5.0}, "expected observer_beta 0.5 with"),
            ({"actions": "udlrn"}, "expected actions udlr with"),
            ({"most_moves": 99}, "expected most_moves 502 with"),
        ],
    )
    def test_refuses_another_choice(self, chosen, said):
        with pytest.raises(ModelError, match=said):
            design_comparison("authors", **chosen)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"test": "walls"}, "expected a test in goals, states; came 'walls'"),
        ({"preset": "ours"}, "expected a preset in authors; came 'ours'"),
        ({"pairs": 0}, "expected at least 1 pair a world, came 0"),
        ({"mode": "x"}, "expected mode in miura, as_reported; came 'x'"),
        ({"simulations": 0}, "expected simulations of at least 1"),
        ({"limit_s": 0}, "expected a time limit above 0 s"),
        ({"most_moves": 0}, "expected at least 1 move, came 0"),
        (
            {"variants": ["x"]},
            "expected variants in as_printed, .*; came 'x'",
        ),
        ({"distance": "reported"}, "expected a distance in tv, euclid, kl; came 'reported'"),
        ({"mode": "as_reported", "distance": "x"}, "expected a distance in tv, euclid, kl"),
        ({"observer_beta": 0.0}, "expected a finite observer_beta above 0, came 0"),
        (
            {"mode": "as_reported", "observer_beta": -1.0},
            "expected a finite observer_beta above 0, came -1",
        ),
        ({"gamma": 1.0}, "expected gamma in"),
        ({"formulation": "x"}, "expected formulation in reward, cost"),
        ({"actions": "lr"}, "expected actions in udlr, udlrn"),
        (
            {"mode": "as_reported", "actions": "udlrn"},
            "expected actions udlr with mode as_reported, came udlrn",
        ),
    ],
)
def test_what_cannot_be_run_is_refused(wrong, said):
    with pytest.raises(ModelError, match=said):
        design_comparison(**wrong)
