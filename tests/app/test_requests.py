"""What is asked in unusual ways: without content, with forged hosts, sizes that are none."""

import logging

import pytest
from fastapi.routing import APIRoute
from starlette.routing import Route

from app import health, participant, trials_api
from tests.app.conftest import ORIGIN

ROUTES = [*participant.router.routes, *trials_api.routes, *health.routes]
READ = [r.path for r in ROUTES if isinstance(r, Route | APIRoute) and "GET" in (r.methods or ())]
PATHS = sorted({route.path.replace("{index:int}", "1") for route in ROUTES})  # type: ignore[attr-defined]


@pytest.mark.parametrize("path", READ)
def test_whatever_can_be_read_answers_head_as_it_answers_get(browser, path):
    browser.reach_practice()
    read, asked = browser.get(path), browser.client.head(path, follow_redirects=False)
    assert asked.status_code == read.status_code
    same = {name: value for name, value in asked.headers.items() if name != "content-length"}
    assert same.items() <= read.headers.items()


@pytest.mark.parametrize("path", [*PATHS, "/nothing"])
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_no_reply_repeats_the_host_that_was_asked_for(browser, path, method):
    browser.reach_practice()
    for slash in ("", "/", "//evil.test/"):
        reply = browser.client.request(
            method,
            path.rstrip("/") + slash or "/",
            headers={"host": "evil.test", "origin": "http://evil.test"},
            follow_redirects=False,
        )
        assert "evil" not in reply.headers.get("location", "")
        assert "evil.test" not in reply.text


def test_static_files_redirect_nowhere(browser, client):
    root = client.app.state.services.pages.static_root
    for path in (root, f"{root}/", f"{root}/trial.js/", "/static"):
        reply = browser.client.get(path, headers={"host": "evil.test"}, follow_redirects=False)
        assert reply.status_code in (200, 404)
        assert "location" not in reply.headers


@pytest.mark.parametrize("size", ["²", "9" * 5000, "-1", "1e3", " ", "٣", "65537"])
def test_a_size_that_is_no_possible_number_is_refused_in_words(client, size):
    headers = {"origin": ORIGIN, "content-length": size.encode()}
    reply = client.post("/api/events", content=b"", headers=headers)
    assert reply.status_code == 413
    assert "at most 65536 bytes" in reply.json()["error"]["message"]


@pytest.mark.parametrize(
    ("origin", "host", "vouched"),
    [
        ("https://study.test:8443", "study.test", None),
        ("https://study.test:8443", "study.test:8000", None),
        ("https://[2001:db8::1]:8443", "[2001:db8::1]", None),
        ("https://study.test", "127.0.0.1:8000", "same-origin"),
    ],
)
def test_a_proxy_that_changes_the_host_is_told_of_in_page_and_log(
    browser, caplog, origin, host, vouched
):
    headers = {"origin": origin, "host": host}
    headers |= {"sec-fetch-site": vouched} if vouched else {}
    with caplog.at_level(logging.WARNING):
        for path in ("/consent", "/api/events"):
            reply = browser.client.post(path, headers=headers)
            assert reply.status_code == 403
            assert "pass the header Host on unchanged, with its port" in reply.text
    assert [record.levelname for record in caplog.records] == ["WARNING"]
    assert "Host" in caplog.text


def test_another_site_hears_nothing_of_proxies(browser, caplog):
    headers = {"origin": "https://elsewhere.test", "sec-fetch-site": "cross-site"}
    reply = browser.client.post("/consent", headers=headers)
    assert "proxy" not in reply.text
    assert caplog.text == ""
