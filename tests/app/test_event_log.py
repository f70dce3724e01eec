"""The log: whole for whoever takes part, and bounded for whoever floods it."""

from app import event_log
from app.tables import events, trials
from tests import messages


def test_nobodys_log_grows_without_end_and_no_answer_is_held_back(browser, rows, monkeypatch):
    monkeypatch.setattr(event_log, "MOST_EVENTS", 60)
    browser.reach_trials()
    for _ in range(30):
        flood = {"key": messages.key(), "events": [messages.event("resized")] * 5}
        assert browser.send("/api/events", flood).status_code == 200
    assert len(rows(events)) == 60
    assert [row.type for row in rows(events)][-1] == "log_full"
    assert browser.finish_trial(1, "B").json()["trial"]["index"] == 2
    assert rows(trials)[0].guess == "B"
    assert len(rows(events)) == 60


def test_what_the_server_notes_has_room_beside_a_flood_but_no_end_either(
    browser, another_browser, rows, monkeypatch
):
    monkeypatch.setattr(event_log, "MOST_EVENTS", 20)
    monkeypatch.setattr(event_log, "MOST_NOTES", 3)
    link = "?PROLIFIC_PID=ann&SESSION_ID=x1"
    browser.reach_practice(link)
    flood = {"key": messages.key(), "events": [messages.event("resized")] * 30}
    browser.send("/api/events", flood)
    for _ in range(5):
        another_browser().go_on_here(link)
    kinds = [row.type for row in rows(events)]
    assert kinds[19:] == ["log_full", "came_back", "came_back", "came_back"]
