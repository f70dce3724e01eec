"""The plan of an analysis: what is compared, by which tests, without whom.

It is written down as TOML before the data are looked at; `plan.toml` beside this file is the
default. Two plans that say the same have the same hash, however their files are written.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from .arms import Arm, Arms
from .exclusions import RULES, Exclusion
from .toml_file import Section, content_sha256, read_toml

DEFAULT_FILE = Path(__file__).with_suffix(".toml")

PRIMARY_TESTS = ("two_way_difference", "two_way_auc")
"""Tests that hold their level with trials of one participant, and of one scenario, alike."""

TIME_COLUMNS = {"penalised": "prediction_time_s", "stop": "stop_time_s"}
"""The column of the trials that each definition of time takes."""

COVARIATES = ("trial_order", "age", "device")
"""What the mixed models and the Cox regression can be adjusted for; primary tests never are."""

_HYPOTHESES = {"correct": "H1", "time": "H2", "confidence": "H2"}
"""What the plan calls the measures, and the hypothesis each one is for."""

SMALLEST_EFFECTS = {"share": 0.05, "auc": 0.05}
"""Smallest effects of interest where the plan names no other, by the key of the plan."""

_LARGEST_EFFECTS = {"share": 1.0, "auc": 0.5, "s": math.inf, "scale_points": math.inf}
"""By the keys of `smallest_effect`: effects, and distances of an AUC from a half, are less."""

_KEYS = (
    "alpha",
    "time",
    "holm_family",
    "choices",
    "trials_per_participant",
    "seed",
    "treatment",
    "reference",
    "primary",
    "smallest_effect",
    "exclusions",
    "covariates",
)


@dataclass(frozen=True)
class Primary:
    """The test on which a hypothesis is judged; `measure` is a column of the trials."""

    hypothesis: str
    measure: str
    test: str


@dataclass(frozen=True)
class Plan:
    """A checked plan.

    `alpha` is two-sided; `time` a key of `TIME_COLUMNS`; `primary` has one test for each measure;
    `holm_family` names, by their columns, the measures whose primary p values are corrected
    together; `choices` counts the areas to guess among; `smallest_effects` are the least that are
    of interest, by `share`, `auc` (from a half), `s` and `scale_points`, none where the plan names
    none; `covariates` are some of `COVARIATES`; `file` is where it was read from.
    """

    arms: Arms
    alpha: float
    time: str
    primary: tuple[Primary, ...]
    holm_family: tuple[str, ...]
    choices: int
    trials_per_participant: int
    exclusions: tuple[Exclusion, ...]
    smallest_effects: Mapping[str, float]
    covariates: tuple[str, ...]
    seed: int
    file: str

    @property
    def chance_level(self) -> float:
        """Share of correct guesses, 0 to 1, of whoever guesses blindly."""
        return 1 / self.choices

    @property
    def content(self) -> dict[str, Any]:
        """What the plan says, under the keys of its file.

        Keys that came later are left out where they say what the default says, so that plans
        registered before keep their hash.
        """
        said = {
            "alpha": self.alpha,
            "time": self.time,
            "holm_family": [_in_plan(measure) for measure in self.holm_family],
            "choices": self.choices,
            "trials_per_participant": self.trials_per_participant,
            "seed": self.seed,
            "treatment": vars(self.arms.treatment),
            "reference": vars(self.arms.reference),
            "primary": {_in_plan(each.measure): each.test for each in self.primary},
            "exclusions": [{"rule": each.rule, **each.parameters} for each in self.exclusions],
        }
        if self.smallest_effects != SMALLEST_EFFECTS:
            said["smallest_effect"] = dict(self.smallest_effects)
        if self.covariates:
            said["covariates"] = list(self.covariates)
        return said

    @property
    def sha256(self) -> str:
        """Hash of the content, in hexadecimal."""
        return content_sha256(self.content)


@cache
def default_plan() -> Plan:
    """Return the plan that ships with the analysis."""
    return _plan("default plan", read_toml(DEFAULT_FILE))


def read_plan(path: Path) -> Plan:
    """Read a plan; what it leaves out is as in the default plan, tables as a whole.

    Only of `smallest_effect` each key stands for itself.
    TomlError names file and key of the first thing that cannot be followed.
    """
    return _plan(path.name, read_toml(DEFAULT_FILE) | read_toml(path))


def _plan(file: str, content: Mapping[str, Any]) -> Plan:
    plan = Section(file, content)
    plan.allow(_KEYS)
    time = plan.choice("time", TIME_COLUMNS)
    return Plan(
        arms=_arms(plan),
        alpha=_alpha(plan),
        time=time,
        primary=_primary(plan, time),
        holm_family=_family(plan, time),
        choices=plan.whole("choices", least=2),
        trials_per_participant=plan.whole("trials_per_participant", least=1),
        exclusions=tuple(_exclusion(each) for each in plan.sections("exclusions")),
        smallest_effects=_smallest_effects(plan.section("smallest_effect")),
        covariates=_covariates(plan),
        seed=plan.whole("seed"),
        file=file,
    )


def _arms(plan: Section) -> Arms:
    arms = Arms(_arm(plan.section("treatment")), _arm(plan.section("reference")))
    for key, (treatment, reference) in {
        "condition": arms.names,
        "label": tuple(arms.labels.values()),
    }.items():
        if treatment == reference:
            raise plan.section("reference").wrong(
                key, "another one than the treatment's", reference
            )
    return arms


def _arm(section: Section) -> Arm:
    section.allow(("condition", "label"))
    condition = section.text("condition")
    return Arm(condition, section.text("label") if "label" in section.content else condition)


def _alpha(plan: Section) -> float:
    alpha = plan.number("alpha")
    # from .5 on there is no interval of 1 - 2 alpha
    if not 0 < alpha < 0.5:
        raise plan.wrong("alpha", "a number above 0 and below 0.5", alpha)
    return alpha


def _primary(plan: Section, time: str) -> tuple[Primary, ...]:
    section = plan.section("primary")
    section.allow(_HYPOTHESES)
    return tuple(
        Primary(hypothesis, _column(measure, time), section.choice(measure, PRIMARY_TESTS))
        for measure, hypothesis in _HYPOTHESES.items()
    )


def _family(plan: Section, time: str) -> tuple[str, ...]:
    family = plan.content["holm_family"]
    chosen = [measure for measure in _HYPOTHESES if isinstance(family, list) and measure in family]
    if not isinstance(family, list) or len(chosen) < len(family):
        raise plan.wrong("holm_family", f"a list of some of {', '.join(_HYPOTHESES)}", family)
    return tuple(_column(measure, time) for measure in chosen)


def _smallest_effects(section: Section) -> dict[str, float]:
    section.allow(_LARGEST_EFFECTS)
    named = {key: section.number(key) for key in _LARGEST_EFFECTS if key in section.content}
    for key, effect in named.items():
        largest = _LARGEST_EFFECTS[key]
        if not 0 < effect < largest:
            below = "" if largest == math.inf else f" and below {largest:g}"
            raise section.wrong(key, f"a number above 0{below}", section.content[key])
    return {**SMALLEST_EFFECTS, **named}


def _covariates(plan: Section) -> tuple[str, ...]:
    named = plan.content["covariates"]
    chosen = [each for each in COVARIATES if isinstance(named, list) and each in named]
    if not isinstance(named, list) or len(chosen) < len(named):
        raise plan.wrong("covariates", f"a list of some of {', '.join(COVARIATES)}", named)
    return tuple(chosen)


def _exclusion(section: Section) -> Exclusion:
    name = section.choice("rule", RULES)
    parameters = RULES[name].parameters
    section.allow(("rule", *parameters))
    return Exclusion(
        name,
        {
            key: section.whole(key) if kind is int else section.number(key)
            for key, kind in parameters.items()
        },
    )


def _column(measure: str, time: str) -> str:
    return TIME_COLUMNS[time] if measure == "time" else measure


def _in_plan(column: str) -> str:
    return "time" if column in TIME_COLUMNS.values() else column
