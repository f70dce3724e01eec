"""Power by simulation: known numbers of participants, the curve, the search, the command."""

import json

import numpy as np
import polars as pl
import pytest
from scipy import stats
from typer.testing import CliRunner

from analysis import AnalysisError
from analysis.__main__ import alone
from analysis.crossed_model import Spread, confidence_model, correct_model
from analysis.figures.power import figure_power
from analysis.power import PowerQuestion, power_at, search_power
from analysis.power_curve import PowerCurve, fit_power
from analysis.statistics.estimates import share

SPREAD = Spread(0.8, 0.8, 0.4)
ACCURACY = correct_model(SPREAD, 0.85, 0.70)


def question(model=ACCURACY, tests=("two_way_difference",), studies=40, trials=10, seed=1):
    return PowerQuestion(model, tests, trials, 37, studies, seed)


def tell_nobody(_done):
    pass


def shares(power):
    return [point.result.rejected.share for point in power.points]


def run(*arguments):
    return CliRunner(env={"COLUMNS": "200"}).invoke(alone, ["power", *arguments])


def test_the_two_way_test_of_correct_guesses_has_the_power_known_of_42_and_58_participants():
    """80 and 90 %, found by another simulation; within three Monte-Carlo errors of this one."""
    found = shares(power_at(question(studies=400), [42, 58], 1, tell_nobody))
    assert found == pytest.approx([0.8, 0.9], abs=0.06)


def test_the_two_way_test_of_confidence_has_the_power_known_of_392_participants():
    """80 %, found by another simulation; within three Monte-Carlo errors of this one."""
    asked = question(confidence_model(SPREAD), ("two_way_auc",), studies=150)
    assert shares(power_at(asked, [392], 1, tell_nobody)) == pytest.approx([0.8], abs=0.1)


def test_both_tests_of_correct_guesses_are_run_on_the_same_trials():
    tests = ("two_way_difference", "crossed_logistic")
    both = power_at(question(tests=tests, studies=4), [30], 1, tell_nobody)
    assert [point.result.test for point in both.points] == list(tests)
    by_itself = power_at(question(studies=4), [30], 1, tell_nobody)
    assert by_itself.points[0] == both.points[0]


def test_more_studies_add_to_the_same_ones():
    few, more = (
        power_at(question(studies=studies), [40], 1, tell_nobody).points[0].result.rejected.count
        for studies in (30, 50)
    )
    assert few <= more <= few + 20


def test_the_seed_and_not_the_number_of_workers_decides_the_numbers():
    one, two, other = (
        power_at(question(studies=45, seed=seed), [30], workers, tell_nobody).points
        for seed, workers in ((1, 1), (1, 2), (2, 1))
    )
    assert one == two
    assert one != other


def test_a_study_too_small_for_the_test_is_counted_as_undefined_and_finds_nothing():
    (point,) = power_at(question(studies=5), [2], 1, tell_nobody).points
    assert (point.result.rejected.count, point.result.undefined) == (0, 5)


def test_progress_is_told_study_by_study():
    told: list[int] = []
    power_at(question(studies=45), [20, 30], 1, told.append)
    assert sum(told) == 90


def test_a_curve_that_made_the_points_is_found_again():
    made = PowerCurve(floor=0.012, slope=4.7, scenarios=37)
    sizes = [20, 40, 60, 80]
    exact = [share(round(1e6 * power), 10**6) for power in made.at(np.array(sizes))]
    found = fit_power(sizes, exact, scenarios=37)
    assert (found.floor, found.slope) == pytest.approx((made.floor, made.slope), rel=1e-2)
    assert found.scenarios == made.scenarios


@pytest.mark.parametrize(("participants", "df"), [(20, 18), (38, 36), (80, 36)])
def test_the_curves_t_has_the_degrees_of_participants_where_they_are_fewer(participants, df):
    curve = PowerCurve(floor=0.0, slope=1.0, scenarios=37)
    power = stats.norm.cdf(participants**0.5 - stats.t.isf(0.025, df))
    assert curve.at(np.array([participants])) == pytest.approx(power)


@pytest.mark.parametrize("slope", [0.5, 5])
@pytest.mark.parametrize("power", [0.5, 0.8, 0.95])
def test_the_number_needed_is_the_smallest_even_one_with_the_power(power, slope):
    curve = PowerCurve(floor=0.01, slope=slope, scenarios=300)
    number = curve.needed(power)
    assert number
    assert number % 2 == 0
    assert curve.at(np.array([number - 2])) < power <= curve.at(np.array([number]))


