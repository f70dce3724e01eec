"""World regions from nationalities as people write them, by the list in nationalities.csv.

The list has a row for each country and territory that people may name, with its codes of ISO 3166,
what it and its people are called in English and at home, and its region; and a row for each region
itself. The regions are those of UN M49, with the Americas as M49 divides them: Northern America,
Latin America and the Caribbean.
"""

from __future__ import annotations

import csv
import re
import unicodedata
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

FILE = Path(__file__).with_name("nationalities.csv")

SEVERAL = "several"
NOT_RECOGNISED = "not recognised"
NOT_TOLD = "not told"

_WITHHELD = "prefer not to say"
_PARTS = re.compile(r"[/,;&+|()]")
_AND = ("and", "und", "y", "e", "et", "og", "och", "or")
_OF = ("i", "im", "am", "a", "an", "the", "of", "from", "national", "nationality", "citizen")
_FILLERS = frozenset((*_AND, *_OF, "citizenship", "passport", "dual", "half", "white", "black"))
"""Words that name no place; "and" in six languages, since names are parted by blanks as well."""
_CODES = ("alpha_2", "alpha_3")
AMBIGUOUS_CODES = frozenset(("na", "no", "sa"))
"""Namibia or no answer, Norway or no answer, Saudi Arabia or South Africa."""
_WHOLE_LETTERS = str.maketrans(
    {"ł": "l", "ø": "o", "đ": "d", "ð": "d", "ı": "i", "æ": "ae", "þ": "th", "ə": "e"}
)
"""Letters that are no letter with an accent, as whoever lacks them writes them."""


@cache
def world_region(nationality: str | None) -> str:
    """Return the region of what somebody told, `SEVERAL` for more than one, else `NOT_...`.

    Every word must be understood: what is understood in part only is not recognised. Codes count
    where nothing stands beside them.
    """
    if nationality is None or nationality.casefold().strip() in ("", _WITHHELD):
        return NOT_TOLD
    words = [word for part in _PARTS.split(nationality) for word in _spelled_out(_words(part))]
    regions = set(_regions(words))
    if not regions or NOT_RECOGNISED in regions:
        return NOT_RECOGNISED
    return SEVERAL if len(regions) > 1 else regions.pop()


def places() -> Iterator[Mapping[str, str]]:
    """Return the rows of the list: place, alpha_2, alpha_3, region, names (parted by ;)."""
    with FILE.open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


def _spelled_out(words: list[str]) -> list[str]:
    """Return the place that the words are the code of, else the words."""
    code = " ".join(words)
    return words if code in _regions_by_name() else _words(_places_by_code().get(code, code))


def _regions(words: list[str]) -> Iterator[str]:
    """Return the region of each place named, taking as many words for one as make a name."""
    names = _regions_by_name()
    while words:
        length = next((n for n in range(len(words), 0, -1) if " ".join(words[:n]) in names), 1)
        yield names.get(" ".join(words[:length]), NOT_RECOGNISED)
        words = words[length:]


@cache
def _regions_by_name() -> dict[str, str]:
    return {
        " ".join(_words(name)): row["region"]
        for row in places()
        for name in (row["place"], *row["names"].split(";"))
        if name
    }


@cache
def _places_by_code() -> dict[str, str]:
    codes = ((row[key].casefold(), row["place"]) for row in places() for key in _CODES)
    return {code: place for code, place in codes if code and code not in AMBIGUOUS_CODES}


def _words(text: str) -> list[str]:
    """Return what counts of a text: words without case, accents, points and fillers."""
    plain = text.casefold().translate(_WHOLE_LETTERS)
    letters = (each for each in unicodedata.normalize("NFKD", plain))
    kept = "".join(each for each in letters if not unicodedata.combining(each))
    # U.S.A. and People's lose their signs, South-African and U S are two words
    joined = re.sub(r"[.'’ʻ`]", "", kept)
    return [word for word in re.split(r"[\W_]+", joined) if word and word not in _FILLERS]
