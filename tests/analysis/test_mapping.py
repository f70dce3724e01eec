"""Tables from elsewhere: other names, conditions, units and scales, told by a mapping."""

import pytest

from analysis import (
    EmptyArmError,
    TableError,
    TableMapping,
    TomlError,
    analyse_path,
    outcome,
    read_dataset,
    read_mapping,
)
from analysis.reporting.as_json import as_json
from analysis.reporting.markdown import markdown
from analysis.reporting.report import report_parts
from tests.analysis.rows import as_csv, edited, six_participants

MAPPING = """
[columns]
participant = "subject"
condition = "group"
scenario = "clip"
stop_time_s = "rt"

[conditions]
"1" = "polmdp"
"2" = "optimal"

[units]
stop_time_s = "ms"

[confidence]
low = 0
high = 100
"""


def foreign_rows():
    """The six participants as another lab may write them."""
    return [
        {
            "subject": row["participant"],
            "group": 1 if row["condition"] == "polmdp" else 2,
            "clip": row["scenario"],
            "trial": row["trial_index"],
            "rt": 1000 * row["stop_time_s"],
            "length_s": row["length_s"],
            "correct": row["correct"],
            "confidence": 14 * row["confidence"],
            "condition": "daylight",
            "video": "high definition",
        }
        for row in six_participants()
    ]


@pytest.fixture
def table(tmp_path):
    return as_csv(tmp_path / "theirs.csv", foreign_rows())


@pytest.fixture
def mapping_of(tmp_path):
    """Read a mapping from its text."""

    def read(text):
        path = tmp_path / "names.toml"
        path.write_text(text)
        return read_mapping(path)

    return read


def test_a_mapped_table_gives_the_same_outcomes_as_the_export(table, export, mapping_of):
    theirs = read_dataset(table, mapping=mapping_of(MAPPING))
    ours = read_dataset(export / "trials.csv")
    for measure in ("correct", "prediction_time_s", "stop_time_s"):
        one, other = outcome(theirs, measure), outcome(ours, measure)
        assert one.y.tolist() == pytest.approx(other.y.tolist())
        assert one.treated.tolist() == other.treated.tolist()
        assert one.participant.tolist() == other.participant.tolist()
        assert one.scenario.tolist() == other.scenario.tolist()
    assert theirs.trials["confidence"].to_list() == [
        14 * rating for rating in ours.trials["confidence"]
    ]
    assert theirs.confidence_scale == (0, 100)


def test_mapped_and_understood_names_are_told(table, mapping_of):
    renamed = dict(read_dataset(table, mapping=mapping_of(MAPPING)).renamed)
    assert renamed == {
        "subject": "participant",
        "group": "condition",
        "clip": "scenario",
        "rt": "stop_time_s",
        "trial": "trial_index",
    }


def test_the_report_tells_the_mapping_with_its_hash_and_all_that_it_changed(table, mapping_of):
    mapping = mapping_of(MAPPING)
    results = analyse_path(table, mapping=mapping)
    made_from = markdown(report_parts(results)).partition("### Made from")[2]
    for said in (
        f"names.toml, SHA-256 of what it says: {mapping.sha256}",
        "subject as participant",
        "group as condition",
        "rt as stop_time_s",
        "Conditions: 1 as polmdp, 2 as optimal",
        "Units: stop_time_s in ms, all turned into s",
        "Confidence: from 0 to 100",
    ):
        assert said in made_from
    told = as_json(results)["mapping"]
    assert (told["file"], told["sha256"]) == ("names.toml", mapping.sha256)
    assert told["columns"] == dict(mapping.columns)
    assert told["conditions"] == {"1": "polmdp", "2": "optimal"}
    assert told["units"] == {"stop_time_s": "ms"}
    assert told["confidence"] == {"low": 0, "high": 100}


def test_a_report_without_a_mapping_says_that_there_was_none(export):
    results = analyse_path(export)
    made_from = markdown(report_parts(results)).partition("### Made from")[2]
    assert "- No mapping\n- Confidence: from 1 to 7\n" in made_from
    assert as_json(results)["mapping"]["file"] == "no mapping"


def test_two_mappings_have_one_hash_if_and_only_if_they_say_the_same(mapping_of):
    first = mapping_of(MAPPING)
    _, columns, conditions, units, confidence = MAPPING.split("\n[")
    reordered = [units, confidence, conditions, columns]
    assert mapping_of("".join(f"\n[{each}" for each in reordered)).sha256 == first.sha256
    assert mapping_of(MAPPING.replace('"ms"', '"s"')).sha256 != first.sha256
    assert mapping_of(MAPPING.replace("high = 100", "high = 99")).sha256 != first.sha256


