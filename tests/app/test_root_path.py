"""The study under a path of its host, whether a proxy passes the path on or takes it off."""

import asyncio
import re

import pytest
from httpx2 import ASGITransport, AsyncClient, Response
from starlette.testclient import TestClient

from app.bots.crowd import draw_bots, simulate
from app.bots.kinds import read_mix
from app.errors import InvalidInput
from app.main import create_app
from app.pages import resources
from tests import messages
from tests.app.conftest import ORIGIN, Browser
from tests.prefix_proxy import PrefixProxy

PREFIX = "/lab/study"
ADDRESS = re.compile(r'(?:href|src|action)="(?!#|mailto:|https://app\.prolific)(.*?)"')


class Visitor(Browser):
    """Asks for what it is sent to, and looks at every address on the way."""

    def get(self, path: str) -> Response:
        return self._looked_at(super().get(self._whole(path)))

    def post(self, path: str, form: dict[str, str] | None = None) -> Response:
        return self._looked_at(super().post(self._whole(path), form))

    def send(self, path, body):
        return super().send(self._whole(path), body)

    def _whole(self, path: str) -> str:
        return path if path.startswith(PREFIX) else PREFIX + path

    def _looked_at(self, reply: Response) -> Response:
        location = reply.headers.get("location")
        for address in [*ADDRESS.findall(reply.text), *([location] if location else [])]:
            assert address.startswith(f"{PREFIX}/"), address
            if "/static/" in address:
                assert self.client.get(address).status_code == 200, address
        return reply


@pytest.fixture
def under_prefix(settings):
    return settings.model_copy(update={"root_path": PREFIX})


@pytest.fixture(params=[True, False], ids=["stripped", "kept"])
def visitor(under_prefix, request):
    proxy = PrefixProxy(create_app(under_prefix), PREFIX, strips=request.param)
    with TestClient(proxy, base_url=ORIGIN) as client:
        yield Visitor(client)


def test_the_whole_study_works_under_a_path(visitor):
    visitor.consent("?PROLIFIC_PID=p1")
    assert visitor.get("/").headers["location"] == f"{PREFIX}/about-you"
    assert visitor.get("/about-you").status_code == 200
    visitor.post("/about-you", messages.ABOUT_ME)
    assert visitor.get("/instructions").status_code == 200
    visitor.post("/instructions")
    page = visitor.get("/practice")
    assert f'data-root="{PREFIX}"' in page.text
    assert visitor.get("/api/practice").status_code == 200
    trial_page = visitor.post("/practice", messages.RIGHT_ANSWER).headers["location"]
    assert visitor.get(trial_page).status_code == 200
    for index in range(1, 11):
        assert visitor.finish_trial(index).status_code == 200
    assert "all 10 rounds are in" in visitor.get("/end").text
    assert visitor.get("/withdraw").status_code == 200
    assert visitor.get(visitor.post("/withdraw").headers["location"]).status_code == 200
    assert visitor.get("/end").status_code == 401


def test_the_first_page_is_there_with_and_without_a_slash_at_the_end(visitor):
    for path in (PREFIX, f"{PREFIX}/", f"{PREFIX}?PROLIFIC_PID=p1"):
        assert "I agree and take part" in visitor.get(path).text
    assert visitor.client.get("/").text == "another site"


def test_the_cookie_belongs_to_the_study_alone(visitor):
    assert f"Path={PREFIX};" in visitor.consent().headers["set-cookie"]
    forgotten = visitor.post("/withdraw")
    assert f"Path={PREFIX};" in forgotten.headers["set-cookie"]
    assert "Max-Age=0" in forgotten.headers["set-cookie"]
    assert "clear-site-data" not in forgotten.headers


def test_refusals_are_pages_for_people_and_json_for_programs(visitor):
    assert visitor.get("/nothing").status_code == 404
    refused = visitor.send("/api/events", {})
    assert refused.headers["content-type"] == "application/json"


def test_a_crash_under_a_path_is_told_in_the_right_form(under_prefix, monkeypatch):
    def crash(*_arguments):
        raise RuntimeError

    app = create_app(under_prefix)
    proxy = PrefixProxy(app, PREFIX, strips=True)
    monkeypatch.setattr("app.answering.participant_at_trial", crash)
    with TestClient(proxy, base_url=ORIGIN, raise_server_exceptions=False) as client:
        reply = client.get(f"{PREFIX}/api/trial")
    assert (reply.status_code, reply.headers["content-type"]) == (500, "application/json")


@pytest.mark.parametrize("strips", [True, False])
def test_simulated_participants_take_part_under_a_path(under_prefix, strips):
    async def take_part():
        app = create_app(under_prefix)
        transport = ASGITransport(app=PrefixProxy(app, PREFIX, strips))
        bots = draw_bots(2, 1, read_mix("attentive=1"))
        async with app.router.lifespan_context(app):
            return await simulate(
                lambda: AsyncClient(
                    transport=transport,
                    base_url=f"http://host.test{PREFIX}/",
                    follow_redirects=True,
                ),
                bots,
                at_once=2,
            )

    ends = {outcome.ended for outcome in asyncio.run(take_part())}
    assert ends <= {"Thank you, all 10 rounds are in", "Thank you, the study ends here"}


def test_a_study_under_a_path_is_not_confused_by_the_cookie_of_one_at_the_top(under_prefix):
    with TestClient(create_app(under_prefix), base_url=ORIGIN) as client:
        client.cookies.set("goalguess_session", "of-the-study-at-the-top", path="/")
        reply = client.get(f"{PREFIX}/")
        fields = dict(re.findall(r'type="hidden" name="(.*?)" value="(.*?)"', reply.text))
        form = {**fields, "decision": "yes"}
        reply = client.post(f"{PREFIX}/consent", data=form, headers={"origin": ORIGIN})
    assert reply.status_code == 200
    assert reply.url.path == f"{PREFIX}/about-you"


@pytest.mark.parametrize("path", ["/trial", "/api", "/static/lab", "/end", "/health"])
def test_a_path_that_could_be_a_page_of_the_study_is_refused(settings, path):
    with pytest.raises(InvalidInput, match="GOALGUESS_ROOT_PATH"):
        create_app(settings.model_copy(update={"root_path": path}))


def test_no_template_and_no_module_has_an_address_of_its_own():
    for template in resources("templates").glob("*.html"):
        assert not re.search(r'(href|src|action)="/', template.read_text("utf-8")), template.name
    for module in resources("static").glob("*.js"):
        text = module.read_text("utf-8")
        assert not re.search(r"(assign|replace|open|fetch|sendBeacon)\([\"'`]/", text), module.name
