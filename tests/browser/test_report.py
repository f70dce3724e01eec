"""The report's page before axe and on a phone, opened from its file."""

from pathlib import Path
from typing import Any

import pytest
from axe_playwright_python.sync_playwright import Axe  # type: ignore[import-untyped]
from playwright.sync_api import Browser

from analysis import analyse_path, write_report
from tests.analysis.rows import HERE
from tests.browser.conftest import DESKTOP, PHONE
from tests.browser.test_accessibility import LEVELS

LOOKED_AT = {"color-contrast", "document-title", "html-has-lang", "region", "svg-img-alt"}


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report on the synthetic trials, with all figures."""
    folder = tmp_path_factory.mktemp("report")
    write_report(analyse_path(HERE / "paper_fixture.csv"), folder, lambda _what: None)
    return folder / "report.html"


@pytest.mark.parametrize("viewport", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_axe_finds_nothing_and_nothing_is_wider_than_the_screen(
    report: Path, browser: Browser, viewport: Any
):
    page = browser.new_page(viewport=viewport)
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(report.as_uri())
    found = Axe().run(page, options={"runOnly": LEVELS, "resultTypes": ["violations"]})
    assert found.violations_count == 0, found.generate_report()
    assert {rule["id"] for rule in found.response["passes"]} >= LOOKED_AT
    assert page.evaluate("document.documentElement.scrollWidth") == viewport["width"]
    assert asked == [report.as_uri()]
    page.close()
