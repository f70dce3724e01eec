"""The plan: what the default says, what a file may change, how a wrong one is refused."""

import pytest

from analysis.contract import REFERENCE, TREATMENT
from analysis.errors import AnalysisError, TomlError
from analysis.exclusions import Exclusion
from analysis.plan import DEFAULT_FILE, default_plan, read_plan

HASH_OF_DEFAULT = "cad9258a0f4a10c18e7ea7c820ab2bde79abb2e4e96ad6cd819bc9c41a15cda8"
HASH_OF_OWN = "9d64831860a93b38fd57f6accc0dfbd62d99d44d05da0d06c345f4fe61ffe523"


def test_the_default_compares_the_conditions_of_the_export_as_the_statistics_ask():
    plan = default_plan()
    assert plan.arms.names == (TREATMENT, REFERENCE)
    assert [(each.hypothesis, each.measure, each.test) for each in plan.primary] == [
        ("H1", "correct", "two_way_difference"),
        ("H2", "prediction_time_s", "two_way_auc"),
        ("H2", "confidence", "two_way_auc"),
    ]
    assert plan.holm_family == ("correct", "prediction_time_s", "confidence")
    assert (plan.alpha, plan.time, plan.trials_per_participant) == (0.05, "penalised", 10)
    assert plan.chance_level == 1 / 6


def test_the_default_names_smallest_effects_of_shares_and_aucs_only():
    assert default_plan().smallest_effects == {"share": 0.05, "auc": 0.05}


def test_a_smallest_effect_of_its_own_leaves_the_others_as_they_are(plan_of):
    plan = plan_of("[smallest_effect]\nauc = 0.1\ns = 2")
    assert plan.smallest_effects == {"share": 0.05, "auc": 0.1, "s": 2.0}
    assert plan.content["smallest_effect"] == plan.smallest_effects


def test_plans_that_name_no_smallest_effect_keep_the_hash_they_had(plan_of):
    """Of the default plan and one of one's own, as hashed before the key was there."""
    assert default_plan().sha256 == HASH_OF_DEFAULT
    assert plan_of("[smallest_effect]\nshare = 0.05").sha256 == HASH_OF_DEFAULT
    assert plan_of('alpha = 0.01\ntime = "stop"').sha256 == HASH_OF_OWN


def test_the_default_leaves_nobody_out():
    assert default_plan().exclusions == ()


def test_what_a_plan_leaves_out_is_as_in_the_default(plan_of):
    plan = plan_of("alpha = 0.01")
    assert plan.alpha == 0.01
    assert plan.content | {"alpha": 0.05} == default_plan().content


def test_a_condition_without_a_label_is_called_by_its_name(plan_of):
    plan = plan_of('treatment.condition = "legible"\nreference.condition = "shortest"')
    assert plan.arms.labels == {"legible": "legible", "shortest": "shortest"}


def test_the_least_that_may_be_said_is_allowed(plan_of):
    plan = plan_of("seed = 0\nchoices = 2\ntrials_per_participant = 1")
    assert (plan.seed, plan.choices, plan.trials_per_participant) == (0, 2, 1)


def test_time_as_pressed_is_another_measure(plan_of):
    plan = plan_of('time = "stop"')
    assert plan.primary[1].measure == "stop_time_s"
    assert "stop_time_s" in plan.holm_family


def test_exclusions_keep_their_order_and_parameters(plan_of):
    plan = plan_of(
        '[[exclusions]]\nrule = "too_fast_trials"\nat_least = 3\n'
        '[[exclusions]]\nrule = "long_pauses"\nabove_s = 60\n'
    )
    assert plan.exclusions == (
        Exclusion("too_fast_trials", {"at_least": 3}),
        Exclusion("long_pauses", {"above_s": 60.0}),
    )


def test_the_hash_is_of_what_is_said_and_not_of_how(plan_of):
    lines = DEFAULT_FILE.read_text().splitlines()
    assert plan_of("\n".join(lines)).sha256 == default_plan().sha256
    assert plan_of("# nothing\n").sha256 == default_plan().sha256
    assert plan_of('holm_family = ["confidence", "time", "correct"]').sha256 == (
        default_plan().sha256
    )


def test_a_plan_registered_before_a_key_came_keeps_its_hash(plan_of):
    """The default plan's, when plans could not name covariates yet."""
    registered = "cad9258a0f4a10c18e7ea7c820ab2bde79abb2e4e96ad6cd819bc9c41a15cda8"
    assert default_plan().sha256 == registered
    assert plan_of("covariates = []").sha256 == registered


def test_covariates_are_told_in_one_order(plan_of):
    plan = plan_of('covariates = ["device", "trial_order"]')
    assert plan.covariates == ("trial_order", "device")
    assert plan.content["covariates"] == ["trial_order", "device"]


