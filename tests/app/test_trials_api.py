"""What the trial page's routes refuse before anything is looked up."""

import pytest

from app.tables import events
from tests import messages

INDICES = ["0", "11", "12", "999", str(2**63), "9" * 4301, "-1", "1.5", "one", "%C2%B2"]


@pytest.mark.parametrize("reach", ["reach_trials", "take_part"])
@pytest.mark.parametrize("index", INDICES, ids=lambda index: index[:24])
def test_a_trial_that_the_study_has_not_is_refused_at_any_time(browser, rows, reach, index):
    getattr(browser, reach)()
    before = len(rows(events))
    for moment, body in (
        ("played", messages.played("none")),
        ("stopped", messages.stopped(100)),
        ("answered", messages.answered("A", 100)),
    ):
        reply = browser.send(f"/api/trials/{index}/{moment}", body)
        assert (reply.status_code, reply.json()["error"]["code"]) == (404, "no_such_trial")
    assert len(rows(events)) == before


@pytest.mark.parametrize("index", [0, 11, 2**63, -1])
def test_an_event_of_a_trial_that_the_study_has_not_is_refused(browser, rows, index):
    browser.reach_trials()
    before = len(rows(events))
    gone = {"key": messages.key(), "trial_index": index, "events": [messages.event("hidden")]}
    assert browser.send("/api/events", gone).status_code == 404
    assert len(rows(events)) == before
