import numpy as np
import polars as pl
import pytest

from policies.experiments.tables import make_tables

WORLDS = (("2x2", 4, 2), ("3x3", 9, 3))


def made_up_rows(pairs=12, seed=0):
    """Rows as `read_rows` gives them, with known differences between the frameworks.

    On the PoLMDP measure `polmdp` is ahead of `lmdp` by 1 with noise, on the L-MDP measure they
    differ by noise alone; `lmdp` times out in pair 0 of the larger world and is lost in pair 1.
    """
    rng = np.random.default_rng(seed)
    rows = []
    for world, states, goals in WORLDS:
        for pair in range(pairs):
            base = rng.normal()
            for framework in ("lmdp", "optimal", "polmdp"):
                lmdp = framework == "lmdp"
                timed_out = lmdp and states == 9 and pair == 0
                arrived = not (lmdp and states == 9 and pair < 2)
                time_s = {"lmdp": 10.0 + pair, "optimal": 0.01, "polmdp": 0.1}[framework]
                rows.append(
                    {
                        "world": world,
                        "states": states,
                        "goals": goals,
                        "pair": pair,
                        "framework": framework,
                        "polmdp": base + (framework == "polmdp") + rng.normal(scale=0.1),
                        "polmdp_per_step": base + rng.normal(),
                        "lmdp": base + rng.normal(),
                        "planning_s": time_s / 2,
                        "time_s": time_s,
                        "arrived": arrived,
                        "timed_out": timed_out,
                        "failed": not arrived,
                    }
                )
    return pl.DataFrame(rows)


@pytest.fixture(scope="session")
def rows():
    """A run's rows with known differences."""
    return made_up_rows()


@pytest.fixture(scope="session")
def tables(rows):
    """The tables of these rows."""
    return make_tables(rows, seed=1)
