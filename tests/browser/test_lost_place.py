"""A place given back and dealt again: two browsers, one of which hesitates at the first round."""

import json

import pytest
from playwright.sync_api import expect

from app.settings import Settings
from policies import load_pool
from tests import messages
from tests.browser import walk
from tests.browser.conftest import Guard, Row, Site, Visit

AT_ONCE = 1e-5  # minutes


@pytest.fixture
def settings(settings: Settings) -> Settings:
    """Whoever comes is dealt the place of whoever has not played yet."""
    return settings.model_copy(update={"place_minutes": AT_ONCE})


def places(site: Site) -> list[Row]:
    """The places that somebody has, in the order of who came first."""
    return site.rows(
        "select participant_id, number, condition, scenarios from places"
        " where participant_id is not null order by participant_id"
    )


def test_whoever_lost_their_place_is_told_so_kindly_and_dealt_another_one(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("409",)
    slow, quick = visit(), visit()
    walk.reach_trials(slow)
    (lost,) = places(site)
    walk.reach_trials(quick)
    (taken,) = places(site)
    assert taken == {**lost, "participant_id": 2}
    walk.play(quick)

    with slow.expect_navigation(url="**/trial"):
        slow.click("#play")
    walk.ready(slow)
    saving = slow.locator("#saving")
    expect(saving).to_have_text(
        "The first maze had waited too long, so here is another one. Nothing is lost."
    )
    expect(slow.locator("#round-index")).to_have_text("1")
    dealt = places(site)
    assert dealt[0]["number"] != lost["number"]
    walk.play(slow)
    walk.stop(slow)
    walk.answer(slow, "B", 5)
    walk.round_is(slow, 2)
    expect(saving).to_be_empty()
    third = visit()
    walk.reach_practice(third)
    walk.post(third, "/practice", messages.control("know"))

    assert dealt[1] == taken
    assert places(site)[:2] == dealt
    assert len(places(site)) == 3
    trials = site.trials()
    assert [(row["participant_id"], row["guess"]) for row in trials] == [(1, "B"), (2, None)]
    pool = load_pool()
    for trial, place in zip(trials, dealt, strict=True):
        first = json.loads(place["scenarios"])[0]
        assert trial["stimulus"] == pool.stimulus(first, place["condition"]).id
