"""What an id in a link is: trimmed, of a shape, and never something that was not filled in."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import BadLink
from app.recruiter_ids import PARAMETERS, PERSON, is_placeholder, misnamed, read_id, require_shape

SHAPED = st.from_regex(r"[A-Za-z0-9_-]{1,100}", fullmatch=True)
IDS = SHAPED.filter(lambda value: not is_placeholder(value))
BLANKS = st.text(
    st.sampled_from(" \t\n\r\u00a0\u2003\u3000\u200b\u200e\u2060\ufeff\u2028"), max_size=4
)
WORDS = ["null", "undefined", "none", "nan", "nil", "PROLIFIC_PID", "SESSION_ID", "workerId", "id"]
MARKS = ["{{{}}}", "${{{}}}", "[{}]", "%{}%", "<{}>", "{{{{{}}}}}", "[[{}]]", "${{e://Field/{}}}"]


@pytest.mark.parametrize("name", PARAMETERS)
@given(value=IDS, before=BLANKS, after=BLANKS)
def test_an_id_is_the_same_whatever_blanks_are_around_it(name, value, before, after):
    assert read_id(name, {name: f"{before}{value}{after}"}) == value


@pytest.mark.parametrize("name", PARAMETERS)
@given(blanks=BLANKS)
def test_a_blank_is_no_id(name, blanks):
    assert read_id(name, {name: blanks}) is None
    assert read_id(name, {}) is None


@pytest.mark.parametrize("name", PARAMETERS)
@given(word=st.sampled_from(WORDS), upper=st.lists(st.booleans(), min_size=12, max_size=12))
def test_a_word_for_nothing_and_a_parameters_name_are_refused_in_any_case(name, word, upper):
    cased = "".join(
        letter.upper() if up else letter.lower() for letter, up in zip(word, upper, strict=False)
    )
    with pytest.raises(BadLink, match=f"{name}: expected an id .* placeholder"):
        read_id(name, {name: cased})


@pytest.mark.parametrize("name", PARAMETERS)
@given(
    inner=st.text(st.characters(codec="utf-8"), max_size=20),
    mark=st.sampled_from(MARKS),
    around=st.tuples(st.just("") | SHAPED.map(lambda text: text[:9]), st.just("")),
)
def test_what_a_site_was_to_replace_is_refused_wherever_it_stands(name, inner, mark, around):
    before, after = around
    with pytest.raises(BadLink):
        read_id(name, {name: f"{before}{mark.format(inner)}{after}"})


@given(value=IDS)
def test_letters_digits_hyphens_and_underscores_are_the_shape_of_an_id(value):
    require_shape(PERSON, value)


@given(st.text(st.characters(codec="utf-8"), min_size=1, max_size=100))
def test_every_other_character_is_refused_to_a_newcomer(value):
    allowed = all(
        c.isascii() and (c.isalnum() or unicodedata.category(c) == "Pc" or c == "-") for c in value
    )
    if allowed:
        require_shape(PERSON, value)
    else:
        with pytest.raises(BadLink, match="came other characters too"):
            require_shape(PERSON, value)


@given(st.text(st.characters(codec="utf-8"), min_size=1, max_size=200))
def test_no_message_holds_a_value(value):
    for check in (lambda: read_id(PERSON, {PERSON: value}), lambda: require_shape(PERSON, value)):
        try:
            check()
        except BadLink as refusal:
            message = str(refusal)
            assert message.startswith("PROLIFIC_PID: expected an id of at most 100 letters")
            rest = message.partition(", came ")[2]
            assert rest in (
                "a placeholder that was not filled in.",
                "other characters too.",
                f"{len(value.strip())} characters.",
            ) or rest.endswith(" characters.")


def test_an_id_that_is_too_long_says_how_long_it_is():
    assert read_id(PERSON, {PERSON: "x" * 100}) == "x" * 100
    with pytest.raises(BadLink, match=r"at most 100 letters.*came 101 characters"):
        read_id(PERSON, {PERSON: "x" * 101})


@pytest.mark.parametrize(
    "value", ["5f1e0c2a9b3d4e6f7a8b9c0d", "p1", "none-7", "idris", "nancy", "0"]
)
def test_an_id_that_only_looks_like_a_placeholder_is_one(value):
    assert read_id(PERSON, {PERSON: value}) == value


@pytest.mark.parametrize(
    "name", ["prolific_pid", "Prolific_Pid", "workerId", "participant_id", "pid", "id", "sona_id"]
)
def test_an_id_under_another_name_is_noticed(name):
    assert misnamed(["STUDY_ID", name]) == name


@given(st.text(max_size=30))
def test_no_name_but_a_known_one_is_ever_named(name):
    found = misnamed([name])
    assert found is None or (found == name and found.replace("_", "").replace("-", "").isalpha())


@pytest.mark.parametrize(
    "name", ["PROLIFIC_PID", "STUDY_ID", "preview", "utm_source", "wor\u212aerId"]
)
def test_a_name_that_is_ours_or_nobodys_is_not_taken_for_an_id(name):
    assert misnamed([name]) is None
