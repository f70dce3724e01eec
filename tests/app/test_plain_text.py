"""Text in every script: taken as it is, refused for what is no text, counted as people count."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.plain_text import LONGEST, count_characters, is_blank, problem_of
from app.questions import ABOUT_YOU, answers
from app.tables import demographics
from tests import messages

TEXT = st.characters(exclude_categories=("Cc", "Cs", "Zl", "Zp"))
CONTROLS = st.characters(categories=("Cc", "Cs", "Zl", "Zp"))
SCRIPTS = {
    "Latin": (0x41, 0x24F),
    "Greek": (0x370, 0x3FF),
    "Cyrillic": (0x400, 0x52F),
    "Hebrew": (0x590, 0x5FF),
    "Arabic": (0x600, 0x6FF),
    "Devanagari": (0x900, 0x97F),
    "Sinhala": (0xD80, 0xDFF),
    "Thai": (0xE00, 0xE7F),
    "Hangul": (0xAC00, 0xD7A3),
    "Han": (0x4E00, 0x9FFF),
    "emoji": (0x1F300, 0x1FAFF),
}


def in_script(first, last):
    letters = st.characters(
        min_codepoint=first, max_codepoint=last, exclude_categories=("Cc", "Cs", "Cn")
    )
    return st.text(letters | st.sampled_from(" \u00a0\u3000\u200c\u200d\u200e\u200f"), max_size=60)


@pytest.mark.parametrize("script", SCRIPTS)
def test_sixty_characters_of_any_script_are_text(script):
    @given(in_script(*SCRIPTS[script]))
    def is_text(text):
        assert problem_of(text) is None

    is_text()


@given(st.text(TEXT, max_size=60))
def test_a_short_text_is_refused_for_no_character_that_is_text(text):
    assert problem_of(text) is None


@given(st.text(TEXT, max_size=30), CONTROLS, st.text(TEXT, max_size=29))
def test_a_control_character_is_told_as_that_and_not_as_a_length(before, control, after):
    problem = problem_of(before + control + after)
    assert problem
    assert "on one line" in problem
    assert str(LONGEST) not in problem


@given(st.text(TEXT, min_size=961, max_size=1200))
def test_what_is_too_long_is_told_as_that(text):
    assert problem_of(text) == "Please use at most 60 characters."


def test_marks_without_end_on_one_character_are_too_long():
    assert problem_of("e" + "\u0301" * 959) is None
    assert problem_of("e" + "\u0301" * 960) == "Please use at most 60 characters."


@given(st.text(TEXT, max_size=80))
def test_no_text_has_more_characters_than_code_points_and_composing_adds_none(text):
    count = count_characters(text)
    assert 0 <= count <= len(text)
    if text.isascii():
        assert count == len(text)
    latin = unicodedata.normalize("NFC", "é" * 5 + "ñ")
    assert count_characters(unicodedata.normalize("NFD", latin)) == count_characters(latin) == 6


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("Portuguese", 10),
        ("ශ්‍රී ලාංකික", 6),
        ("می‌خواهم", 7),
        ("নেপালি", 3),
        ("👩🏽‍🚀", 1),
        ("👨‍👩‍👧‍👦👍🏿", 2),
        ("🇵🇹🇧🇷", 2),
        ("🏴󠁧󠁢󠁥󠁮󠁧󠁿", 1),
        ("e\u0301", 1),
        ("‏עברית‎", 7),
    ],
)
def test_characters_are_counted_as_people_count_them(text, count):
    assert count_characters(text) == count


@pytest.mark.parametrize("joined", ["👨‍👩‍👧‍👦", "🏴󠁧󠁢󠁥󠁮󠁧󠁿", "e\u0301", "कि"])
def test_sixty_joined_characters_are_taken_and_sixty_one_are_not(joined):
    assert problem_of(joined * 60) is None
    assert problem_of(joined * 61 + "abc" * 20) == "Please use at most 60 characters."


@pytest.mark.parametrize("text", ["", " ", "\u00a0\u3000", "\u200b", "\u200e\u200d"])
def test_what_cannot_be_seen_is_blank(text):
    assert is_blank(text)
    _given, wrong = answers(ABOUT_YOU, {**messages.ABOUT_ME, "nationality": text})
    assert "prefer not to say" in wrong["nationality"]


@pytest.mark.parametrize(
    "text",
    ["ශ්‍රී ලාංකික", "ایرانی‌تبار", "Costa\u00a0Rican", "日本　国籍", "\u200fישראלי\u200e", "🏳️‍🌈 Dutch"],
)
def test_a_nationality_in_any_script_is_stored_as_it_was_typed(browser, rows, text):
    browser.consent()
    reply = browser.post("/about-you", {**messages.ABOUT_ME, "nationality": text})
    assert reply.headers["location"] == "/instructions"
    assert rows(demographics)[0].nationality == text


@pytest.mark.parametrize(("name", "value"), [("age", "31"), ("nationality", "Portuguese")])
def test_an_answer_beside_prefer_not_to_say_is_asked_again_with_both_shown(
    browser, rows, name, value
):
    browser.consent()
    form = {**messages.ABOUT_ME, name: value, f"{name}_withheld": "yes"}
    reply = browser.post("/about-you", form)
    assert reply.status_code == 422
    assert f'id="e-{name}">Please either answer' in reply.text
    assert f'name="{name}" value="{value}"' in reply.text
    assert f'name="{name}_withheld" value="yes" checked' in reply.text
    assert rows(demographics) == []


def test_a_number_only_of_blanks_beside_prefer_not_to_say_is_withheld():
    form = {**messages.ABOUT_ME, "age": " \u200b", "age_withheld": "yes"}
    given_answers, wrong = answers(ABOUT_YOU, form)
    assert (wrong, given_answers["age"]) == ({}, None)


def test_the_page_cuts_no_text_that_would_be_taken(browser):
    browser.consent()
    assert "maxlength" not in browser.get("/about-you").text
