"""The whole study in a browser, under a path of a host that it shares with another site."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import expect

from app.settings import Settings
from tests.browser import walk
from tests.browser.conftest import STEP_MS, Site, Visit
from tests.browser.serving import Server
from tests.browser.test_whole_study import say_who_they_are
from tests.prefix_proxy import PrefixProxy

PREFIX = "/lab/study"


@pytest.fixture(params=[True, False], ids=["stripped", "kept"])
def site(settings: Settings, request: pytest.FixtureRequest) -> Iterator[Site]:
    under_prefix = settings.model_copy(update={"root_path": PREFIX})
    server = Server(under_prefix, lambda study: PrefixProxy(study, PREFIX, request.param))
    server.start()
    yield Site(server, settings.database_file)
    server.stop()


def test_everything_works_behind_a_proxy_that_shows_the_study_under_a_path(
    site: Site, visit: Visit
):
    page = visit()
    page.goto(f"{PREFIX}?PROLIFIC_PID=5f1e0c2a9b3d4e6f7a8b9c0d")
    page.get_by_role("button", name="I agree and take part").click()
    say_who_they_are(page)
    page.get_by_role("button", name="Try it once").click()
    walk.practise(page)
    walk.answer_control(page, "know")
    for index in range(1, 11):
        walk.round_is(page, index)
        page.click("#play")
        walk.moved(page, STEP_MS)
        walk.stop(page)
        if index == 2:
            page.reload()
            walk.phase(page, "stopped")
        walk.answer(page, "A", 4)
    page.wait_for_url(f"**{PREFIX}/end")
    expect(page.locator(".code")).to_have_text("DONE1")
    assert len(site.trials()) == 10
    page.get_by_role("link", name="Withdraw from the study").click()
    page.get_by_role("button", name="Withdraw and delete everything").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("You have withdrawn")
    assert site.trials() == []
