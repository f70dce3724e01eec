"""A server killed in the middle of many answers: what it has acknowledged is there, once."""

import sqlite3

from app.bots.crowd import draw_bots, run
from app.bots.kinds import read_mix
from app.settings import Settings
from tests.benchmarks import kill


def test_a_killed_server_loses_and_doubles_nothing_and_everybody_finishes(tmp_path):
    killed = kill.run(tmp_path, participants=24, seed=1)
    assert 0.2 * 240 <= killed.before <= 0.8 * 240
    assert killed.acknowledged == 240
    assert (killed.lost, killed.double, killed.unfinished) == (0, 0, 0)


def test_an_answer_that_is_missing_or_changed_is_seen(tmp_path):
    file = tmp_path / "study.sqlite"
    bots = draw_bots(2, 1, read_mix("attentive"))
    outcomes = run(bots, Settings(database_url=f"sqlite:///{file}", seed=1), at_once=2)
    assert kill.check(file, outcomes, before=0).holds
    with sqlite3.connect(file) as connection:
        connection.execute("DELETE FROM trials WHERE trial_index = 3")
        connection.execute("UPDATE trials SET confidence = 8 - confidence WHERE trial_index = 4")
        connection.execute("UPDATE trials SET stop_time_ms = 0 WHERE trial_index = 5")
        connection.executescript(
            "CREATE TEMP TABLE again AS SELECT * FROM events"
            " WHERE type = 'answered' AND trial_index = 6;"
            "UPDATE again SET id = NULL, message_key = 'again';"
            "INSERT INTO events SELECT * FROM again;"
        )
    found = kill.check(file, outcomes, before=0)
    assert (found.lost, found.double) == (6, 2)
