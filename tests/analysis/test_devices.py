"""The primary tests within each class of each trait of the devices."""

from dataclasses import replace

import pytest

from analysis import PARTICIPANTS, TRIALS, analyse_path, default_plan, read_dataset, write_table
from analysis.devices import TRAITS, UNKNOWN, by_device
from analysis.exclusions import Exclusion
from analysis.selections import Selector
from tests.analysis.rows import participants_of, six_participants, trial_row


@pytest.fixture
def groups_of(tmp_path):
    """Who is in which group of a trait, by the columns of participants or trials given."""

    def found(trait, people=(), rows=None, plan=None):
        rows = rows or six_participants()
        persons = participants_of(rows)
        for person, changes in zip(persons, people, strict=False):
            person |= changes
        write_table(TRIALS, rows, tmp_path)
        write_table(PARTICIPANTS, persons, tmp_path)
        data = read_dataset(tmp_path, plan)
        devices = by_device(data, Selector(data, {}))
        return {
            each.group: sum(each.selection.participants.values())
            for each in devices.groups
            if each.trait == trait
        }

    return found


def test_pointers_stand_as_the_export_calls_them_and_the_unknown_at_the_end(groups_of):
    pointers = ("touch", None, "mouse", "touch", "keyboard", None)
    people = [{"pointer_type": each} for each in pointers]
    found = groups_of("pointer", people)
    assert list(found.items()) == [("mouse", 1), ("touch", 2), ("keyboard", 1), (UNKNOWN, 2)]


@pytest.mark.parametrize(
    ("width", "group"),
    [
        (0, "below 600 px"),
        (599, "below 600 px"),
        (600, "600 to 1,023 px"),
        (1023, "600 to 1,023 px"),
        (1024, "1,024 px or more"),
        (None, UNKNOWN),
    ],
)
def test_a_page_is_as_wide_as_a_phone_below_600_px(groups_of, width, group):
    assert groups_of("width of the page", [{"viewport_width": width}] * 6) == {group: 6}


@pytest.mark.parametrize(
    ("rate", "group"),
    [
        (49.99, "below 50 Hz"),
        (50.0, "50 to below 70 Hz"),
        (69.99, "50 to below 70 Hz"),
        (70.0, "70 Hz or more"),
        (None, UNKNOWN),
    ],
)
def test_refresh_rates_are_parted_below_and_above_60_hz(groups_of, rate, group):
    assert groups_of("refresh rate", [{"refresh_rate_hz": rate}] * 6) == {group: 6}


@pytest.mark.parametrize(
    ("reduced", "group"),
    [((True,) * 3, "on"), ((False,) * 3, "off"), ((True, False, False), "changed")],
)
def test_reduced_motion_is_on_or_off_in_all_trials_or_changed(groups_of, reduced, group):
    rows = [row | {"reduced_motion": reduced[row["trial_index"] - 1]} for row in six_participants()]
    assert groups_of("reduced motion", rows=rows) == {group: 6}


@pytest.mark.parametrize(
    ("dropped", "group"),
    [(0, "none"), (1, "up to 1 a second"), (4, "up to 1 a second"), (5, "more than 1 a second")],
)
def test_dropped_frames_count_by_the_second_of_motion_seen(groups_of, dropped, group):
    rows = [
        trial_row(participant, index, condition, stop_time_s=4.0, frames_dropped=frames)
        for participant, condition in (("P1", "polmdp"), ("P2", "optimal"))
        for index, frames in ((1, 0), (2, 2 * dropped))
    ]
    assert groups_of("frames dropped", rows=rows) == {group: 2}


def test_whom_the_plan_excludes_is_in_no_group(groups_of):
    rule = Exclusion("failed_control_question", {"tries_above": 1})
    plan = replace(default_plan(), exclusions=(rule,))
    assert groups_of("pointer", [{"control_tries": 2}], plan=plan) == {"mouse": 5}


def test_the_groups_of_each_trait_hold_everybody_once(export):
    devices = analyse_path(export).evidence.devices
    assert devices is not None
    for trait in TRAITS:
        own = [each.selection for each in devices.groups if each.trait == trait]
        assert sum(sum(each.participants.values()) for each in own) == 6
        assert sum(each.trials for each in own) == 18


def test_a_group_of_everybody_has_the_results_of_the_study(export):
    evidence = analyse_path(export).evidence
    assert evidence.devices is not None
    (mouse,) = (each for each in evidence.devices.groups if each.group == "mouse")
    assert mouse.selection.tests == {each.measure: each.primary for each in evidence.conclusions}


def test_what_the_tables_do_not_tell_is_left_out_with_its_reason(paper):
    assert paper.evidence.devices.groups == ()
    assert paper.evidence.devices.left_out == {
        "pointer": "there is no table participants",
        "width of the page": "there is no table participants",
        "reduced motion": "there is no column reduced_motion in the table trials",
        "refresh rate": "there is no table participants",
        "frames dropped": "there is no column frames_dropped in the table trials",
    }
