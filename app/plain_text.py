"""What people type on one line, in any script: what is text, and how long it is to them."""

from unicodedata import category

LONGEST = 60
"""Characters, as people count them, that a text may have."""

_ROOM = 16
"""Code points that a character may have on average: a flag of tags has 7, a family emoji 11."""

_REFUSED = frozenset({"Cc", "Cs", "Zl", "Zp"})
"""Controls, halves of a character, and what ends a line or a paragraph."""


def problem_of(text: str) -> str | None:
    """What somebody is asked to change about a text; None if nothing."""
    if any(category(character) in _REFUSED for character in text):
        return "Please write on one line, without tabs or other control characters."
    if len(text) > LONGEST and (len(text) > _ROOM * LONGEST or count_characters(text) > LONGEST):
        return f"Please use at most {LONGEST} characters."
    return None


def is_blank(text: str) -> bool:
    """Whether nothing of a text can be seen."""
    return all(category(character) in ("Zs", "Cf") for character in text)


def count_characters(text: str) -> int:
    """How many characters a text has to somebody who reads it: Unicode's grapheme clusters."""
    import regex  # hardly any text is so long that it must be counted

    return len(regex.findall(r"\X", text))
