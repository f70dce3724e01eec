"""How a participant gets through the study: quickly up to the trials, and through one trial."""

import re
from typing import Any

from playwright.sync_api import FloatRect, Page

from tests import messages


def reach_practice(page: Page, link: str = "/") -> None:
    """By plain requests, as the forms would send them."""
    page.goto(link)
    fields = dict(re.findall(r'type="hidden" name="(.*?)" value="(.*?)"', page.content()))
    post(page, "/consent", {**fields, "decision": "yes"})
    post(page, "/about-you", messages.ABOUT_ME)
    post(page, "/instructions", {})


def reach_trials(page: Page, link: str = "/") -> None:
    """To the first trial, opened and ready to be played."""
    reach_practice(page, link)
    post(page, "/practice", messages.control("know"))
    page.goto("/trial")
    ready(page)


def practise(page: Page) -> None:
    """Play the practice up to the control question."""
    ready(page)
    page.click("#play")
    phase(page, "moving")
    stop(page)
    answer(page, "B", 4)


def answer_control(page: Page, value: str) -> None:
    """Answer the control question by its form."""
    page.locator(f"input[name=answer][value={value}]").check()
    page.get_by_role("button", name="Answer").click()


def post(page: Page, path: str, form: dict[str, str]) -> None:
    """Send a form as a page of ours would, without waiting for what it shows."""
    reply = page.request.post(path, form=dict(form), headers={"origin": page.evaluate("origin")})
    assert reply.ok, f"{path}: {reply.status}"


def send(page: Page, path: str, body: messages.Body) -> None:
    """Send a message as the trial page would."""
    reply = page.request.post(path, data=body, headers={"origin": page.evaluate("origin")})
    assert reply.ok, f"{path}: {reply.text()}"


def send_rounds(page: Page, indices: range) -> None:
    """Play rounds by plain messages, as the trial page would send them."""
    for index in indices:
        ticket, stop_time_ms = trial(page)["ticket"], 150.0 * index
        send(page, f"/api/trials/{index}/played", messages.played(ticket))
        send(page, f"/api/trials/{index}/stopped", messages.stopped(stop_time_ms))
        guess = "ABCDEF"[index % 6]
        send(page, f"/api/trials/{index}/answered", messages.answered(guess, stop_time_ms))


def trial(page: Page) -> dict[str, Any]:
    """The trial the server says the participant is at."""
    state: dict[str, Any] = page.request.get("/api/trial").json()["trial"]
    return state


def area_cells(page: Page) -> dict[str, FloatRect]:
    """Where the maze's areas are on the page: the cell of each letter."""
    playback = trial(page)["playback"]
    box = page.locator("#maze").bounding_box()
    assert box
    size = box["width"] / (playback["cols"] + 0.24)  # 0.12 of a cell is left around the maze
    return {
        area["letter"]: FloatRect(
            x=box["x"] + size * (area["cell"][1] + 0.12),
            y=box["y"] + size * (area["cell"][0] + 0.12),
            width=size,
            height=size,
        )
        for area in playback["areas"]
    }


def phase(page: Page, name: str) -> None:
    """Wait until the stage is in a phase and takes presses."""
    page.wait_for_function(
        "name => document.querySelector(`#stage[data-phase=${name}]:not(.settling)`)", arg=name
    )


def ready(page: Page) -> None:
    phase(page, "ready")


def moved(page: Page, milliseconds: int) -> None:
    """Wait until the robot has been in motion for so long, by what the page itself keeps."""
    phase(page, "moving")
    page.wait_for_function(
        """milliseconds => {
            const name = Object.keys(localStorage).find(name => name.endsWith(":reached"));
            const reached = name && JSON.parse(localStorage[name]);
            const index = Number(document.querySelector("#round-index").textContent);
            return reached && reached.index === index && reached.position_ms >= milliseconds;
        }""",
        arg=milliseconds,
    )


def play(page: Page, milliseconds: int = 200) -> None:
    """Press Play and watch for a while."""
    ready(page)
    page.click("#play")
    moved(page, milliseconds)


def stop(page: Page) -> None:
    """Press Stop, as a mouse does: the press counts, not the release."""
    page.locator("#play").hover()
    page.mouse.down()
    page.mouse.up()
    phase(page, "stopped")


def answer(page: Page, letter: str, degree: int) -> None:
    """Choose an area and how sure, and go on."""
    page.locator(f"input[name=guess][value={letter}]").check()
    page.locator(f"input[name=confidence][value='{degree}']").check()
    page.click("#next")


def round_is(page: Page, index: int) -> None:
    """Wait for a round, ready to be played."""
    page.wait_for_function(
        "index => document.querySelector('#round-index').textContent === String(index)", arg=index
    )
    ready(page)
