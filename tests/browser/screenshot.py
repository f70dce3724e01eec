"""Takes README's picture: `python -m tests.browser.screenshot` writes static/trial.png."""

import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from app.settings import Settings
from tests.browser import chromium, walk
from tests.browser.serving import served

TARGET = Path(__file__).parents[2] / "static" / "trial.png"
STEP_MS = 1000


def main() -> None:
    """Play into the first trial and take its picture in motion."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        settings = Settings(
            database_url=f"sqlite:///{folder}/study.sqlite", seed=1, step_ms=STEP_MS, lead_in_ms=100
        )
        with served(settings) as url:
            browser = playwright.chromium.launch(
                executable_path=chromium.find(), args=list(chromium.FLAGS)
            )
            page = browser.new_page(base_url=url, viewport={"width": 1280, "height": 800})
            walk.reach_trials(page)
            walk.play(page, round(2.5 * STEP_MS))
            page.mouse.move(0, 0)
            page.screenshot(path=TARGET)
            browser.close()
    print(f"{TARGET.name}: {TARGET.stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()