@pytest.mark.parametrize(
    ("column", "text", "words"),
    [
        ("confidence", "101", "expected whole number from 0 to 100, got 101"),
        ("rt", "21000", "a stop no later than length_s, got stop_time_s 21.0, length_s 20.0"),
        ("group", "2", "one condition per participant, got participant 'P1', condition 'optimal'"),
    ],
)
def test_a_broken_rule_is_named_by_the_files_own_column(table, mapping_of, column, text, words):
    edited(table, 3, column, text)
    with pytest.raises(TableError) as caught:
        read_dataset(table, mapping=mapping_of(MAPPING))
    assert (caught.value.row, caught.value.column) == (3, column)
    assert words in str(caught.value)


def test_unless_it_is_said_confidence_goes_from_1_to_7(table, mapping_of):
    with pytest.raises(TableError, match="from 1 to 7, got 84"):
        read_dataset(table, mapping=mapping_of(MAPPING.partition("[confidence]")[0]))


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        ("[column]", "column", "expected one of the keys columns, conditions, units, confidence"),
        ('[columns]\nmood = "m"', "columns.mood", "expected one of the keys participant, "),
        ("[columns]\nscenario = 3", "columns.scenario", "expected a text, got 3"),
        ("[conditions]\nx = 1", "conditions.x", "expected a text, got 1"),
        ('[units]\nconfidence = "ms"', "units.confidence", "expected one of the keys stop_time_s"),
        ('[units]\nstop_time_s = "min"', "units.stop_time_s", "expected s or ms, got 'min'"),
        ("[confidence]\nlow = 1", "confidence.high", "expected a number, got nothing"),
        ("[confidence]\nlow = 7\nhigh = 1", "confidence.high", "above low = 7, got 1"),
    ],
)
def test_what_a_mapping_cannot_say_is_named_by_file_and_key(mapping_of, text, key, words):
    with pytest.raises(TomlError) as caught:
        mapping_of(text)
    assert (caught.value.file, caught.value.key) == ("names.toml", key)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        ('"rt"', '"reaction"', "columns.stop_time_s", "expected a file with column reaction, got"),
        ('"2" =', '"two" =', "conditions.two", "expected one of the conditions 1, 2, got 'two'"),
    ],
)
def test_what_is_not_in_the_table_is_named_by_file_and_key(table, mapping_of, old, new, key, words):
    mapping = mapping_of(MAPPING.replace(old, new))
    with pytest.raises(TomlError) as caught:
        read_dataset(table, mapping=mapping)
    assert (caught.value.file, caught.value.key) == ("names.toml", key)
    assert words in str(caught.value)


def test_of_three_conditions_the_plan_names_the_two_compared(tmp_path, plan_of):
    rows = [
        row | {"scenario": row["clip"], "participant": row["subject"], "stop_time_s": 5}
        for row in foreign_rows()
    ]
    for row in rows:
        del row["video"]
        row["condition"] = {"P1": "red", "P2": "red", "P3": "blue"}.get(row["subject"], "green")
    path = as_csv(tmp_path / "three.csv", rows)
    plan = plan_of('treatment.condition = "green"\nreference.condition = "red"')
    data = read_dataset(path, plan, TableMapping(confidence=(0, 100)))
    assert data.other_conditions == {"blue": 3}
    assert data.arms.names == ("green", "red")
    assert data.trials.group_by("condition", "treated").len().sort("condition").rows() == [
        ("green", True, 9),
        ("red", False, 6),
    ]
    before, answered, analysed = data.flow.steps
    assert (before.reached.total, before.left[0].what, before.left[0].total) == (
        6,
        "condition blue",
        1,
    )
    assert answered.reached.arms == analysed.reached.arms == {"green": 3, "red": 2}


def test_conditions_that_no_plan_names_are_told(table, mapping_of):
    without = MAPPING.replace('"1" = "polmdp"\n"2" = "optimal"', "")
    with pytest.raises(
        EmptyArmError, match=r"condition polmdp: .* got none; default plan compares none of: 1, 2"
    ):
        read_dataset(table, mapping=mapping_of(without))


def test_an_export_of_our_own_is_held_to_its_conditions_whatever_the_plan(export, plan_of):
    edited(export / "trials.csv", 2, "condition", "legible")
    plan = plan_of('treatment.condition = "legible"\nreference.condition = "optimal"')
    with pytest.raises(TableError, match="expected polmdp or optimal, got 'legible'"):
        read_dataset(export / "trials.csv", plan)
