"""The report for programs: everything at full precision, nothing that JSON does not know."""

import hashlib
import json
import math
import random
from dataclasses import replace

import pytest

from analysis import analyse_path, read_plan
from analysis.reporting.as_json import as_json
from tests.analysis.rows import as_csv, six_participants


@pytest.fixture(scope="module")
def report(paper):
    """What report.json holds of the synthetic trials, read back."""
    return json.loads(json.dumps(as_json(paper), allow_nan=False))


def test_it_is_keyed_by_measure_and_method(report):
    assert report["schema_version"] == 3
    assert list(report["measures"]) == ["correct", "prediction_time_s", "confidence"]
    assert {"two_way_difference", "crossed_logistic", "gee_logistic", "chi_square"} <= set(
        report["measures"]["correct"]["methods"]
    )
    assert {"two_way_auc", "crossed_ordinal", "hodges_lehmann", "mann_whitney"} <= set(
        report["measures"]["confidence"]["methods"]
    )


@pytest.mark.parametrize(
    ("case_id", "measure", "method", "fields"),
    [
        ("twoway_auc_time", "prediction_time_s", "two_way_auc", {"estimate": "auc", "se": "se"}),
        ("cluster_auc_time", "prediction_time_s", "clustered_auc", {"estimate": "auc", "p": "p"}),
        ("cluster_rd_fixture", "correct", "clustered_difference", {"estimate": "rd", "se": "se"}),
        ("glmm_crossed_x_fixture", "correct", "crossed_logistic", {"estimate": "b1"}),
        ("gee_fixture", "correct", "gee_logistic", {"estimate": "b1", "se": "se_b1"}),
        ("perm_exact_confidence", "confidence", "cluster_permutation", {"p": "p"}),
        ("paper_98x52", "correct", "chi_square", {"statistic": "chi2", "p": "p"}),
        (
            "paper_time_fixture",
            "prediction_time_s",
            "hodges_lehmann",
            {"estimate": "hodges_lehmann"},
        ),
    ],
)
def test_golden_numbers_stand_under_their_measure_and_method(
    report, golden, case_id, measure, method, fields
):
    """Each case's source: R or an independent implementation, named in golden.json."""
    case = golden(case_id)
    found = report["measures"][measure]["methods"][method]
    for ours, theirs in fields.items():
        assert found[ours] == pytest.approx(case["expected"][theirs], rel=0, abs=case["tol"])


def test_every_estimate_has_unit_n_used_n_missing_source_and_warnings(report):
    for measure in report["measures"].values():
        assert measure["methods"]
        for result in measure["methods"].values():
            assert {"estimate", "low", "high", "unit", "n", "n_missing"} <= result.keys()
            assert {"p", "method", "source", "warnings"} <= result.keys()


def test_the_conclusions_name_the_plans_tests_and_their_corrected_p(report):
    tests = [each["test"] for each in report["conclusions"]]
    assert tests == ["two_way_difference", "two_way_auc", "two_way_auc"]
    assert [each["supported"] for each in report["conclusions"]] == [True, True, False]
    p = sorted(each["p"] for each in report["conclusions"])
    corrected = sorted(each["p_holm"] for each in report["conclusions"])
    assert corrected == pytest.approx([3 * p[0], 2 * p[1], p[2]])


def test_the_conclusions_have_the_models_p_in_the_family_and_what_it_shows(report):
    """Of confidence, whose p is the largest of the family, Holm leaves p as it is."""
    correct, time, confidence = report["conclusions"]
    assert (correct["model_direction"], correct["model_agrees"]) == ("more", True)
    assert (time["model_p_holm"], time["model_agrees"]) == (None, None)
    ordinal = report["measures"]["confidence"]["methods"]["crossed_ordinal"]
    assert confidence["model_p_holm"] == ordinal["p"]
    assert (confidence["model_direction"], confidence["model_agrees"]) == ("none", True)


def test_the_papers_block_keeps_its_numbers(report):
    block = report["as_in_paper"]
    assert block["trials_treated_as_independent"] is True
    assert f"{block['correct']['test']['statistic']:.3f}" == "48.864"
    assert block["prediction_time"]["arms"]["polmdp"]["mean"] == pytest.approx(15.6701020408)
    assert block["confidence"]["test"]["u_treatment"] == 278397


def test_the_order_of_rows_changes_nothing_but_the_hash_and_what_is_known_by_it(
    report, paper_fixture, tmp_path
):
    head, *rows = paper_fixture.read_text().splitlines()
    random.Random(2).shuffle(rows)
    shuffled = tmp_path / paper_fixture.name
    shuffled.write_text("\n".join([head, *rows]) + "\n")
    found = json.loads(json.dumps(as_json(analyse_path(shuffled))))
    expected = report | {"inputs": found["inputs"], "warnings": report["warnings"][1:]}
    assert report["warnings"][0]["code"] == "synthetic_data"
    assert found["inputs"] != report["inputs"]
    assert found == expected


def test_it_names_its_input_its_plan_its_seed_and_its_software(report, paper_fixture, paper):
    digest = hashlib.sha256(paper_fixture.read_bytes()).hexdigest()
    assert report["inputs"] == [{"file": "paper_fixture.csv", "sha256": digest, "rows": 1500}]
    assert report["plan"]["sha256"] == paper.data.plan.sha256
    assert report["seed"] == report["plan"]["seed"] == 2209
    software = {"python", "goalguess", "scipy", "statsmodels", "polars", "numpy", "matplotlib"}
    assert software <= report["packages"].keys()


def numbers(value):
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for each in value:
            yield from numbers(each)
    elif isinstance(value, float):
        yield value


def test_a_study_of_next_to_nothing_is_told_without_nan_or_infinity(tmp_path):
    rows = [
        {name: row[name] for name in ("participant", "condition", "scenario", "trial_index")}
        | {name: row[name] for name in ("correct", "stop_time_s", "length_s", "confidence")}
        for row in six_participants()
    ]
    rows[0]["confidence"] = None
    rows[1]["correct"] = None
    results = analyse_path(as_csv(tmp_path / "t.csv", rows))
    report = as_json(results)
    assert all(map(math.isfinite, numbers(report)))
    texts = [notice.text for notice in results.notices if notice.code == "missing_values"]
    assert len(texts) == 3
    assert report["as_in_paper"]["confidence"]["arms"]["polmdp"]["n_missing"] == 1
    assert report["as_in_paper"]["correct"]["test"]["n"] == 17
    assert report["measures"]["confidence"]["methods"]["two_way_auc"]["n_missing"] == 1


def test_what_is_not_finite_is_null(paper):
    cox = replace(paper.evidence.cox, estimate=math.inf, low=math.nan)
    report = as_json(replace(paper, evidence=replace(paper.evidence, cox=cox)))
    assert report["time_to_correct_stop"]["cox"]["estimate"] is None
    assert report["time_to_correct_stop"]["cox"]["low"] is None
    assert report["time_to_correct_stop"]["two_way_cox"]["df"] == 36


def test_the_plans_definition_of_time_and_its_arms_are_followed(paper_fixture, tmp_path):
    plan = tmp_path / "mine.toml"
    plan.write_text(
        'time = "stop"\n[treatment]\ncondition = "optimal"\n[reference]\ncondition = "polmdp"\n'
    )
    report = as_json(analyse_path(paper_fixture, read_plan(plan)))
    assert list(report["measures"]) == ["correct", "stop_time_s", "confidence"]
    difference = report["measures"]["correct"]["methods"]["two_way_difference"]["estimate"]
    assert difference == pytest.approx(-0.152825745683)
    assert report["plan"]["file"] == "mine.toml"
