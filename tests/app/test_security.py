"""What every request must pass and every reply carries."""

from hashlib import sha256

import pytest
from starlette.testclient import TestClient

from app import arrival
from app.main import create_app
from app.tables import sessions
from tests import messages
from tests.app.conftest import ORIGIN, Browser

PAGES = ["/", "/no-consent", "/about-you", "/nothing", "/api/trial", "/withdrawn"]


@pytest.mark.parametrize("path", PAGES)
def test_every_reply_forbids_inline_script_and_style_and_other_hosts(browser, path):
    policy = browser.get(path).headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self'" in policy
    assert "style-src 'self'" in policy
    assert "unsafe" not in policy
    assert "http" not in policy


@pytest.mark.parametrize("path", PAGES)
def test_no_page_is_kept_by_caches(browser, path):
    assert browser.get(path).headers["cache-control"] == "no-store"


def test_static_files_are_compressed_and_kept_for_good(browser, client):
    root = client.app.state.services.pages.static_root
    reply = browser.client.get(f"{root}/style.css", headers={"accept-encoding": "gzip"})
    assert reply.headers["content-encoding"] == "gzip"
    assert "immutable" in reply.headers["cache-control"]


def test_the_session_cookie_is_out_of_reach_of_scripts_and_other_sites(browser):
    cookie = browser.consent().headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=lax" in cookie
    assert "secure" not in cookie


def test_over_https_the_session_cookie_is_secure(client):
    secure = Browser(TestClient(client.app, base_url="https://study.test"))
    page = secure.get("/")
    assert page.status_code == 200
    fields = {"arrival": "x" * 20, "decision": "yes"}
    reply = secure.client.post(
        "/consent", data=fields, headers={"origin": "https://study.test"}, follow_redirects=False
    )
    assert "secure" in reply.headers["set-cookie"].lower()


def test_only_a_hash_of_the_token_is_stored(browser, rows):
    browser.consent()
    token = browser.client.cookies["goalguess_session"]
    assert len(token) >= 40
    assert [row.token_hash for row in rows(sessions)] == [sha256(token.encode()).hexdigest()]


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"origin": "https://elsewhere.test"},
        {"origin": "null"},
        {"origin": "http://["},
        {"origin": "study.test"},
        {"sec-fetch-site": "cross-site"},
        {"origin": "https://elsewhere.test", "sec-fetch-site": "same-origin"},
    ],
)
@pytest.mark.parametrize("path", ["/consent", "/withdraw", "/api/trials/1/played"])
def test_a_post_from_elsewhere_is_refused(browser, headers, path):
    browser.reach_practice()
    reply = browser.client.post(path, headers=headers, follow_redirects=False)
    assert reply.status_code == 403
    assert reply.headers["content-security-policy"]


def test_a_post_that_the_browser_vouches_for_is_taken(browser):
    browser.consent()
    reply = browser.client.post(
        "/about-you",
        data=messages.ABOUT_ME,
        headers={"sec-fetch-site": "same-origin"},
        follow_redirects=False,
    )
    assert reply.headers["location"] == "/instructions"


@pytest.mark.parametrize("chunked", [False, True])
def test_a_body_larger_than_any_page_sends_is_refused(browser, chunked):
    browser.reach_trials()
    large = b"{" + b" " * 70_000 + b"}"
    content = iter([large[:40_000], large[40_000:]]) if chunked else large
    reply = browser.client.post("/api/events", content=content, headers={"origin": ORIGIN})
    assert reply.status_code == 413
    assert reply.json()["error"]["code"] == "too_large"


def test_a_malformed_body_is_refused_in_one_line(browser):
    browser.reach_trials()
    reply = browser.client.post("/api/events", content=b"{", headers={"origin": ORIGIN})
    assert reply.status_code == 422
    assert "\n" not in reply.json()["error"]["message"]


def test_an_unknown_page_is_a_page_of_ours(browser):
    reply = browser.get("/nothing")
    assert reply.status_code == 404
    assert "There is no such page." in reply.text


def test_a_crash_tells_the_browser_nothing_of_the_code(settings, monkeypatch):
    def crash(*_arguments):
        raise RuntimeError("secret detail")

    monkeypatch.setattr(arrival, "find", crash)
    with TestClient(create_app(settings), base_url=ORIGIN, raise_server_exceptions=False) as client:
        reply = client.get("/")
    assert reply.status_code == 500
    assert "Something went wrong on our side" in reply.text
    assert "secret" not in reply.text
    assert "Traceback" not in reply.text
    assert reply.headers["content-security-policy"]


def test_no_interface_description_is_published(browser):
    for path in ("/docs", "/redoc", "/openapi.json"):
        assert browser.get(path).status_code == 404
