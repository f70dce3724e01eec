"""What people type on one line, in any script: what is text, and how long it is to them."""

from unicodedata import category

LONGEST = 60
"""Characters, as people count them, that a text may have."""

_ROOM = 16
"""Code points that a character may have on average: a flag of tags has 7, a family emoji 11."""

_REFUSED = frozenset({"Cc", "Cs", "Zl", "Zp"})
"""Controls, halves of a character, and what ends a line or a paragraph."""

_MARKS = frozenset({"Mn", "Mc", "Me", "Cf"})
"""What changes the character before it, or is not seen: accents, vowel signs, joiners."""

_JOINER = "\u200d"
_SKIN_TONES = range(0x1F3FB, 0x1F400)
_REGIONS = range(0x1F1E6, 0x1F200)
"""The letters of flags; two of them make one."""


def problem_of(text: str) -> str | None:
    """What somebody is asked to change about a text; None if nothing."""
    if any(category(character) in _REFUSED for character in text):
        return "Please write on one line, without tabs or other control characters."
    if count_characters(text) > LONGEST or len(text) > _ROOM * LONGEST:
        return f"Please use at most {LONGEST} characters."
    return None


def is_blank(text: str) -> bool:
    """Whether nothing of a text can be seen."""
    return all(category(character) in ("Zs", "Cf") for character in text)


def count_characters(text: str) -> int:
    """How many characters a text has to somebody who reads it.

    Close to the grapheme clusters of Unicode (UAX 29): marks, joined emoji, skin tones and flags
    count with what they belong to; the parts of old Korean syllables and of Indic conjuncts
    without a joiner count by themselves.
    """
    count = 0
    joined = flag_begun = False
    for character in text:
        region = ord(character) in _REGIONS
        belongs = (
            category(character) in _MARKS
            or ord(character) in _SKIN_TONES
            or joined
            or (region and flag_begun)
        )
        count += not belongs
        flag_begun = region and not flag_begun
        joined = character == _JOINER and count > 0
    return count
