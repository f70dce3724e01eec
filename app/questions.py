"""What participants are asked about themselves and to see that they understood the game."""

from collections.abc import Mapping
from dataclasses import dataclass

from app.plain_text import is_blank, problem_of

WITHHELD = "prefer not to say"


@dataclass(frozen=True)
class Option:
    """One answer to choose: the value that is stored and what is shown for it."""

    value: str
    label: str


def _options(*labels: str) -> tuple[Option, ...]:
    return tuple(Option(label.lower(), label) for label in labels)


@dataclass(frozen=True)
class Question:
    """A question; `kind` is number, choice or text, `minimum` and `maximum` bound a number."""

    name: str
    label: str
    kind: str
    options: tuple[Option, ...] = ()
    minimum: int | None = None
    maximum: int | None = None
    hint: str = ""
    required_message: str = "Please answer, or choose “prefer not to say”."

    def answer(self, form: Mapping[str, str]) -> str | int | None:
        """The answer in a form; None for a number withheld; ValueError says what was expected."""
        given = form.get(self.name, "").strip()
        answered = not is_blank(given)
        withheld = bool(form.get(f"{self.name}_withheld"))
        if answered and withheld and given != WITHHELD:
            raise ValueError("Please either answer or choose “prefer not to say”, not both.")
        if withheld or given == WITHHELD:
            return None if self.kind == "number" else WITHHELD
        if not answered:
            raise ValueError(self.required_message)
        if self.kind == "number":
            return self._number(given)
        if self.kind == "choice" and given not in {option.value for option in self.options}:
            raise ValueError("Please choose one of the answers shown.")
        if problem := problem_of(given):
            raise ValueError(problem)
        return given

    def _number(self, given: str) -> int:
        message = f"Please enter a whole number from {self.minimum} to {self.maximum}."
        if not (given.isascii() and given.isdigit() and len(given) < 10):
            raise ValueError(message)
        number = int(given)
        if (self.minimum is not None and number < self.minimum) or (
            self.maximum is not None and number > self.maximum
        ):
            raise ValueError(message)
        return number


_WITHHELD = Option(WITHHELD, "Prefer not to say")

ABOUT_YOU = (
    Question("age", "How old are you?", "number", minimum=18, maximum=120, hint="In years"),
    Question(
        "gender",
        "What is your gender?",
        "choice",
        (*_options("Woman", "Man", "Non-binary", "Another"), _WITHHELD),
    ),
    Question("nationality", "What is your nationality?", "text", hint="For example: Portuguese"),
    Question(
        "education",
        "What is the highest level of education you have completed?",
        "choice",
        (
            *_options(
                "Less than secondary school",
                "Secondary school",
                "Vocational training",
                "Bachelor's degree",
                "Master's degree",
                "Doctorate",
            ),
            _WITHHELD,
        ),
    ),
    Question(
        "occupation",
        "What is your occupation?",
        "choice",
        (
            *_options(
                "Student",
                "Employed",
                "Self-employed",
                "Looking for work",
                "Caring for home or family",
                "Retired",
                "Another",
            ),
            _WITHHELD,
        ),
    ),
    Question(
        "robot_familiarity",
        "How familiar are you with robots?",
        "choice",
        (
            *_options(
                "Not at all",
                "I have seen some",
                "I have used one",
                "I use them often",
                "I build or program them",
            ),
            _WITHHELD,
        ),
    ),
)

CONTROL = Question(
    "answer",
    "When should you press Stop?",
    "choice",
    (
        Option("end", "When the robot has reached an area"),
        Option("know", "As soon as I think I know where the robot is going"),
        Option("turn", "Whenever the robot changes direction"),
    ),
)
CONTROL_RIGHT = "know"


def answers(
    questions: tuple[Question, ...], form: Mapping[str, str]
) -> tuple[dict[str, str | int | None], dict[str, str]]:
    """The answers by question name, and what is wrong with the others."""
    good: dict[str, str | int | None] = {}
    wrong: dict[str, str] = {}
    for question in questions:
        try:
            good[question.name] = question.answer(form)
        except ValueError as error:
            wrong[question.name] = str(error)
    return good, wrong
