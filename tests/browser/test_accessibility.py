"""Every page and state before axe, which knows as much of WCAG 2.2 as a program can judge."""

from typing import Any

import pytest
from axe_playwright_python.sync_playwright import Axe  # type: ignore[import-untyped]
from playwright.sync_api import Page

from app.settings import Settings
from tests.browser.conftest import DESKTOP, PHONE, Guard, Visit
from tests.browser.tour import EXPECTED, tour

LEVELS = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22a", "wcag22aa", "best-practice")
OPTIONS = {"runOnly": LEVELS, "resultTypes": ["violations", "incomplete"]}
LOOKS: Any = ((DESKTOP, "light"), (PHONE, "dark"))
ON_EVERY_PAGE = {"color-contrast", "document-title", "html-has-lang", "region", "target-size"}

# Which elements axe cannot judge, as a rule's name and an element's classes.
UNDECIDED = """undecided => undecided.flatMap(({ id, nodes }) =>
    nodes.map(({ target }) => `${id}: ${document.querySelector(target).getAttribute("class")}`))"""


@pytest.fixture
def settings(settings: Settings) -> Settings:
    """A robot slow enough to be still in motion when axe is done."""
    return settings.model_copy(update={"step_ms": 400, "lead_in_ms": 600})


def test_axe_finds_nothing_to_mend_in_light_and_dark(visit: Visit, guard: Guard):
    guard.expected = EXPECTED
    page = visit(reduced_motion="reduce")
    for stop in tour(page):
        for viewport, scheme in LOOKS:
            page.set_viewport_size(viewport)
            page.emulate_media(color_scheme=scheme)
            assert page.evaluate("document.getAnimations().length") == 0  # no colour on its way
            assert_accessible(page, f"{stop}, {scheme}")


def assert_accessible(page: Page, stop: str) -> None:
    found = Axe().run(page, options=OPTIONS)
    assert found.violations_count == 0, f"{stop}: {found.generate_report()}"
    passed = {rule["id"] for rule in found.response["passes"]}
    assert passed >= ON_EVERY_PAGE, f"{stop}: axe has not looked at everything"
    # Letters on their plates: how they stand out is measured in test_areas.py.
    undecided = page.evaluate(UNDECIDED, found.response["incomplete"])
    assert set(undecided) <= {"color-contrast: tile-letter"}, stop
