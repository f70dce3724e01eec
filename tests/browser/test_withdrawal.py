"""Withdrawal in a browser: nothing of the person stays, here or on the server."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests import messages
from tests.browser import walk
from tests.browser.conftest import Row, Site, Visit

LINK = "/?PROLIFIC_PID={}&STUDY_ID=s1&SESSION_ID=t1"
PID = "5f1e0c2a9b3d4e6f7a8b9c0d"
NATIONALITY = "Unmistakably Atlantean"
USER_AGENT = "Unmistakable/1.0"
TABLES = ("trials", "events", "demographics", "recruits", "sessions")
TOMBSTONE = {
    *("id", "pseudonym", "stream", "step", "study_hash", "app_version", "control_tries"),
    "finished_at",
}


def take_part(page: Page) -> None:
    """Up to the first round, by the link and with answers that are typed."""
    page.goto(LINK.format(PID))
    page.get_by_role("button", name="I agree and take part").click()
    page.fill("[name=age]", "31")
    page.fill("[name=nationality]", NATIONALITY)
    for name in ("gender", "education", "occupation", "robot_familiarity"):
        page.check(f"[name={name}][value='prefer not to say']")
    page.get_by_role("button", name="Continue").click()
    page.get_by_role("button", name="Try it once").click()
    page.wait_for_url("**/practice")
    walk.post(page, "/practice", messages.control("know"))
    page.goto("/trial")
    walk.ready(page)


def play_into_a_round(page: Page) -> None:
    walk.play(page)


def reach_the_last_page(page: Page) -> None:
    walk.send_rounds(page, range(1, 11))
    page.goto("/end")


def rows_of(site: Site, participant: int) -> dict[str, list[Row]]:
    return {
        table: site.rows(f"select * from {table} where participant_id = {participant}")
        for table in TABLES
    }


def found_in_files(site: Site) -> set[str]:
    """What the bytes of the database's files tell of the person."""
    files = [file.read_bytes() for file in site.database.parent.glob(f"{site.database.name}*")]
    told = (PID, NATIONALITY, USER_AGENT)
    return {text for text in told if any(text.encode() in content for content in files)}


@pytest.mark.parametrize("get_there", [play_into_a_round, reach_the_last_page])
def test_whoever_withdraws_leaves_a_tombstone_and_nobody_else_is_touched(
    site: Site, visit: Visit, get_there: Callable[[Page], None]
):
    bystander = visit()
    walk.reach_practice(bystander, LINK.format("5f1e0c2a9b3d4e6f7a8b9c0e"))
    walk.post(bystander, "/practice", messages.control("know"))
    walk.send_rounds(bystander, range(1, 2))
    page = visit(user_agent=USER_AGENT)
    take_part(page)
    get_there(page)
    untouched = rows_of(site, 1)
    assert all(untouched.values())
    assert all(rows_of(site, 2).values())
    assert found_in_files(site) == {PID, NATIONALITY, USER_AGENT}

    page.get_by_role("link", name="Withdraw from the study").click()
    page.get_by_role("button", name="Withdraw and delete everything").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("You have withdrawn")

    assert not any(rows_of(site, 2).values())
    assert rows_of(site, 1) == untouched
    assert found_in_files(site) == set()
    (tombstone,) = site.rows("select * from participants where id = 2")
    assert tombstone["step"] == "withdrawn"
    assert {name for name, value in tombstone.items() if value is not None} == TOMBSTONE
    assert page.context.cookies() == []
    assert page.evaluate("[localStorage.length, sessionStorage.length]") == [0, 0]
