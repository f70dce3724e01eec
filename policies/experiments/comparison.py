"""What a comparison of frameworks is: every choice of it, and the preset of the paper's authors."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal, get_args

from policies.errors import ModelError
from policies.experiments.worlds import Test
from policies.lmdp import SEARCHES, Search
from policies.lmdp_bandit import BETA, GAMMA, MOST_MOVES, Bandit
from policies.maze_solver import Variant
from policies.measures import steps_allowed
from policies.observer import OBSERVER_BETA, Distance
from policies.polmdp import ActionSet, Formulation, Parameters

POLMDPS: Mapping[Variant, str] = MappingProxyType(
    {
        "as_printed": "polmdp",
        "proper_posterior": "polmdp_proper_posterior",
        "advantage": "polmdp_advantage",
    }
)
"""The framework that each variant of r_leg makes, in their order everywhere."""
FRAMEWORKS = (*POLMDPS.values(), "lmdp", "optimal")

PRESETS: Mapping[str, Mapping[str, object]] = MappingProxyType(
    {
        "authors": MappingProxyType(
            {
                "mode": "as_reported",
                "beta": BETA,
                "gamma": GAMMA,
                "variants": ("as_printed",),
                "formulation": "reward",
                "guard": False,
                "distance": "reported",
                "observer_beta": BETA,
                "actions": "udlr",
                "most_moves": MOST_MOVES,
            }
        )
    }
)
"""What each preset settles; `distance` is sqrt(1 - b(g)^2) there."""


@dataclass(frozen=True)
class Comparison:
    """What is run; the defaults are the paper's preset with the four moves of its comparison.

    test: which worlds are drawn; None with mazes of one's own. pairs a world, drawn by the seed,
    or None where a file lists them. simulations: L-MDP's of each step. limit_s: of L-MDP's solving
    and searching for one pair. mode: L-MDP's. beta, variants, formulation, guard: PoLMDP's;
    gamma: of all. distance, observer_beta: of the L-MDP measure's beliefs, and of L-MDP's search
    in mode `miura` (`as_reported` has its own). most_moves: within which a run arrived; None for
    4 x distance / .85, in mode `as_reported` for 502. preset: `authors` also settles what has no
    name here (authors.py).
    """

    test: Test | None = None
    pairs: int | None = 250
    simulations: int = 10_000
    limit_s: float = 60.0
    mode: str = "miura"
    seed: int = 2209
    beta: float = 0.5
    gamma: float = 0.9
    variants: tuple[Variant, ...] = ("as_printed",)
    formulation: Formulation = "reward"
    guard: bool = False
    distance: Distance | Literal["reported"] = "tv"
    observer_beta: float = OBSERVER_BETA
    actions: ActionSet = "udlr"
    most_moves: int | None = None
    preset: str | None = None

    def __post_init__(self) -> None:
        if self.most_moves is None and self.mode == "as_reported":
            object.__setattr__(self, "most_moves", MOST_MOVES)
        if self.preset:
            self._check_preset(self.preset)
        distances = (*get_args(Distance), *(["reported"] if self.preset else []))
        for name, came, allowed in (
            ("a test", [self.test] if self.test else [], get_args(Test)),
            ("mode", [self.mode], SEARCHES),
            ("variants", self.variants, POLMDPS),
            ("a distance", [self.distance], distances),
        ):
            for value in came:
                if value not in allowed:
                    raise ModelError(f"expected {name} in {', '.join(allowed)}; came {value!r}")
        for expected, number in (
            ("pair a world", self.pairs),
            ("variant", len(self.variants)),
            ("move", self.most_moves),
        ):
            if number is not None and number < 1:
                raise ModelError(f"expected at least 1 {expected}, came {number}")
        if not (math.isfinite(self.observer_beta) and self.observer_beta > 0):
            raise ModelError(
                f"expected a finite observer_beta above 0, came {self.observer_beta:g}"
            )
        if self.mode == "as_reported" and self.actions != "udlr":
            raise ModelError(f"expected actions udlr with mode as_reported, came {self.actions}")
        _ = self.search, self.polmdps  # which check the others

    @property
    def name(self) -> str:
        """The stem of its result files."""
        return self.test or "mazes"

    @property
    def polmdps(self) -> Mapping[str, Parameters]:
        """Each PoLMDP framework's parameters, in the order of POLMDPS."""
        return {
            framework: Parameters(
                self.beta, self.gamma, self.formulation, variant, self.actions, self.guard
            )
            for variant, framework in POLMDPS.items()
            if variant in self.variants
        }

    @property
    def frameworks(self) -> tuple[str, ...]:
        """Who plays every pair."""
        return (*self.polmdps, "lmdp", "optimal")

    @property
    def measured_by(self) -> Parameters:
        """Whose r_leg the PoLMDP measure sums, for all frameworks: the first variant's."""
        return next(iter(self.polmdps.values()))

    @property
    def search(self) -> Search | Bandit:
        """L-MDP's parameters."""
        effort: dict[str, Any] = {"simulations": self.simulations, "time_limit_s": self.limit_s}
        if self.mode == "as_reported":
            return Bandit(**effort)
        return Search(
            distance=self.belief_distance,
            gamma=self.gamma,
            beta=self.observer_beta,
            actions=self.actions,
            **effort,
        )

    @property
    def belief_distance(self) -> Distance:
        """The L-MDP measure's, where no preset has its own."""
        if self.distance == "reported":
            raise ModelError("expected a preset that measures sqrt(1 - b(g)^2) itself")
        return self.distance

    def _check_preset(self, preset: str) -> None:
        if preset not in PRESETS:
            raise ModelError(f"expected a preset in {', '.join(PRESETS)}; came {preset!r}")
        for name, settled in PRESETS[preset].items():
            if getattr(self, name) != settled:
                expected, came = (
                    " ".join(value) if isinstance(value, tuple) else value
                    for value in (settled, getattr(self, name))
                )
                raise ModelError(f"expected {name} {expected} with preset {preset}, came {came}")

    def moves_allowed(self, distance: float) -> int:
        """Moves within which a run of any framework counts as arrived."""
        return self.most_moves or steps_allowed(distance)


def design_comparison(
    preset: str | None = None, *, variants: Sequence[str] = (), **chosen: Any
) -> Comparison:
    """A comparison by what was chosen, on top of a preset if one is named.

    `all` among the variants stands for all. ModelError for a choice that the preset settles
    otherwise, and for what `Comparison` refuses.
    """
    if "all" in variants:
        variants = tuple(POLMDPS)
    if variants:
        in_order = (variant for variant in (*POLMDPS, *variants) if variant in variants)
        chosen["variants"] = tuple(dict.fromkeys(in_order))
    return Comparison(preset=preset, **{**PRESETS.get(preset or "", {}), **chosen})
