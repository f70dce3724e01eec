"""Simulated studies find a difference between the conditions where there is one, and only there."""

from dataclasses import replace
from pathlib import Path

import polars as pl
from scipy import stats

from app.bots.crowd import draw_bots, run
from app.bots.kinds import DEFAULT_MIX, read_mix
from app.export import export
from app.opening import open_database
from app.settings import Settings
from app.study import load_study
from policies import CONDITIONS, Pool, load_pool

MEASURES = ("correct", "prediction_time_s", "confidence")
SEEDS = range(20)


def one_pool() -> Pool:
    """The committed pool with the optimal robot in both conditions."""
    pool = load_pool()
    twins = {
        stimulus.id: replace(
            pool.stimulus(stimulus.scenario, "optimal"),
            id=stimulus.id,
            condition=stimulus.condition,
        )
        for stimulus in pool.stimuli.values()
    }
    return replace(pool, stimuli=twins)


def participants_means(folder: Path, participants: int, seed: int) -> pl.DataFrame:
    """Simulate a study and export it: each participant's condition and means of the measures."""
    settings = Settings(database_url=f"sqlite:///{folder / f'{seed}.sqlite'}", seed=seed)
    run(draw_bots(participants, seed, read_mix(DEFAULT_MIX)), settings, at_once=participants)
    study = load_study(settings)
    database = open_database(study)
    try:
        export(database, study, folder / f"{seed}", simulated=True)
    finally:
        database.close()
    trials = pl.read_parquet(folder / f"{seed}" / "trials.parquet")
    return trials.group_by("participant", "condition").agg(pl.col(MEASURES).cast(float).mean())


def p_values(means: pl.DataFrame) -> list[float]:
    """Of Welch's t test between the conditions, participants as cases, for each measure."""
    arms = [means.filter(pl.col("condition") == condition) for condition in CONDITIONS]
    return [
        float(stats.ttest_ind(*(arm[name].to_numpy() for arm in arms), equal_var=False).pvalue)
        for name in MEASURES
    ]


def test_one_pool_for_both_conditions_shows_no_difference_over_20_seeds(tmp_path, monkeypatch):
    monkeypatch.setattr("app.study.load_pool", one_pool)
    studies = [participants_means(tmp_path, 12, seed) for seed in SEEDS]
    found = sum(p < 0.05 for means in studies for p in p_values(means))
    assert found <= stats.binom.ppf(0.999, len(SEEDS) * len(MEASURES), 0.05)
    assert min(p_values(pl.concat(studies))) > 0.05


def test_the_studys_own_pool_shows_that_legible_robots_are_understood_sooner(tmp_path):
    means = participants_means(tmp_path, 48, seed=1)
    times = means.group_by("condition").agg(pl.col("prediction_time_s").mean())
    mean_s = dict(times.iter_rows())
    assert mean_s["polmdp"] < mean_s["optimal"]
    assert p_values(means)[MEASURES.index("prediction_time_s")] < 0.01
