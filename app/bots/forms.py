"""Reads a page's form from its HTML and fills it in, as somebody who has nothing but the page."""

from dataclasses import dataclass, field
from html.parser import HTMLParser

import numpy as np

NATIONALITIES = ("Brazilian", "British", "German", "Italian", "Polish", "Portuguese", "Spanish")
WITHHOLDING = 0.03


@dataclass
class Form:
    """Where a form goes, its hidden fields, and what it asks by name: as HTML declares it."""

    action: str
    hidden: dict[str, str] = field(default_factory=dict)
    choices: dict[str, list[str]] = field(default_factory=dict)
    numbers: dict[str, tuple[int, int]] = field(default_factory=dict)
    texts: list[str] = field(default_factory=list)
    boxes: dict[str, str] = field(default_factory=dict)

    def fill_in(self, rng: np.random.Generator) -> dict[str, str]:
        """Answers to everything that is asked, some of them withheld."""
        filled = {name: str(rng.choice(values)) for name, values in self.choices.items()}
        for name, (low, high) in self.numbers.items():
            # Most who take part in online studies are young; the tail is long.
            filled[name] = str(min(high, low + int(rng.gamma(2, 7))))
        filled |= {name: str(rng.choice(NATIONALITIES)) for name in self.texts}
        ticked = {name: value for name, value in self.boxes.items() if rng.random() < WITHHOLDING}
        withheld = {name.removesuffix("_withheld") for name in ticked}
        return {name: value for name, value in filled.items() if name not in withheld} | ticked


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.forms: list[Form] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attributes}
        if tag == "form":
            self.forms.append(Form(given.get("action", "")))
        elif tag == "input" and self.forms:
            self._input(self.forms[-1], given)

    def _input(self, form: Form, given: dict[str, str]) -> None:
        name, value = given["name"], given.get("value", "")
        match given["type"]:
            case "hidden":
                form.hidden[name] = value
            case "radio":
                form.choices.setdefault(name, []).append(value)
            case "number":
                form.numbers[name] = int(given["min"]), int(given["max"])
            case "checkbox":
                form.boxes[name] = value
            case _:
                form.texts.append(name)


def read_form(html: str) -> Form | None:
    """The first form of a page that is sent somewhere, if there is one."""
    reader = _Reader()
    reader.feed(html)
    return next((form for form in reader.forms if form.action), None)
