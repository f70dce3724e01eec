"""Every page of the study in every state that looks different, one after the other."""

from collections.abc import Iterator

from playwright.sync_api import Page

from tests import messages
from tests.browser import walk

EXPECTED = ("404", "409", "422")
"""What browsers complain about on the way: the error page, the moved page, the form sent empty."""
LINK = "/?PROLIFIC_PID={}&STUDY_ID=s1&SESSION_ID=t1"


def tour(page: Page) -> Iterator[str]:
    """Stops at each page and state, named; the page is there to be looked at meanwhile."""
    page.goto("/no-consent")
    yield "no consent"
    page.goto("/nowhere")
    yield "error"
    page.goto("/?PROLIFIC_PID=null")
    yield "link not filled in"
    page.goto("/no-consent?preview=1")
    yield "no consent, as a preview"
    page.goto("/?preview=1")
    yield "consent, as a preview"
    page.goto(LINK.format("5f1e0c2a9b3d4e6f7a8b9c01"))
    yield "consent"
    page.click("button[value=yes]")
    page.wait_for_url("**/about-you")
    yield "about you"
    page.get_by_role("button", name="Continue").click()
    page.get_by_role("alert").wait_for()
    yield "about you, with errors"
    page.evaluate("document.querySelector('[name=participant]').value = 'another'")
    page.get_by_role("button", name="Continue").click()
    page.get_by_role("heading", name="Somebody else").wait_for()
    yield "somebody else's turn"
    yield from _practice_and_rounds(page)
    yield from _endings(page)


def _practice_and_rounds(page: Page) -> Iterator[str]:
    walk.post(page, "/about-you", messages.ABOUT_ME)
    page.goto("/instructions")
    yield "instructions"
    page.get_by_role("button", name="Try it once").click()
    walk.ready(page)
    yield "practice"
    page.click("#play")
    walk.phase(page, "moving")
    walk.stop(page)
    yield "practice, asking"
    walk.answer(page, "A", 3)
    page.locator("#control").wait_for()
    yield "control question"
    walk.post(page, "/practice", messages.control("end"))
    page.goto("/practice")
    yield "control question, second try"
    walk.post(page, "/practice", messages.control("know", 2))
    page.goto("/trial")
    walk.ready(page)
    yield "round, ready"
    page.click("#play")
    yield "round, lead-in"
    walk.moved(page, 1)
    yield "round, moving"
    page.reload()
    walk.phase(page, "paused")
    yield "round, paused"
    second = page.context.new_page()
    second.goto("/trial")
    second.locator("#other-tab").wait_for()
    second.close()
    page.click("#play")
    walk.phase(page, "moving")
    walk.stop(page)
    yield "round, asking"
    page.locator("input[name=guess][value=C]").check()
    page.click("#next")
    page.locator("input[name=confidence][value='6']").check()
    yield "round, answered"
    page.evaluate("document.getElementById('rounds').hidden = true")
    for notice in ("other-tab", "other-person", "trouble"):
        page.evaluate("id => (document.getElementById(id).hidden = false)", notice)
        yield f"round, {notice}"
        page.evaluate("id => (document.getElementById(id).hidden = true)", notice)


def _endings(page: Page) -> Iterator[str]:
    page.goto("/withdraw")
    yield "withdraw"
    trial = walk.trial(page)
    body = messages.answered("C", trial["stop_time_ms"])
    walk.send(page, "/api/trials/1/answered", body)
    walk.send_rounds(page, range(2, 11))
    page.goto("/end")
    yield "completed"
    walk.post(page, "/withdraw", {})
    page.goto("/withdrawn")
    yield "withdrawn"
    page.context.clear_cookies()
    walk.reach_practice(page, LINK.format("5f1e0c2a9b3d4e6f7a8b9c02"))
    for attempt in (1, 2):
        walk.post(page, "/practice", messages.control("end", attempt))
    page.goto("/end")
    yield "screened out"
    page.context.clear_cookies()
    link = LINK.format("5f1e0c2a9b3d4e6f7a8b9c03")
    walk.reach_practice(page, link)
    session = page.context.cookies()
    page.context.clear_cookies()
    page.goto(link)  # the link in what looks like another browser
    yield "go on here"
    page.get_by_role("button", name="Go on here").click()
    page.wait_for_url("**/practice")
    page.context.clear_cookies()
    page.context.add_cookies(session)  # type: ignore[arg-type]
    page.goto("/practice")
    yield "moved"
    page.context.clear_cookies()
    walk.reach_practice(page, LINK.format("5f1e0c2a9b3d4e6f7a8b9c04"))
    walk.post(page, "/failed", {})
    page.goto("/end")
    yield "failed"
