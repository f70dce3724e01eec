"""Simulated participants on a real application: what they leave is what they were told."""

import sqlite3
from collections import Counter, defaultdict
from pathlib import Path

import pytest

from app.bots.crowd import draw_bots, run
from app.bots.kinds import Kind, read_mix
from app.bots.visit import LEFT
from app.errors import AppError, StudyClosed
from app.settings import Settings
from tests.browser.serving import served

EVERYBODY = ",".join(Kind)
ALL_ROUNDS = "Thank you, all 10 rounds are in"
SCREENED_OUT = "Thank you, the study ends here"
ANSWERED = """
    SELECT recruiter_id, trial_index, guess, confidence, stop_time_ms, pauses
    FROM trials JOIN recruits USING (participant_id) WHERE answered_at NOT NULL
"""


def query(file: Path, text: str):
    with sqlite3.connect(file) as connection:
        return connection.execute(text).fetchall()


def settings_on(file: Path) -> Settings:
    return Settings(database_url=f"sqlite:///{file}", seed=1)


@pytest.fixture(scope="module")
def crowd(tmp_path_factory):
    """Four of each kind on a database of their own: its file, and their outcomes."""
    file = tmp_path_factory.mktemp("crowd") / "study.sqlite"
    bots = draw_bots(4 * len(Kind), 7, read_mix(EVERYBODY))
    return file, run(bots, settings_on(file), at_once=20)


@pytest.fixture(scope="module")
def ended(crowd):
    """By kind, how often its visits ended where."""
    by_kind: dict[Kind, Counter[str]] = defaultdict(Counter)
    for outcome in crowd[1]:
        by_kind[outcome.bot.kind][outcome.ended] += 1
    return by_kind


def test_every_answer_acknowledged_is_stored_once_as_it_was_sent(crowd):
    file, outcomes = crowd
    told = {
        (outcome.bot.recruiter_id, index): (answer.guess, answer.confidence, answer.stop_time_ms)
        for outcome in outcomes
        for index, answer in outcome.answers.items()
        if outcome.bot.kind != Kind.WITHDRAWING
    }
    stored = {(who, at): tuple(facts) for who, at, *facts, _pauses in query(file, ANSWERED)}
    assert stored == told
    assert len(told) > 300


def test_rows_are_marked_simulated_and_agreed_to_like_anybodys(crowd):
    file, _ = crowd
    assert query(file, "SELECT DISTINCT stream FROM participants") == [("simulated",)]
    agents = "SELECT DISTINCT user_agent FROM participants WHERE step != 'withdrawn'"
    assert query(file, agents) == [("goalguess simulate",)]


@pytest.mark.parametrize(
    "kind", ["attentive", "never_stopping", "reloading", "double_clicking", "two_tabs", "offline"]
)
def test_whatever_befalls_them_they_get_to_the_end(ended, kind):
    assert ended[kind] <= Counter({ALL_ROUNDS: 4, SCREENED_OUT: 1})


def test_whoever_returns_the_next_day_finishes_in_another_browser(crowd, ended):
    assert ended[Kind.RETURNING][ALL_ROUNDS] >= 3
    assert query(crowd[0], "SELECT count(*) FROM events WHERE type = 'came_back'")[0][0] >= 3
    for outcome in crowd[1]:
        if outcome.ended == ALL_ROUNDS:
            assert sorted(outcome.answers) == list(range(1, 11))


def test_whoever_drops_out_stays_where_they_left(crowd, ended):
    file, outcomes = crowd
    assert ended[Kind.DROPPING_OUT].keys() <= {LEFT, "You are not taking part", SCREENED_OUT}
    steps = dict(
        query(
            file, "SELECT recruiter_id, step FROM participants JOIN recruits ON participant_id = id"
        )
    )
    for outcome in outcomes:
        if outcome.ended == LEFT:
            assert steps[outcome.bot.recruiter_id] not in ("completed", "withdrawn", "screened_out")


def test_nothing_is_left_of_whoever_withdraws(crowd, ended):
    file, outcomes = crowd
    assert ended[Kind.WITHDRAWING]["You have withdrawn"] >= 3
    gone = {o.bot.recruiter_id for o in outcomes if o.ended == "You have withdrawn"}
    assert gone.isdisjoint(who for (who,) in query(file, "SELECT recruiter_id FROM recruits"))
    for table in ("trials", "events", "demographics", "sessions"):
        left = (
            f"SELECT count(*) FROM {table} JOIN participants ON participant_id = participants.id "
            "WHERE step = 'withdrawn'"
        )
        assert query(file, left) == [(0,)], table