@pytest.mark.parametrize(
    "change",
    [
        "alpha = 0.049",
        'covariates = ["age"]',
        'time = "stop"',
        'holm_family = ["time", "confidence"]',
        "choices = 5",
        "trials_per_participant = 9",
        "smallest_effect.share = 0.1",
        "smallest_effect.s = 1",
        "seed = 2",
        'treatment.condition = "polmdp"',
        '[[exclusions]]\nrule = "same_guess"',
        '[primary]\ncorrect = "two_way_auc"\ntime = "two_way_auc"\nconfidence = "two_way_auc"',
    ],
)
def test_every_change_of_what_is_said_changes_the_hash(plan_of, change):
    assert plan_of(change).sha256 != default_plan().sha256


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        ("alpa = 0.05", "alpa", "expected one of the keys alpha, time, "),
        ("alpha = 0", "alpha", "expected a number above 0 and below 0.5, got 0"),
        ("alpha = 0.5", "alpha", "expected a number above 0 and below 0.5, got 0.5"),
        ("alpha = nan", "alpha", "expected a finite number, got nan"),
        ("alpha = true", "alpha", "expected a number, got True"),
        ('alpha = "small"', "alpha", "expected a number, got 'small'"),
        ("smallest_effect = 3", "smallest_effect", "expected a table, got 3"),
        ("smallest_effect.phi = 0.1", "smallest_effect.phi", "share, auc, s, scale_points"),
        ("smallest_effect.share = 0", "smallest_effect.share", "above 0 and below 1, got 0"),
        ("smallest_effect.share = 1.0", "smallest_effect.share", "above 0 and below 1, got 1.0"),
        ("smallest_effect.auc = 0.5", "smallest_effect.auc", "above 0 and below 0.5, got 0.5"),
        ("smallest_effect.s = 0", "smallest_effect.s", "expected a number above 0, got 0"),
        ('smallest_effect.s = "1 s"', "smallest_effect.s", "expected a number, got '1 s'"),
        ('time = "lead_in"', "time", "expected penalised or stop, got 'lead_in'"),
        ("seed = -1", "seed", "expected a whole number of at least 0, got -1"),
        ("seed = 1.5", "seed", "expected a whole number, got 1.5"),
        ("choices = 1", "choices", "expected a whole number of at least 2, got 1"),
        ("treatment = 1", "treatment", "expected a table, got 1"),
        ('treatment.name = "a"', "treatment.name", "one of the keys condition, label, got 'name'"),
        ('treatment.label = "a"', "treatment.condition", "expected a text, got nothing"),
        (
            'reference.condition = "polmdp"',
            "reference.condition",
            "expected another one than the treatment's, got 'polmdp'",
        ),
        (
            'reference = {condition = "optimal", label = "PoLMDP"}',
            "reference.label",
            "expected another one than the treatment's",
        ),
        ('primary.correct = "chi_square"', "primary.correct", "two_way_difference or two_way_auc"),
        ('primary.correct = "two_way_auc"', "primary.time", "got nothing"),
        ('primary.score = "two_way_auc"', "primary.score", "correct, time, confidence"),
        ('holm_family = ["score"]', "holm_family", "list of some of correct, time, confidence"),
        ('holm_family = ["time", "time"]', "holm_family", "list of some of"),
        ('holm_family = [["time"]]', "holm_family", "list of some of"),
        ('holm_family = "time"', "holm_family", "list of some of"),
        ('covariates = ["gender"]', "covariates", "list of some of trial_order, age, device, got"),
        ('covariates = ["age", "age"]', "covariates", "list of some of"),
        ('covariates = "age"', "covariates", "list of some of trial_order, age, device, got 'age'"),
        ("exclusions = 3", "exclusions", "expected a list of tables, got 3"),
        ("exclusions = [3]", "exclusions[1]", "expected a table, got 3"),
        ('[[exclusions]]\nrule = "dull"', "exclusions[1].rule", "expected incomplete or "),
        ("[[exclusions]]\nat_least = 2", "exclusions[1].rule", "got nothing"),
        (
            '[[exclusions]]\nrule = "same_guess"\n[[exclusions]]\nrule = "incomplete"',
            "exclusions[2].fewer_than",
            "expected a whole number, got nothing",
        ),
        (
            '[[exclusions]]\nrule = "same_guess"\nat_least = 2',
            "exclusions[1].at_least",
            "expected one of the keys rule, got 'at_least'",
        ),
    ],
)
def test_what_cannot_be_followed_is_named_by_file_and_key(plan_of, text, key, words):
    with pytest.raises(TomlError) as caught:
        plan_of(text)
    assert (caught.value.file, caught.value.key) == ("mine.toml", key)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_no_toml_or_not_there_is_one_clear_error(plan_of, tmp_path):
    with pytest.raises(TomlError, match=r"mine\.toml: expected TOML in UTF-8, got"):
        plan_of("alpha 0.05")
    with pytest.raises(AnalysisError, match=r"nothing\.toml: expected a TOML file, got"):
        read_plan(tmp_path / "nothing.toml")


@pytest.mark.parametrize(
    ("text", "hint"),
    [("alpha = .05", "write 0.05 for .05"), ("a = 1\nb=-.5", "write -0.5 for -.5")],
)
def test_a_number_that_toml_does_not_know_is_told_how_to_be_written(plan_of, text, hint):
    with pytest.raises(TomlError, match=rf"; {hint}$"):
        plan_of(text)


@pytest.mark.parametrize("text", ["# alpha = .05\nalpha 0.05", 'alpha = "none'])
def test_what_is_no_such_number_gets_no_hint(plan_of, text):
    with pytest.raises(TomlError, match=r"\)$"):
        plan_of(text)
