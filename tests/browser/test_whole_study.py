"""The whole study as a participant goes through it, checked against what is stored at the end."""

from playwright.sync_api import Page, expect

from tests.browser import walk
from tests.browser.conftest import DESKTOP, LEAD_IN_MS, PHONE, STEP_MS, Guard, Site, Visit
from tests.browser.focus import tab_to

LETTERS = "ABCDEFABCD"
DEGREES = (1, 2, 3, 4, 5, 6, 7, 1, 4, 7)


def assert_stored(site: Site) -> None:
    """Ten rows, each with the answer that was given, and a participant who has finished."""
    (participant,) = site.rows("select * from participants")
    assert participant["step"] == "completed"
    assert participant["finished_at"] is not None
    trials = site.trials()
    assert [row["trial_index"] for row in trials] == list(range(1, 11))
    assert "".join(row["guess"] for row in trials) == LETTERS
    assert tuple(row["confidence"] for row in trials) == DEGREES
    for row in trials:
        assert (row["step_ms"], row["lead_in_ms"]) == (STEP_MS, LEAD_IN_MS)
        assert 0 < row["stop_time_ms"] <= row["length_ms"]
        assert 0 < row["guess_latency_ms"] <= row["confidence_latency_ms"]
        assert row["reached_end"] == (row["stop_time_ms"] == row["length_ms"])
    for kind in ("played", "stopped", "answered"):
        assert [event["trial_index"] for event in site.events(kind)] == list(range(1, 11)), kind


def test_by_mouse_with_double_clicks_reloads_and_the_back_button(
    site: Site, visit: Visit, guard: Guard
):
    guard.expected = ("422",)  # the form that is sent empty at first
    page = visit(viewport=DESKTOP)
    page.goto("/?PROLIFIC_PID=5f1e0c2a9b3d4e6f7a8b9c0d&STUDY_ID=s1&SESSION_ID=t1")
    page.get_by_role("button", name="I agree and take part").click()
    page.get_by_role("button", name="Continue").click()
    expect(page.get_by_role("alert")).to_contain_text("6 answers")
    say_who_they_are(page)
    page.get_by_role("button", name="Try it once").click()

    walk.practise(page)
    walk.answer_control(page, "end")
    expect(page.get_by_role("heading", level=1)).to_have_text("Not quite")
    walk.answer_control(page, "know")

    for index, (letter, degree) in enumerate(zip(LETTERS, DEGREES, strict=True), 1):
        walk.round_is(page, index)
        if index == 2:
            page.dblclick("#play")
            walk.moved(page, STEP_MS)
            page.reload()
            walk.phase(page, "paused")
            page.click("#play")
        elif index == 5:
            page.click("#play")
            walk.phase(page, "stopped")  # nobody presses: the robot walks all the way
        else:
            page.dblclick("#play")
        if index != 5:
            walk.moved(page, 2 * STEP_MS)
            walk.stop(page)
        if index == 3:
            page.reload()
            walk.phase(page, "stopped")
        if index == 4:
            page.go_back()
            page.wait_for_url("**/trial")
            walk.phase(page, "stopped")
        page.locator(f"input[name=guess][value={letter}]").check()
        page.locator(f"input[name=confidence][value='{degree}']").check()
        page.dblclick("#next")

    page.wait_for_url("**/end")
    expect(page.locator(".code")).to_have_text("DONE1")
    expect(page.locator(".rounds li")).to_have_count(10)
    assert_stored(site)
    trials = site.trials()
    assert [row["reached_end"] for row in trials] == [0, 0, 0, 0, 1, 0, 0, 0, 0, 0]
    assert [row["pauses"] for row in trials] == [0, 1, 0, 0, 0, 0, 0, 0, 0, 0]
    assert trials[1]["paused_ms"] > 0
    assert [event["trial_index"] for event in site.events("continued")] == [2]
    (about,) = site.rows("select * from demographics")
    assert (about["age"], about["gender"]) == (31, "woman")
    assert about["nationality"] == "prefer not to say"
    (device,) = site.rows("select viewport_width, viewport_height, pointer_type from participants")
    assert tuple(device.values()) == (1280, 800, "mouse")
    (recruit,) = site.rows("select * from recruits")
    assert recruit["recruiter_id"] == "5f1e0c2a9b3d4e6f7a8b9c0d"


def test_by_keyboard_alone_on_a_phone_with_reloads_and_the_back_key(site: Site, visit: Visit):
    page = visit(viewport=PHONE)
    page.goto("/")
    tab_to(page, "I agree and take part")
    page.keyboard.press("Enter")

    page.wait_for_url("**/about-you")
    tab_to(page, "How old are you?")
    page.keyboard.type("44")
    page.keyboard.press("Tab")
    for number in range(5):
        page.keyboard.press("Tab")
        if number == 1:  # nationality: leave the text empty and tick that it is withheld
            page.keyboard.press("Tab")
            page.keyboard.press("Space")
        else:
            page.keyboard.press("Space")
            page.keyboard.press("ArrowDown")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    page.wait_for_url("**/instructions")
    tab_to(page, "Try it once")
    page.keyboard.press("Enter")

    page.wait_for_url("**/practice")
    walk.ready(page)
    page.keyboard.press("Space")
    walk.phase(page, "moving")
    page.keyboard.press("Space")
    walk.phase(page, "stopped")
    page.keyboard.type("f7")
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")

    page.wait_for_url("**/trial")
    for index, (letter, degree) in enumerate(zip(LETTERS, DEGREES, strict=True), 1):
        walk.round_is(page, index)
        page.keyboard.press("Space")
        walk.moved(page, STEP_MS)
        if index == 4:
            page.reload()
            walk.phase(page, "paused")
            page.keyboard.press("Space")
            walk.moved(page, 2 * STEP_MS)
        page.keyboard.press("Space")
        walk.phase(page, "stopped")
        if index == 7:
            page.go_back()
            page.wait_for_url("**/trial")
            walk.phase(page, "stopped")
        choose_by_keys(page, index, letter, degree)
        page.keyboard.press("Enter")

    page.wait_for_url("**/end")
    assert_stored(site)
    assert [row["pauses"] for row in site.trials()] == [0, 0, 0, 1, 0, 0, 0, 0, 0, 0]
    (about,) = site.rows("select * from demographics")
    assert (about["age"], about["gender"]) == (44, "man")
    (device,) = site.rows("select viewport_width, pointer_type from participants")
    assert tuple(device.values()) == (360, "keyboard")


def say_who_they_are(page: Page) -> None:
    page.fill("[name=age]", "31")
    page.check("[name=gender][value=woman]")
    page.check("[name=nationality_withheld]")
    page.check("[name=education][value='doctorate']")
    page.check("[name=occupation][value='student']")
    page.check("[name=robot_familiarity][value='not at all']")
    page.get_by_role("button", name="Continue").click()


def choose_by_keys(page: Page, index: int, letter: str, degree: int) -> None:
    """The ways of the keyboard in turn: letters and digits, digits only, Tab and arrows."""
    if index % 3 == 0:
        page.keyboard.press(str("ABCDEF".index(letter) + 1))
        page.keyboard.press(str(degree))
    elif index % 3 == 1:
        page.keyboard.press(letter.lower())
        page.keyboard.press("Space")
        for _ in range(degree - 1):
            page.keyboard.press("ArrowRight")
    else:
        page.keyboard.press("Tab")
        page.keyboard.press("Space")
        for _ in range("ABCDEF".index(letter)):
            page.keyboard.press("ArrowRight")
        page.keyboard.press("Tab")
        page.keyboard.press(str(degree))