def test_what_another_tab_says_of_the_same_moment_is_not_stored(crowd):
    file, outcomes = crowd
    names = {o.bot.recruiter_id for o in outcomes if o.bot.kind == Kind.TWO_TABS}
    stops = [
        stop for who, _at, _guess, _sure, stop, _pauses in query(file, ANSWERED) if who in names
    ]
    assert stops
    assert 0 not in stops  # the other tab's


def test_a_reload_in_mid_motion_is_a_pause(crowd):
    file, outcomes = crowd
    names = {o.bot.recruiter_id for o in outcomes if o.bot.kind == Kind.RELOADING}
    assert any(pauses for who, *_, pauses in query(file, ANSWERED) if who in names)


def test_a_pilots_refusal_is_not_counted(crowd):
    assert query(crowd[0], "SELECT * FROM tallies") == []


def kept(file: Path):
    """Everything in the rows that is neither random by intent nor the server's clock."""
    return query(
        file,
        """
        SELECT recruiter_id, step, control_tries, viewport_width, pointer_type, age, gender,
               nationality, number, condition, trial_index, stimulus, stop_time_ms, reached_end,
               guess, confidence, pauses, paused_ms, focus_losses, frames_dropped,
               guess_latency_ms, confidence_latency_ms, pointer_moved
        FROM recruits JOIN participants ON participants.id = recruits.participant_id
        LEFT JOIN demographics USING (participant_id)
        LEFT JOIN places USING (participant_id)
        LEFT JOIN trials USING (participant_id)
        ORDER BY recruiter_id, trial_index
        """,
    ) + query(
        file,
        """
        SELECT recruiter_id, message_key, ordinal, type, client_time_ms, details
        FROM events JOIN recruits USING (participant_id) WHERE client_time_ms NOT NULL
        ORDER BY recruiter_id, message_key, ordinal
        """,
    )


def test_the_same_seed_leaves_the_same_rows_however_many_are_on_the_way(tmp_path):
    bots = [draw_bots(22, 3, read_mix(EVERYBODY)) for _ in range(2)]
    files = [tmp_path / "one.sqlite", tmp_path / "many.sqlite"]
    for file, drawn, at_once in zip(files, bots, (1, 22), strict=True):
        run(drawn, settings_on(file), at_once)
    assert kept(files[0]) == kept(files[1])
    assert len(kept(files[0])) > 500


def test_another_seed_leaves_other_rows(tmp_path):
    for seed in (1, 2):
        run(draw_bots(2, seed, read_mix("attentive")), settings_on(tmp_path / f"{seed}.sqlite"), 2)
    stops = [
        query(tmp_path / f"{seed}.sqlite", "SELECT stop_time_ms FROM trials") for seed in (1, 2)
    ]
    assert stops[0] != stops[1]


def test_they_visit_a_running_study_by_its_address(tmp_path):
    file = tmp_path / "study.sqlite"
    with served(settings_on(file)) as url:
        (outcome,) = run(draw_bots(1, 1, read_mix("attentive")), url, at_once=1)
    assert outcome.ended == ALL_ROUNDS
    assert len(query(file, ANSWERED)) == 10


def test_who_comes_again_with_the_same_seed_has_finished_already(tmp_path):
    settings = settings_on(tmp_path / "study.sqlite")
    for answers in (10, 0):
        (outcome,) = run(draw_bots(1, 1, read_mix("attentive")), settings, at_once=1)
        assert outcome.ended == ALL_ROUNDS
        assert len(outcome.answers) == answers


def test_places_lost_meanwhile_are_dealt_anew(tmp_path):
    settings = settings_on(tmp_path / "study.sqlite").model_copy(update={"place_minutes": 1e-5})
    outcomes = run(draw_bots(12, 1, read_mix("attentive")), settings, at_once=12)
    assert {len(outcome.answers) for outcome in outcomes} <= {0, 10}
    assert len(query(settings.database_file, ANSWERED)) == sum(len(o.answers) for o in outcomes)


def test_a_closed_study_is_told_of_before_anybody_comes(tmp_path):
    settings = settings_on(tmp_path / "study.sqlite").model_copy(update={"study_open": False})
    with pytest.raises(StudyClosed, match="GOALGUESS_STUDY_OPEN is false"):
        run(draw_bots(1, 1, read_mix("attentive")), settings, at_once=1)


@pytest.mark.parametrize("url", ["http://127.0.0.1:9/", "nonsense", "ftp://127.0.0.1/"])
def test_an_address_where_no_study_answers_is_told_in_one_line(url):
    with pytest.raises(AppError, match="expected the address of a running study"):
        run(draw_bots(1, 1, read_mix("attentive")), url, at_once=1)
