"""A new place for who has lost theirs: at the trials, without one, and for nobody else."""

import pytest
from sqlalchemy import select

from app import enrolment, repository
from app.tables import places
from tests.app import people


def fail(connection, study, token):
    enrolment.fail(connection, study, token)


def come_to_practice(connection, study, token):
    people.describe(connection, study, token)
    enrolment.finish_instructions(connection, study, token)


def holders(connection):
    return connection.scalars(select(places.c.participant_id).order_by(places.c.number)).all()


@pytest.mark.parametrize(
    ("begin", "then"), [(people.reach_trials, fail), (people.consent, come_to_practice)]
)
def test_who_is_not_at_the_trials_is_dealt_nothing(database, study, begin, then):
    token = database.submit(lambda c: begin(c, study)).result()
    database.submit(lambda c: then(c, study, token)).result()
    database.submit(lambda c: enrolment.deal_again(c, study, token)).result()
    assert not any(database.read_now(holders))


def test_who_has_a_place_keeps_it_and_who_has_none_gets_one(database, study):
    token = database.submit(lambda c: people.reach_trials(c, study)).result()
    database.submit(lambda c: enrolment.deal_again(c, study, token)).result()
    assert database.read_now(holders)[:2] == [1, None]
    database.submit(lambda c: repository.free_unplayed_place_of(c, 1)).result()
    database.submit(lambda c: enrolment.deal_again(c, study, token)).result()
    assert database.read_now(holders)[:2] == [1, None]
