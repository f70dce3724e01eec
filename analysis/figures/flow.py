"""The flow of participants as CONSORT draws it: a box a step, and beside it who left and why."""

from __future__ import annotations

from typing import TYPE_CHECKING

import polars as pl

from ..wording import capital
from .drawn import Drawn
from .style import INK, Labels, panel
from .text import SMALL_POINTS, in_sentence, wrapped

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..flow import Flow, Group, Step

_LINE_INCHES = 0.17
_PADDING_INCHES = 0.16
_GAP_INCHES = 0.13
_MAIN, _ASIDE = (0.0, 0.52), (0.57, 1.0)
_GLUE = "\N{NO-BREAK SPACE}"
_MAIN_POINTS, _ASIDE_POINTS = 162, 130


def figure_flow(flow: Flow, labels: Labels) -> Drawn:
    """Show how many participants came to each step, in all and per arm, and why others did not.

    Steps run down the left; those who left stand to the right, between their step and the next.
    """
    boxes = [(_step(step, labels), _those_who_left(step)) for step in flow.steps]
    total = sum(_height(text) for pair in boxes for text in pair)
    total += _GAP_INCHES * (2 * len(boxes) - 2)
    treatment, reference = map(in_sentence, labels)
    note = f"Participants. In brackets: {treatment} + {reference}."
    with panel(total + 0.6, note) as (figure, axes):
        axes.set(xlim=(0, 1), ylim=(-total, 0))
        axes.axis("off")
        top = 0.0
        for number, (reached, left) in enumerate(boxes):
            bottom = _box(axes, _MAIN, top, reached)
            if number == len(boxes) - 1:
                break
            top = bottom - 2 * _GAP_INCHES - _height(left)
            _arrow(axes, (sum(_MAIN) / 2, bottom), (sum(_MAIN) / 2, top))
            if left:
                middle = (bottom + top) / 2
                _arrow(axes, (sum(_MAIN) / 2, middle), (_ASIDE[0], middle))
                _box(axes, _ASIDE, bottom - _GAP_INCHES, left)
    return Drawn(figure, _data(flow), _alt(flow, labels))


def _step(step: Step, labels: Labels) -> str:
    """Write those who came to a step, with a line an arm where arms are known."""
    lines = [_lines(f"{capital(step.reached.what)}: {step.reached.total:,}", _MAIN_POINTS)]
    if step.reached.arms is not None:
        for label, count in zip(labels, step.reached.arms.values(), strict=True):
            lines.append(_lines(f"{in_sentence(label)}: {count:,}", _MAIN_POINTS))
    lines += [_lines(f"of these {_counted(group)}", _MAIN_POINTS) for group in step.of_these]
    return "\n".join(lines)


def _those_who_left(step: Step) -> str:
    return "\n".join(_lines(capital(_counted(group)), _ASIDE_POINTS) for group in step.left)


def _lines(text: str, width: float) -> str:
    """Break a text that must not lose its count at the end, nor have it alone in a line."""
    return wrapped(text.replace(" + ", f"{_GLUE}+{_GLUE}").replace(": ", f":{_GLUE}"), width, 8)


def _counted(group: Group) -> str:
    text = f"{group.what}: {group.total:,}"
    if group.arms is None:
        return text
    return f"{text} ({' + '.join(f'{count:,}' for count in group.arms.values())})"


def _height(text: str) -> float:
    """Return the height in inches of a box with this text, 0 if there is none."""
    return _PADDING_INCHES + _LINE_INCHES * (text.count("\n") + 1) if text else 0.0


def _box(axes: Axes, sides: tuple[float, float], top: float, text: str) -> float:
    """Draw a box and return where it ends."""
    from matplotlib.patches import Rectangle

    left, right = sides
    height = _height(text)
    axes.add_patch(
        Rectangle((left, top - height), right - left, height, facecolor="white", edgecolor=INK)
    )
    axes.text(left + 0.02, top - height / 2, text, va="center", fontsize=SMALL_POINTS)
    return top - height


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    axes.annotate(
        "", end, start, arrowprops={"arrowstyle": "-|>", "color": INK, "shrinkA": 0, "shrinkB": 0}
    )


def _data(flow: Flow) -> pl.DataFrame:
    rows = [
        (
            number,
            kind,
            group.what,
            group.total,
            *(group.arms.values() if group.arms else (None, None)),
        )
        for number, step in enumerate(flow.steps, start=1)
        for kind, groups in (
            ("reached", (step.reached,)),
            ("of these", step.of_these),
            ("left", step.left),
        )
        for group in groups
    ]
    schema = {
        "step": pl.Int64,
        "kind": pl.String,
        "what": pl.String,
        "participants": pl.Int64,
        "treatment": pl.Int64,
        "reference": pl.Int64,
    }
    return pl.DataFrame(rows, schema, orient="row")


def _alt(flow: Flow, labels: Labels) -> str:
    steps = []
    for step in flow.steps:
        steps.append(_counted(step.reached))
        if step.left:
            steps.append(f"of whom left: {', '.join(map(_counted, step.left))}")
    return (
        f"Flow of participants, in brackets {labels[0]} + {labels[1]}: "
        f"{'; '.join(steps).replace('; of whom', ', of whom')}."
    )
