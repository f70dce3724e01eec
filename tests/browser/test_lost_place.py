"""A place given back and dealt again: two browsers, one of which hesitates at the first round."""

import json

import pytest
from playwright.sync_api import Page, expect

from app.settings import Settings
from policies import load_pool
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


def play_a_round(page: Page, letter: str) -> None:
    walk.play(page)
    walk.stop(page)
    walk.answer(page, letter, 5)
    walk.round_is(page, 2)


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
    play_a_round(quick, "C")

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
    play_a_round(slow, "B")
    expect(saving).to_be_empty()
    walk.reach_trials(visit())

    assert places(site)[:2] == dealt == [dealt[0], taken]
    trials = site.trials()
    assert [(row["participant_id"], row["guess"]) for row in trials] == [(1, "B"), (2, "C")]
    pool = load_pool()
    for trial, place in zip(trials, dealt, strict=True):
        first = json.loads(place["scenarios"])[0]
        assert trial["stimulus"] == pool.stimulus(first, place["condition"]).id
