"""The rivals on the simulated joint: fewer and shorter trials than `friction-bench rivals` takes."""

import json

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.config.friction_curves import FrictionCurve, FrictionSettings
from bench.evaluation.rivals import compare, comparison, numbers_of, scoring, section_of
from bench.evaluation.rivals.comparison import Comparison
from bench.evaluation.rivals.record import record
from bench.evaluation.rivals.replay import search_of, truth_of
from bench.evaluation.rivals.scoring import REGIMES, Score
from compensator.rivals import RIVALS

pytestmark = pytest.mark.timeout(300)  # seconds by itself; a shared machine may take minutes
SMALL = {
    "STEPS": {"load_kg": 0.05, "repeats": 1},
    "SPEEDS": {"load_kg": 0.05, "speeds_rad_s": (2.0,)},
    "SINUSOID": {"load_kg": 0.05, "frequency_hz": 0.5, "periods": 1},
    "WALL_SINUSOID": {"load_kg": 0.05, "frequency_hz": 0.2, "amplitude_rad": 0.5, "periods": 1},
    "RIGS": {"with free play": None},
}


def curve(load_kg):
    """What the preset says of itself; see `tests/experiments/test_speed_sweep.py`."""
    growth = 1.0 + 1.7 * 9.80665 * load_kg
    coulomb_a, static_a = 0.06 * growth + 0.00625, 0.1 * growth + 0.0075
    return FrictionCurve(
        load_kg=load_kg, f_load_a=static_a, coulomb_a=coulomb_a, static_a=static_a, stribeck_speed_rad_s=5.0,
        viscous_a_s_rad=0.0021625, inertia_a_s2_rad=(0.012 + 1.25 * (0.01 + 0.25 * load_kg)) / 20.0,
    )  # fmt: skip


@pytest.fixture(scope="module")
def configuration():
    friction = FrictionSettings(curves=tuple(curve(load_kg) for load_kg in (0.0, 0.05, 0.1)))
    return default_configuration().model_copy(update={"friction": friction})


@pytest.fixture(scope="module")
def compared(configuration):
    with pytest.MonkeyPatch.context() as patch:
        for name, value in SMALL.items():
            patch.setattr(comparison, name, value)
        return compare(configuration, [1])


def test_every_rival_has_an_error_in_every_regime(compared):
    for row in numbers_of(compared):
        for regime in scoring.REGIMES:
            found = row[regime.replace(" ", "_")]
            assert found["mean_absolute_error_g"] <= found["max_error_g"], (row["rival"], regime)
    json.dumps(numbers_of(compared), allow_nan=False)


def test_at_rest_those_who_search_are_far_closer_and_pay_for_it(compared):
    scores = compared[0].scores
    # no other can tell within the band of static friction: 0.19 A, or 38 g, either way
    for name in ("paper", "online"):
        assert scores[name].mean_g("at rest") < 3.0
        assert scores[name].seconds[0] > 0.5
        assert scores[name].travel_rad[0] > 0.0
        assert scores[name].energy_j[0] > 0.0
    assert scores["uncompensated"].mean_g("at rest") > 3.0
    assert scores["uncompensated"].seconds == []


def test_in_motion_taking_friction_and_inertia_off_pays(compared):
    scores = compared[0].scores
    for regime in ("steady speed", "sinusoid"):
        assert scores["online"].mean_g(regime) < 0.25 * scores["uncompensated"].mean_g(regime), regime
        assert scores["disturbance-observer"].mean_g(regime) < 0.5 * scores["uncompensated"].mean_g(regime), regime


def test_the_table_names_every_rival(compared):
    (table,) = section_of(compared, 1).tables
    twice = section_of([*compared, *compared], 1)
    assert twice.sentences[-1].startswith("The paper sets dynamic models aside")
    assert twice.sentences[-1].count("with free play") == 7
    assert len(table.rows) == 8
    assert all(len(row) == len(table.columns) for row in table.rows)


def test_the_reason_against_dynamic_models_is_judged_by_their_errors_without_free_play():
    def measured(rig, error_g):
        score = Score()
        for regime in REGIMES:
            score.add(regime, np.array([error_g]))
        return Comparison(rig, {rival.name: score for rival in RIVALS})

    def last(error_g):
        return section_of([measured("with free play", 10.0), measured("without free play", error_g)], 1).sentences[-1]

    assert "have 0 of 3 at rest and 0 of 3 at reversals: on this joint the reason is not borne out" in last(9.0)
    assert "have 3 of 3 at rest and 3 of 3 at reversals: on this joint the reason is borne out" in last(4.0)


def test_the_truth_at_a_wall_is_what_the_wall_takes(configuration):
    walled = comparison._with_plant(configuration, {"wall": comparison.WALL})
    (trial,) = record(walled, "sinusoid", **SMALL["WALL_SINUSOID"])
    rows = scoring.wall_rows(trial)
    assert np.count_nonzero(rows) > 20
    assert np.all(np.abs(trial.channels["position_rad"][rows] - 0.4) < 0.02)
    truth_a, pushed_a = truth_of(trial, configuration.rig)[rows], trial.channels["current_estimate_a"][rows]
    # what the motor pushes with, less friction and less the loss in the teeth, either way
    assert np.all(truth_a < pushed_a / 0.75 + 0.3)
    assert np.all(truth_a > 0.1)


def test_the_same_seed_gives_the_same_samples(configuration):
    one, two = (record(configuration, "steps", **SMALL["STEPS"])[0] for _ in range(2))
    assert np.array_equal(one.channels["position_rad"], two.channels["position_rad"])
    span = search_of(one)
    assert 0 < span.first < span.last < len(one.channels["time_s"])
