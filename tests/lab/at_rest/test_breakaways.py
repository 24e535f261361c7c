"""Breakaway events: found with their effort, rest and rate; named is what static friction depends on."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.at_rest.breakaway_regression import BACK, LAG, fit_breakaway, held_out_breakaway, lag_column
from compensator.lab.at_rest.breakaway_rows import FEWEST_STARTS, breakaway_rows, enough_starts, starts_counted
from compensator.lab.at_rest.breakaways import resolution_of, starts_of
from compensator.lab.diagnosis.breakaway_family import breakaway_answer, held_against
from compensator.lab.diagnosis.confirmation import is_confirmed
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.processing import make_signals
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.evidence import least_p_value, screen_events
from tests.lab.ramps import COUNT_RAD, HORIZONTAL, MODEL, STATIC, constant, ramp_fit, ramp_recordings, ramp_trial, swing


def rising(rest_s: float, _rate: float) -> float:
    return STATIC * (1.0 + 0.4 * rest_s / (rest_s + 1.0))


def falling(_rest_s: float, rate: float) -> float:
    return STATIC * (1.0 - 0.4 * rate / (rate + 0.15))


@pytest.mark.parametrize(("dwell_s", "rate"), [(0.5, 0.05), (2.0, 0.2), (1.0, 0.5)])
def test_a_start_is_found_with_its_effort_rest_and_rate(dwell_s, rate):
    recording, ramps = ramp_trial("r", dwell_s, rate, constant, np.random.default_rng(0))
    signals = make_signals(recording, choose_effort([recording], HORIZONTAL), HORIZONTAL, 12.0)
    position = recording.channels["position_rad"]
    assert resolution_of([position]) == pytest.approx(COUNT_RAD)
    found = starts_of(signals, position, COUNT_RAD, slow=0.02)
    assert [one.direction for one in found] == [ramp.direction for ramp in ramps]
    for one, ramp in zip(found, ramps, strict=True):
        assert one.effort == pytest.approx(ramp.effort, abs=0.15 * STATIC)  # seen late, by what `onset_lag` stands for
        assert one.rest_s == pytest.approx(ramp.rest_s, abs=0.15)
        assert one.rate == pytest.approx(ramp.rate, rel=0.25)


def test_creep_below_the_slow_speed_is_rest():
    recording, _ = ramp_trial("r", 1.0, 0.1, constant, np.random.default_rng(0))
    signals = make_signals(recording, choose_effort([recording], HORIZONTAL), HORIZONTAL, 12.0)
    creeping = recording.channels["position_rad"] + 0.004 * recording.channels["time_s"]
    quiet = starts_of(signals, recording.channels["position_rad"], COUNT_RAD, slow=0.02)
    assert [one.index for one in starts_of(signals, creeping, COUNT_RAD, slow=0.02)] == pytest.approx(
        [one.index for one in quiet], abs=6
    )


@pytest.mark.parametrize(("static", "name"), [(rising, "dwell_strengthening"), (falling, "rate_dependent_breakaway")])
def test_what_static_friction_depends_on_is_named(static, name):
    fit = ramp_fit(static)
    answer, _ = breakaway_answer(fit, breakaway_rows(fit))
    assert answer is not None
    assert answer.verdict == "missing", [(one.effect.name, one.score, one.gain) for one in answer.candidates]
    best = answer.candidates[0]
    assert (best.effect.name, best.rows) == (name, "breakaway")
    assert best.after < 0.7 * best.before
    assert best.picture is not None
    assert best.picture.driver == best.effect.breakaway.driver
    assert len(best.picture.curve.x) >= 3
    whole = diagnose(fit)
    assert any("starts from rest" in words for words in [whole.sentence, *map(str, whole.notes)])


def test_effects_are_ranked_over_one_model_though_only_one_has_a_late_onset():
    """Quick starts follow short rests here, so that the onset would have to be early in the model without effects."""
    sets = [((0.3, 1.5, 6.0), (0.05, 0.15, 0.5)), ((0.3,), (0.4, 0.5)), ((0.3,), (0.4, 0.5)), ((6.0,), (0.05, 0.1))]
    made = [ramp_recordings(rising, *one, seed=seed) for seed, one in enumerate(sets, start=1)]
    starts = [one for own in made for one in own if one.name.startswith("ramp")]
    swings = [one for one in made[0] if not one.name.startswith("ramp")]
    fit = fit_model(make_dataset([*swings, *starts], HORIZONTAL, Processing(cutoff_hz=12.0)), MODEL)
    rows = breakaway_rows(fit)
    base = fit_breakaway(rows, fit.effects)
    assert base.coefficients_of(LAG)[0] == 0.0
    answer, _ = breakaway_answer(fit, rows)
    first, second = answer.candidates
    assert (first.effect.name, second.effect.name) == ("dwell_strengthening", "rate_dependent_breakaway")
    left = []
    for one in (first, second):
        grown = fit_breakaway(rows, [*fit.effects, one.effect], {one.effect.name: one.shape})
        left.append(float(np.sum((base.weight * grown.residual) ** 2)))
    gained = len(rows) * np.log(left[1] / left[0])  # 2 ln L
    assert first.score - second.score == pytest.approx(gained, abs=0.15 * gained)


def test_a_static_friction_that_depends_on_nothing_lacks_nothing():
    fit = ramp_fit()
    answer, _ = breakaway_answer(fit, breakaway_rows(fit))
    assert answer is not None
    assert answer.verdict == "nothing"


def test_what_starts_back_the_way_it_came_after_short_rests_is_no_dwell():
    random = np.random.default_rng(3)

    def scattered(bent: float) -> Callable[[float, float], float]:
        """Less after short rests; the first start of a trial has rested half a second more, and does not turn back."""
        level = STATIC * (1.0 + 0.06 * random.standard_normal())
        return lambda rest_s, _rate: level if rest_s > 0.7 else bent * level

    made = [swing(f"swing-{hz}", hz, random) for hz in (0.15, 0.3, 0.5, 0.7)]
    for repeat in range(14):
        turning = ramp_trial(f"short-{repeat}", 0.3, 0.3, scattered(0.75), random, ways=(1.0, -1.0, 1.0, -1.0))
        going_on = ramp_trial(f"long-{repeat}", 2.0, 0.3, scattered(1.0), random, ways=(1.0, 1.0, 1.0))
        made += [turning[0], going_on[0]]
    fit = fit_model(make_dataset(made, HORIZONTAL, Processing(cutoff_hz=12.0)), MODEL)
    rows = breakaway_rows(fit)
    assert rows.rest_s[rows.turns_back].max() < rows.rest_s[~rows.turns_back].min()
    assert breakaway_answer(fit, rows)[0].verdict == "nothing"
    assert fit_breakaway(rows, fit.effects).coefficients_of(BACK)[0] == pytest.approx(-0.25 * STATIC, rel=0.2)


@pytest.mark.parametrize(
    ("name", "in_sliding", "refused"),
    [
        ("weight_friction", {"weight_friction": 0.5}, True),
        ("weight_friction", {}, True),  # it hides in steady sliding
        ("weight_friction", {"weight_friction": 0.001}, False),
        ("dwell_strengthening", {}, False),  # it does not show there
        ("rate_dependent_breakaway", {"rate_dependent_breakaway": 0.5}, False),  # quick strokes hardly show it
        ("weight_friction", None, False),  # nobody asked
    ],
)
def test_a_start_is_not_believed_where_steady_sliding_shows_more_and_says_no(name, in_sliding, refused):
    fit = ramp_fit(rising)
    answer, _ = breakaway_answer(fit, breakaway_rows(fit))
    one = replace(answer.candidates[0], effect=effect_named(name))
    held = held_against(one, in_sliding)
    assert is_confirmed(one)
    assert is_confirmed(held) != refused


def test_the_share_that_a_breakaway_model_finds_is_the_static_friction():
    rows = breakaway_rows(ramp_fit())
    fitted = fit_breakaway(rows, rows.fit.effects)
    assert fitted.coefficients_of("coulomb")[0] == pytest.approx(STATIC, rel=0.05)
    assert held_out_breakaway(fitted).relative < 0.06


def test_equal_rests_cannot_show_what_rests_do():
    fit = ramp_fit(dwells_s=(4.0, 4.1, 4.2), rates=(0.3, 0.4, 0.5))
    answer, left_out = breakaway_answer(fit, breakaway_rows(fit))
    assert answer is not None
    assert "needs rests that differ" in left_out["dwell_strengthening"]
    assert "needs rates of the effort that differ" in left_out["rate_dependent_breakaway"]


def test_too_few_starts_carry_no_regression():
    fit = ramp_fit(dwells_s=(0.3, 3.0), rates=(0.1,))
    assert 0 < starts_counted(breakaway_rows(fit)) < FEWEST_STARTS
    assert enough_starts(fit) is None
    fit = ramp_fit()
    assert len(enough_starts(fit)) == len(breakaway_rows(fit)) >= FEWEST_STARTS


def test_events_are_judged_by_flips_of_whole_units():
    random = np.random.default_rng(3)
    unit = np.repeat(np.arange(20), 2)
    column = np.repeat(np.linspace(-1.0, 1.0, 20), 2)[:, None]
    p_values = []
    for seed in range(60):
        noise = np.repeat(random.standard_normal(20), 2) + 0.3 * random.standard_normal(40)
        base = Base.of(np.ones((40, 1)), noise)
        p_values.append(screen_events([base], [Block("x", column, 0, 1)], unit, seed).p_value)
    assert np.mean(np.array(p_values) <= 0.05) <= 0.12
    clear = Base.of(np.ones((40, 1)), column[:, 0] + 0.1 * random.standard_normal(40))
    assert screen_events([clear], [Block("x", column, 0, 1)], unit).p_value <= 0.002


def test_few_units_cannot_give_a_small_p():
    assert least_p_value(5) == pytest.approx(5.0 / 16.0)
    assert least_p_value(9) > 0.01 >= least_p_value(10)


def test_an_effort_that_jumps_at_the_start_is_not_known():
    """A servo that first sees the motion wanted jumps over static friction, from far below it."""
    recording, ramps = ramp_trial("r", 1.0, 0.05, constant, np.random.default_rng(0))
    effort = choose_effort([recording], HORIZONTAL)
    signals = make_signals(recording, effort, HORIZONTAL, 12.0)
    position = recording.channels["position_rad"]
    quiet = starts_of(signals, position, COUNT_RAD, slow=0.02)
    early = signals.effort.copy()
    for one in quiet:
        early[one.index - 40 : one.index + 1] -= 0.7 * one.effort  # until the last sample at rest
    jumping = starts_of(replace(signals, effort=early), position, COUNT_RAD, slow=0.02)
    for one, ramp, before in zip(jumping, ramps, quiet, strict=True):
        assert before.effort_sd < 0.02 * STATIC
        assert one.effort_sd == pytest.approx(0.7 * STATIC / np.sqrt(12.0), rel=0.4)  # it goes on rising
        assert abs(one.effort - ramp.effort) < 2.0 * one.effort_sd


def test_what_the_model_has_is_no_evidence_for_what_would_stand_in_its_place():
    random = np.random.default_rng(5)
    unit = np.repeat(np.arange(20), 2)
    rate = np.repeat(np.tile([0.1, 0.3, 0.6, 1.0], 5), 2)
    has, would_be = np.sqrt(rate)[:, None], (rate / (rate + 0.5))[:, None]
    constant_part = np.ones((40, 1))
    block = Block("x", would_be, 1, 1)
    p_values = []
    for seed in range(40):
        effort = 5.0 * has[:, 0] + 0.1 * random.standard_normal(40)
        bases = [Base.of(np.hstack([constant_part, has]), effort), Base.of(constant_part, effort)]
        p_values.append(screen_events(bases, [block], unit, seed).p_value)
    assert np.mean(np.array(p_values) <= 0.05) <= 0.12
    effort = 5.0 * would_be[:, 0] + 0.1 * random.standard_normal(40)
    bases = [Base.of(np.hstack([constant_part, has]), effort), Base.of(constant_part, effort)]
    assert screen_events(bases, [block], unit).p_value <= 0.002


def test_a_heavier_arm_is_seen_to_start_later_and_that_is_no_friction_of_its_weight():
    """Of a joint whose static friction is the same under each load, and whose inertia is not."""
    made = [one for load_kg in (0.0, 1.0, 3.0) for one in ramp_recordings(constant, seed=int(load_kg), load_kg=load_kg)]
    fit = fit_model(make_dataset(made, HORIZONTAL, Processing(cutoff_hz=12.0)), MODEL)
    rows = breakaway_rows(fit)
    heavy = rows.driver("load_kg") == 3.0
    column = np.abs(lag_column(rows)[:, 0]) / np.sqrt(rows.rate)
    assert column[heavy].mean() == pytest.approx(2.0 * column[rows.driver("load_kg") == 0.0].mean(), rel=0.1)
    answer, _ = breakaway_answer(fit, rows)
    assert answer.verdict == "nothing", answer.sentence
    gained = fit_breakaway(rows, fit.effects).coefficients_of(LAG)
    assert 0.0 < gained[0] < 3.0  # over what it gains until the slow speed
