"""How many may begin from one network: as many at once as in a minute, then one at a time."""

import asyncio

import pytest
from httpx2 import AsyncClient, Client, MockTransport, Response
from sqlalchemy import select
from starlette.testclient import TestClient

from app import limits
from app.bots.browser import Browser as Visitor
from app.database import Database
from app.limits import Moderation
from app.main import create_app
from app.tables import participants
from tests.app.conftest import ORIGIN, Browser
from tests.browser.serving import served


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def moderation(clock) -> Moderation:
    return Moderation(60, clock)


def test_as_many_begin_at_once_as_in_a_minute_and_then_one_a_second(moderation, clock):
    assert [moderation.wait_s("192.0.2.1") for _ in range(60)] == [0] * 60
    assert moderation.wait_s("192.0.2.1") == 1
    clock.now += 1
    assert moderation.wait_s("192.0.2.1") == 0
    assert moderation.wait_s("192.0.2.1") == 1


def test_one_network_does_not_make_another_wait(moderation):
    for _ in range(61):
        moderation.wait_s("192.0.2.1")
    assert moderation.wait_s("192.0.2.2") == 0


def test_all_addresses_of_one_household_count_together(moderation):
    for host in range(60):
        assert moderation.wait_s(f"2001:db8::{host:x}") == 0
    assert moderation.wait_s("2001:db8::ffff") > 0
    assert moderation.wait_s("2001:db8:0:1::1") == 0


@pytest.mark.parametrize("address", ["127.0.0.1", "127.3.2.1", "::1", "::ffff:127.0.0.1", None, ""])
def test_this_machine_and_who_has_no_address_never_wait(moderation, address):
    assert {moderation.wait_s(address) for _ in range(100)} == {0}


def test_whoever_was_not_seen_for_longest_is_forgotten(moderation, monkeypatch):
    monkeypatch.setattr(limits, "MOST_NETWORKS", 3)
    for _ in range(61):
        moderation.wait_s("192.0.2.1")
    for host in (2, 3, 1, 4):
        moderation.wait_s(f"192.0.2.{host}")
    assert len(moderation._buckets) == 3
    assert moderation.wait_s("192.0.2.1") > 0


def test_no_address_is_kept_in_words(moderation):
    moderation.wait_s("192.0.2.77")
    assert "192.0.2.77" not in repr(vars(moderation))
    assert bytes([192, 0, 2, 77]) not in moderation._buckets


def test_one_consent_too_many_is_asked_to_wait_and_makes_nobody(settings):
    few = settings.model_copy(update={"consents_per_minute": 2})
    with TestClient(create_app(few), base_url=ORIGIN, client=("192.0.2.1", 1)) as client:
        replies = []
        for _ in range(3):
            client.cookies.clear()
            replies.append(Browser(client).consent())
        database: Database = client.app.state.services.database  # type: ignore[attr-defined]
        made = database.read_now(lambda c: c.execute(select(participants)).all())
    assert [reply.status_code for reply in replies] == [303, 303, 429]
    assert len(made) == 2
    assert replies[2].headers["retry-after"] == "30"
    assert "wait 30 seconds" in replies[2].text


def test_going_on_elsewhere_again_and_again_is_asked_to_wait_too(settings):
    few = settings.model_copy(update={"consents_per_minute": 2})
    link = "?PROLIFIC_PID=ann"
    with TestClient(create_app(few), base_url=ORIGIN, client=("192.0.2.1", 1)) as client:
        Browser(client).consent(link)
        statuses = []
        for _ in range(2):
            client.cookies.clear()
            statuses.append(Browser(client).go_on_here(link).status_code)
    assert statuses == [303, 429]


def test_the_limit_counts_the_addresses_that_a_proxy_passes_on(settings):
    few = settings.model_copy(update={"consents_per_minute": 1})
    with served(few) as url, Client(base_url=url, headers={"host": "study.test"}) as client:
        statuses = []
        for address in ("192.0.2.1", "192.0.2.2", "192.0.2.1", None, None):
            client.cookies.clear()
            passed_on = {"x-forwarded-for": address} if address else {}
            client.headers.update(passed_on)
            statuses.append(Browser(client).consent().status_code)
            client.headers.pop("x-forwarded-for", None)
    assert statuses == [303, 303, 429, 303, 303]


def test_simulated_participants_wait_and_come_again():
    replies = iter([429, 429, 200])

    def answer(_request):
        return Response(next(replies), headers={"retry-after": "0"}, text="<h1>Welcome</h1>")

    async def come():
        async with AsyncClient(transport=MockTransport(answer), base_url="http://a.test") as client:
            return await Visitor(client).open("/")

    assert asyncio.run(come()).heading == "Welcome"
