"""Answers in any interleaving: whatever is sent, however often, the first that was due stays."""

from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app import answering, arrival, enrolment, repository
from app.arrival import Link
from app.errors import AppError
from app.schemas import Answered, Played, Stopped
from app.sessions import participant_of
from app.steps import Step
from app.tables import trials
from tests import messages

MOMENTS: dict[str, tuple[Any, ...]] = {
    "played": (Played, answering.played, lambda _tab, at: messages.played(at.ticket)),
    "stopped": (Stopped, answering.stopped, lambda tab, _at: messages.stopped(1000.0 * tab)),
    "answered": (
        Answered,
        answering.answered,
        lambda tab, at: messages.answered("ABC"[tab], at.stop_time_ms or 0),
    ),
}
ORDER = [(index, moment) for index in range(1, 11) for moment in ("played", "stopped", "answered")]
# How far from what is due, and from which tab: mostly due, often stale, sometimes ahead.
DELIVERIES = st.lists(
    st.tuples(st.sampled_from([0, 0, 0, 0, -1, -2, -3, 1, 3]), st.integers(0, 2)),
    min_size=1,
    max_size=29,
)


@given(DELIVERIES)
@settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_answers_in_any_interleaving_of_three_tabs_are_stored_once_and_stay(
    database, study, deliveries
):
    """Whatever arrives, in whatever order and how often: the first that was due is what stays."""

    def arrive(connection):
        token = arrival.consent(connection, study, messages.key(), Link(), None, "test")
        participant = participant_of(connection, token)
        repository.change_participant(connection, participant.id, step=Step.TRIALS)
        enrolment.deal(connection, study, participant)
        return token, participant.id

    token, participant_id = database.submit(arrive).result()
    expected: dict[int, dict[str, int]] = {}
    due = 0
    for offset, tab in deliveries:
        place = max(0, due + offset)
        index, moment = ORDER[place]
        model, happen, body = MOMENTS[moment]
        at = database.read_now(
            lambda c: answering.standing(study, answering.participant_at_trial(c, token))
        )
        message = model.model_validate(body(tab, at))
        future = database.submit(lambda c, h=happen, i=index, m=message: h(c, study, token, i, m))
        if place > due:
            with pytest.raises(AppError):
                future.result()
        elif place == due:
            assert future.result().repeated is False
            expected.setdefault(index, {})[moment] = tab
            due += 1
        else:
            assert future.result().repeated is True
    stored = database.read_now(
        lambda c: c.execute(trials.select().where(trials.c.participant_id == participant_id)).all()
    )
    assert [row.trial_index for row in stored] == sorted(expected)
    for row in stored:
        first = expected[row.trial_index]
        assert row.stop_time_ms == (1000.0 * first["stopped"] if "stopped" in first else None)
        assert row.guess == ("ABC"[first["answered"]] if "answered" in first else None)