def test_scenarios_too_few_for_a_power_are_not_made_up_for_by_participants():
    assert PowerCurve(floor=0.11, slope=5, scenarios=37).needed(0.9) is None


@pytest.mark.parametrize("count", [0, 40])
def test_a_curve_through_no_or_only_rejections_is_finite(count):
    curve = fit_power([20, 40], [share(count, 40)] * 2, scenarios=37)
    assert np.isfinite(curve.at(np.array([20.0, 40.0]))).all()


def test_the_search_ends_at_numbers_that_have_the_power():
    found = search_power(question(studies=200, trials=20), 1, tell_nobody)
    exact = {point.participants: point.result.rejected for point in found.points}
    eighty, ninety = (each.participants for each in found.needed)
    assert eighty
    assert ninety
    assert 20 <= eighty < ninety
    for needed, power in ((eighty, 0.8), (ninety, 0.9)):
        nearest = min(exact, key=lambda size: abs(size - needed))
        assert abs(nearest - needed) <= 0.03 * nearest
        assert exact[nearest].n == 200
        assert exact[nearest].share == pytest.approx(power, abs=0.1)


@pytest.mark.parametrize("treatment", [0.7, 0.8])
def test_a_search_does_not_go_beyond_the_largest_number_and_says_so(monkeypatch, treatment):
    monkeypatch.setattr("analysis.power.LARGEST", 40)
    weak = correct_model(SPREAD, treatment, 0.7)
    found = search_power(question(weak, studies=400), 1, tell_nobody)
    assert [each.participants for each in found.needed] == [None, None]
    assert [point.participants for point in found.points] == [20, 40]


def test_an_odd_number_of_participants_is_refused_before_anything_is_simulated():
    told: list[int] = []
    with pytest.raises(AnalysisError, match="expected an even number"):
        power_at(question(), [40, 41], 1, told.append)
    assert told == []


def test_the_figure_says_in_words_what_it_shows():
    power = power_at(question(studies=20), [20, 60], 1, tell_nobody)
    drawn = figure_power(power)
    first, last = (f"{100 * value:.1f} %" for value in shares(power))
    assert f"two-way difference from {first} with 20 to {last} with 60" in drawn.alt
    assert drawn.data["power"].to_list() == shares(power)


def test_the_command_prints_the_table_and_writes_what_it_rests_on(tmp_path):
    folder = tmp_path / "power"
    options = ["--participants", "20,40", "--simulations", "30", "--workers", "1", "--seed", "3"]
    result = run(*options, "--to", str(folder))
    assert result.exit_code == 0, result.stderr
    assert "two-way difference            40       30" in result.stdout
    assert "not testable" in result.stdout
    assert {path.name for path in folder.iterdir()} == {
        f"power.{suffix}" for suffix in ("json", "csv", "svg", "png")
    }
    content = json.loads((folder / "power.json").read_text())
    assert content["question"]["seed"] == 3
    assert content["alpha"] == 0.05
    for said in (content["uncorrected"], result.stdout):
        assert "Holm's method, which asks for p < .05/3" in " ".join(said.split())
    assert "p < .05 uncorrected" in result.stdout
    assert content["question"]["model"]["spread"] == {
        "participant": 0.8,
        "scenario": 0.8,
        "scenario_condition": 0.4,
    }
    table = pl.read_csv(folder / "power.csv").to_dicts()
    assert content["points"] == table
    assert [row["participants"] for row in table] == [20, 40]


def test_the_help_says_that_power_is_that_of_one_test_uncorrected():
    said = " ".join(run("--help").stdout.split())
    assert "each by itself at p < .05. The report corrects its" in said


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--measure", "speed"], "--measure: expected some of correct, confidence"),
        (["--measure", "confidence", "--tests", "mixed"], "--tests: expected some of two_way"),
        (["--tests", "two_way,two_way"], "got 'two_way,two_way'"),
        (["--sds", ".8/.8"], "--sds: expected participant/scenario/scenario x condition"),
        (["--participants", "many"], "--participants: expected whole numbers"),
        (["--participants", "41"], "participants: expected an even number from 2, got 41"),
        (["--p1", "1"], "share correct: expected .001 to .999, got 1"),
        (["--trials", "0"], "trials per participant: expected at least 1, got 0"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(options, message):
    result = run(*options)
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1
