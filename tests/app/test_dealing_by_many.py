"""Dealing by several processes at once, on one file, with dropouts and returned places."""

from app.sqlite import sqlite_engine
from app.study import PARTICIPANT, load_study
from tests.app.arrivals import arrive_at_once, settings_of
from tests.app.dealing_bounds import bounds, read_dealings


def test_500_people_who_arrive_at_once_in_four_processes_are_dealt_within_the_bounds(tmp_path):
    settings = settings_of(tmp_path / "study.sqlite", seed=1)
    arrived = arrive_at_once(settings, 500, processes=4, seed=1)
    study = load_study(settings)
    with sqlite_engine(settings.database_url, "BEGIN").connect() as connection:
        dealings = read_dealings(connection, PARTICIPANT)
        kept = bounds(connection, dealings, study, settings.block_size, arrived.players)
    assert [bound for bound in kept if not bound.holds] == []
    assert dealings.again > 0
