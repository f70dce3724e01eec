"""The observer: a noisy Bayesian who has nothing but what the page was sent."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.bots.observer import (
    Observer,
    guess_at_random,
    length_ms,
    speed,
    watch_to_the_end,
)
from app.settings import Settings
from app.study import load_study
from policies import OBSERVER_BETA, load_pool, steps_until_sure

POOL = load_pool()
STUDY = load_study(Settings())
STIMULI = list(POOL.stimuli.values())
NOISELESS = Observer(beta=OBSERVER_BETA, threshold=0.8, noise=0, lapse=0, bias=0)

stimuli = st.sampled_from(STIMULI)
seeds = st.integers(0, 2**32)


def playback_of(stimulus):
    """What the page receives, as it receives it: through JSON."""
    picture = {**STUDY.picture(stimulus), "step_ms": 1000, "lead_in_ms": 1500}
    return json.loads(json.dumps(picture))


def predicted_steps():
    """Mean steps until P > .8 in each condition, as the pool's manifest predicts them."""
    from importlib.resources import files

    manifest = json.loads(files("policies").joinpath("stimuli/manifest.json").read_text())
    return manifest["prediction"]["mean_steps_until_sure"]


@pytest.mark.parametrize("condition", ["polmdp", "optimal"])
def test_without_noise_it_believes_what_the_pools_manifest_predicts(condition):
    steps = [
        steps_until_sure(NOISELESS.beliefs(playback_of(s)), "ABCDEF".index(s.goal))
        for s in STIMULI
        if s.condition == condition
    ]
    assert np.mean(steps) == pytest.approx(predicted_steps()[condition], abs=1e-3)


@given(stimuli, seeds)
def test_it_stops_within_the_motion_and_answers_with_what_the_page_offers(stimulus, seed):
    rng = np.random.default_rng(seed)
    playback = playback_of(stimulus)
    judges = (Observer.draw(rng).judge, guess_at_random, speed, watch_to_the_end)
    for judged in (judge(playback, rng) for judge in judges):
        assert 0 < judged.stop_time_ms <= length_ms(playback)
        assert judged.reached_end == (judged.stop_time_ms == length_ms(playback))
        assert judged.guess in {area["letter"] for area in playback["areas"]}
        assert judged.confidence in range(1, 8)
        assert 0 < judged.guess_latency_ms <= judged.confidence_latency_ms


@given(stimuli, seeds)
def test_areas_under_other_letters_are_guessed_under_those_letters(stimulus, seed):
    playback = playback_of(stimulus)
    other = dict(zip("ABCDEF", "BCDEFA", strict=True))
    areas = [{**area, "letter": other[area["letter"]]} for area in playback["areas"]]
    here = NOISELESS.judge(playback, np.random.default_rng(seed))
    there = NOISELESS.judge({**playback, "areas": areas}, np.random.default_rng(seed))
    assert there.guess == other[here.guess]
    assert there.stop_time_ms == here.stop_time_ms


@given(stimuli, seeds)
def test_the_future_of_the_path_does_not_change_what_is_believed_now(stimulus, seed):
    playback = playback_of(stimulus)
    seen = int(np.random.default_rng(seed).integers(1, len(playback["path"])))
    cut = {**playback, "path": playback["path"][: seen + 1]}
    believed = NOISELESS.beliefs(playback)[: seen + 1]
    np.testing.assert_array_equal(NOISELESS.beliefs(cut), believed)


@given(stimuli, st.floats(0.5, 0.7), st.floats(0.71, 0.99), seeds)
def test_whoever_wants_to_be_surer_stops_no_earlier(stimulus, low, high, seed):
    playback = playback_of(stimulus)
    hasty, careful = (
        Observer(OBSERVER_BETA, threshold, noise=0.3, lapse=0, bias=0).judge(
            playback, np.random.default_rng(seed)
        )
        for threshold in (low, high)
    )
    assert hasty.stop_time_ms <= careful.stop_time_ms


def test_lapses_are_random_guesses():
    always = Observer(OBSERVER_BETA, threshold=0.8, noise=0, lapse=1, bias=0)
    rng = np.random.default_rng(1)
    right = [always.judge(playback_of(s), rng).guess == s.goal for s in STIMULI for _ in range(10)]
    assert np.mean(right) == pytest.approx(1 / 6, abs=0.04)  # 740 guesses: 3 standard errors


def test_whoever_watches_to_the_end_sees_where_the_robot_went():
    rng = np.random.default_rng(1)
    assert all(watch_to_the_end(playback_of(s), rng).guess == s.goal for s in STIMULI)


@given(stimuli, seeds)
def test_a_higher_bias_never_lowers_the_rating(stimulus, seed):
    playback = playback_of(stimulus)
    modest, bold = (
        Observer(OBSERVER_BETA, 0.8, noise=0.3, lapse=0, bias=bias).judge(
            playback, np.random.default_rng(seed)
        )
        for bias in (-1.0, 1.0)
    )
    assert modest.confidence <= bold.confidence
