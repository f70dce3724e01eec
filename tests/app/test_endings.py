"""The last pages: what they say where an ending has a code, and where it has none."""

import re

import pytest
from starlette.testclient import TestClient

from app.main import create_app
from app.settings import Settings
from tests.app.conftest import ORIGIN, Browser
from tests.app.test_pilots import CODES, ENDINGS

WHAT_TO_DO = {
    "completed": "message the researchers there that you have finished",
    "no_consent": "please return your submission there",
    "screened_out": "please return your submission there",
    "failed": "message the researchers there that the study ended early",
    "withdrawn": "please return your submission",
}


@pytest.fixture
def ended_with(settings):
    """Reaches an ending under codes; returns its page."""

    def reach(ending, codes, **changes):
        changed = settings.model_copy(update={"codes": codes, **changes})
        with TestClient(create_app(changed), base_url=ORIGIN) as client:
            return ENDINGS[ending](Browser(client), "?PROLIFIC_PID=p1").text

    return reach


@pytest.mark.parametrize("ending", ENDINGS)
def test_an_ending_without_a_code_says_what_to_do_on_the_recruiting_site(ended_with, ending):
    others = {name: code for name, code in CODES.items() if name != ending}
    page = ended_with(ending, others)
    assert WHAT_TO_DO[ending] in page
    assert "If a site such as Prolific sent you" in page
    assert "You can close this page now" in page
    assert "prolific.com" not in page
    assert 'class="code"' not in page


def test_no_consent_means_return_and_its_link_says_so(ended_with):
    page = ended_with("no_consent", CODES)
    assert "please return your submission there" in page
    assert re.findall(r'<a class="button primary" href=".*?">(.*?)</a>', page) == [
        "Return my submission"
    ]
    assert "Your code for not taking part" in page
    assert "complet" not in re.sub(r'href="[^"]*"', "", page)


def test_who_withdrew_is_given_no_code_that_looks_like_one_for_completing(ended_with):
    page = ended_with("withdrawn", CODES)
    assert "Your code for having withdrawn" in page
    assert "complet" not in re.sub(r'href="[^"]*"', "", page)


@pytest.mark.parametrize("ending", ENDINGS)
def test_without_an_address_to_return_to_the_code_is_there_to_copy(ended_with, ending):
    page = ended_with(ending, CODES, return_url="")
    assert f">{CODES[ending]}<" in page
    assert "Copy the code" in page


def test_the_start_names_every_ending_without_a_code():
    gaps = Settings(researchers="Ada", contact="ada@example.org", codes={"failed": "C1"}).gaps
    named = [re.match(r"GOALGUESS_CODES, (\w+) \(.+\)$", gap) for gap in gaps]
    assert [match and match[1] for match in named] == [
        "completed",
        "no_consent",
        "screened_out",
        "withdrawn",
    ]
    assert Settings(researchers="Ada", contact="ada@example.org", codes=CODES).gaps == []


def test_the_start_doubts_codes_shared_with_completed_and_a_way_back_without_any():
    shared = Settings(codes={"completed": "C1", "no_consent": "C1", "failed": "C2"})
    (doubt,) = shared.doubts
    assert doubt.startswith("GOALGUESS_CODES, no_consent: the same code as completed")
    (doubt,) = Settings(codes=CODES, return_url="https://example.org/").doubts
    assert doubt.startswith("GOALGUESS_RETURN_URL: holds no {code}")
    assert Settings(codes=CODES).doubts == Settings(return_url="").doubts == []
