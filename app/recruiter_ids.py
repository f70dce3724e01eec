"""The recruiter's ids in an invitation link: what is one, what is none, and what is refused.

Messages name parameters and never hold a value: an id is nobody's business but the recruiter's.
"""

import logging
import re
import unicodedata
from collections.abc import Iterable, Mapping

from app.errors import BadLink

log = logging.getLogger("goalguess")

PERSON = "PROLIFIC_PID"
PARAMETERS = (PERSON, "STUDY_ID", "SESSION_ID")
"""The parameters of a link that hold ids: of whom, of which study, of which visit to it."""

LONGEST = 100

EXPECTED = (
    f"an id of at most {LONGEST} letters (A to Z), digits, hyphens and underscores, which the "
    "recruiting site fills in"
)

_SHAPE = re.compile(r"[A-Za-z0-9_-]+")

_PERSONS = frozenset(
    {
        "externalid",
        "id",
        "panelistid",
        "participant",
        "participantid",
        "pid",
        "prolificid",
        "prolificpid",
        "respondentid",
        "sonaid",
        "subjectid",
        "surveycode",
        "uid",
        "userid",
        "workerid",
    }
)
"""What recruiters and programs call the person's id, as `_plain` writes it."""

_warned_of: set[str] = set()

_NAME = re.compile(r"[A-Za-z_-]{1,20}")

_NAMES = _PERSONS | {"studyid", "sessionid"}

_NOTHING = frozenset({"", "null", "undefined", "none", "nan", "nil"})
"""What programs write where they have no value, as `_plain` writes it."""

_UNFILLED = re.compile(r"\{\{|\}\}|\$\{|\{.*\}|\[.*\]|<.*>|%.*%", re.DOTALL)
"""Marks of a place in a link where the recruiter's site was to write something."""


def read_id(name: str, values: Mapping[str, str]) -> str | None:
    """The id in a parameter, without blanks around it; None where there is none.

    BadLink: one that is too long, or a placeholder, which everybody with that link would share.
    """
    value = trimmed(values.get(name, ""))
    if len(value) > LONGEST:
        raise BadLink(f"{name}: expected {EXPECTED}, came {len(value)} characters.")
    if value and is_placeholder(value):
        raise not_filled_in(name)
    return value or None


def is_unfilled(name: str, values: Mapping[str, str]) -> bool:
    """Whether a parameter holds a placeholder."""
    value = trimmed(values.get(name, ""))
    return 0 < len(value) <= LONGEST and is_placeholder(value)


def not_filled_in(name: str) -> BadLink:
    """What is wrong with a link that has a placeholder in a parameter."""
    return BadLink(f"{name}: expected {EXPECTED}, came a placeholder that was not filled in.")


def require_shape(name: str, value: str | None) -> None:
    """BadLink unless an id is one that a newcomer can have; who is stored may have another."""
    if value is not None and not _SHAPE.fullmatch(value):
        raise BadLink(f"{name}: expected {EXPECTED}, came other characters too.")


def trimmed(value: str) -> str:
    """A value without the blanks around it, those that cannot be seen included."""
    kept = [at for at, character in enumerate(value) if not _is_blank(character)]
    return value[kept[0] : kept[-1] + 1] if kept else ""


def is_placeholder(value: str) -> bool:
    """Whether a trimmed value stands for an id that was never filled in."""
    return _UNFILLED.search(value) is not None or _plain(value) in _NOTHING | _NAMES


def misnamed(names: Iterable[str]) -> str | None:
    """The parameter, of those in a link, that looks like the person's id under another name."""
    return next((name for name in names if name != PERSON and _is_other_name(name)), None)


def lacking_id(named: str | None) -> BadLink:
    """What is wrong with a link without the person's id; `named` as `misnamed` found it."""
    came = f"{named} instead" if named else "a link without it"
    return BadLink(f"{PERSON}: expected in the link, with {EXPECTED}, came {came}.")


def warn_of(named: str) -> None:
    """Log, once for each name, that links carry the person's id under another one."""
    if _plain(named) in _warned_of:
        return
    _warned_of.add(_plain(named))
    log.warning(
        "Invitation links have a parameter %s where %s is expected: whoever comes by them has no "
        "recruiter's id, so nobody can tell whom to pay.",
        named,
        PERSON,
    )


def _is_other_name(name: str) -> bool:
    # Names go into messages: letters alone, so that nothing else can hide in one.
    return _NAME.fullmatch(name) is not None and _plain(name) in _PERSONS


def _plain(text: str) -> str:
    """A text's letters and digits, in lower case."""
    return "".join(filter(str.isalnum, text)).lower()


def _is_blank(character: str) -> bool:
    return character.isspace() or unicodedata.category(character) in ("Cc", "Cf")
