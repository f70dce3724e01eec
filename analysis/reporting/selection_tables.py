"""The primary results on selections of participants: by exclusion rule, and by device."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from ..conclusions import Conclusion
from ..devices import Devices
from ..exclusion_variants import ExclusionVariant
from ..plan import Plan
from ..selections import MOST_TRIALS, Selection
from ..statistics.result import TestResult
from ..warning_texts import WARNINGS
from ..wording import capital, format_p
from .answers import WORDS
from .document import Grid, Heading, Items, Paragraph, Part
from .effects import beyond, effect_of, interval

_TOO_MANY = f"Left out, since it takes too long above {MOST_TRIALS:,} trials."
_NO_VALUE = "an arm\nhas none"


def exclusion_parts(
    variants: Sequence[ExclusionVariant] | None, conclusions: Sequence[Conclusion], plan: Plan
) -> list[Part]:
    """Return the primary results with and without each exclusion rule; None: too many trials."""
    heading = Heading("With and without each exclusion rule", 3)
    if variants is None:
        return [heading, Paragraph(_TOO_MANY)]
    selections = [(_name(each, plan), each.selection) for each in variants if each.selection]
    left_out = [f"{each.left_out:,}" for each in variants if each.selection]
    rows = tuple(
        (name, out, f"{each.trials:,}", *(_cell(test, plan) for test in each.tests.values()))
        for (name, each), out in zip(selections, left_out, strict=True)
    )
    cannot = [
        f"{capital(_name(each, plan))}: cannot be applied, {each.cannot}."
        for each in variants
        if each.cannot
    ]
    return [
        heading,
        Paragraph(
            "Each rule of the plan is left out alone; each rule that the plan does not use is "
            "applied in addition, with the parameters that its row says. All conclusions rest on "
            "the first row. In brackets: 95 % intervals; p is before Holm's correction."
        ),
        Grid(
            "Primary results by exclusion rule",
            ("", "participants left out", "trials", *_measures(conclusions)),
            rows,
        ),
        *_items([*_notes(selections, conclusions), *cannot]),
    ]


def device_parts(
    devices: Devices | None, conclusions: Sequence[Conclusion], plan: Plan
) -> list[Part]:
    """Return the primary results by device; None: too many trials."""
    heading = Heading("By device", 3)
    if devices is None:
        return [heading, Paragraph(_TOO_MANY)]
    selections = [(f"{each.trait}: {each.group}", each.selection) for each in devices.groups]
    rows = tuple(
        (
            name,
            *(f"{each.participants[arm]:,}" for arm in plan.arms.names),
            *(_cell(test) for test in each.tests.values()),
        )
        for name, each in selections
    )
    left_out = [f"{capital(trait)}: left out, {why}." for trait, why in devices.left_out.items()]
    header = ("", *(f"n, {label}" for label in plan.arms.labels.values()), *_measures(conclusions))
    described: list[Part] = [
        Paragraph(
            "These numbers describe; nothing here tests whether devices differ. Nobody was dealt a "
            "device, and small groups differ by chance alone. n counts participants; in brackets "
            "stand 95 % intervals."
        ),
        Grid("Primary results within each kind of device", header, rows),
    ]
    return [
        heading,
        *(described if rows else []),
        *_items([*_notes(selections, conclusions), *left_out]),
    ]


def _name(variant: ExclusionVariant, plan: Plan) -> str:
    rule = variant.exclusion
    match variant.change:
        case "as_planned":
            return "all rules as planned" if plan.exclusions else "as planned: no exclusions"
        case "no_rule":
            return "no exclusions"
        case "without_rule" | "with_rule" as change:
            assert rule is not None
            return f"{change.removesuffix('_rule')} {rule.rule}: {rule.reason}"


def _measures(conclusions: Sequence[Conclusion]) -> Iterator[str]:
    """Name each measure with the unit of its primary test."""
    for each in conclusions:
        effect = effect_of(each.primary)
        yield f"{WORDS[each.measure].name}, {effect.unit or effect.name}"


def _cell(test: TestResult | None, tested_by: Plan | None = None) -> str:
    """Write estimate and interval, and the p that is wanted if `tested_by` says at which alpha."""
    if test is None:
        return _NO_VALUE
    if test.estimate is None:
        return "not defined"
    bounds = "no interval" if test.low is None else interval(test)
    told = f"{effect_of(test).write(test.estimate)}\n({bounds})"
    if tested_by is None or test.p is None:
        return told
    return f"{told},\n{format_p(test.p, alpha=tested_by.alpha)}"


def _notes(
    selections: Iterable[tuple[str, Selection]], conclusions: Sequence[Conclusion]
) -> list[str]:
    """Say what is to be minded of single rows, but not what is said of the whole study."""
    said = {each.measure: _warned(each.primary) for each in conclusions}
    rows: dict[str, list[str]] = {}
    for name, selection in selections:
        warned: dict[str, list[str]] = {}
        for measure, test in selection.tests.items():
            for text in () if test is None else _warned(test):
                if text not in said[measure]:
                    warned.setdefault(text, []).append(WORDS[measure].name)
        for text, measures in warned.items():
            of_all = len(measures) == len(selection.tests)
            rows.setdefault(text, []).append(
                name if of_all else f"{name}, {' and '.join(measures)}"
            )
    return [f"{capital(text)} ({'; '.join(names)})." for text, names in rows.items()]


def _warned(test: TestResult) -> tuple[str, ...]:
    return tuple(filter(None, (*(WARNINGS[code] for code in test.warnings), beyond(test))))


def _items(texts: Sequence[str]) -> list[Part]:
    return [Items(tuple(texts))] if texts else []
