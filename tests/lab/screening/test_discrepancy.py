"""What a formula in the model misses is not named as one more effect."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import catalogue, default_effects, effect_named
from compensator.lab.effects.effect import Motion
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.linear import Term
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.recording import SESSION_START, Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.discrepancy import _carried, _misread, discrepancy_columns
from tests.lab.effects.test_effects import motion, predicted, slope
from tests.lab.synthetic import FACTS, G_M_S2, Bench, Joint, Truth, recordings

ORDER = 7.0
MISREAD, TURNS = 0.004, 12.0


def fitted(joint: Joint, *added: str) -> Fit:
    dataset = make_dataset(recordings(joint, Bench(noise=0.003), seed=5), FACTS, Processing())
    shapes = {"position_periodic_friction": (ORDER,)} if "position_periodic_friction" in added else {}
    return fit_model(dataset, [*default_effects(FACTS), *added], shapes=shapes)


def grown(x: Truth) -> np.ndarray:
    """Weight changes all of dry friction, what falls with speed as well."""
    return (0.08 + 0.08 * np.exp(-np.abs(x.v) / 0.25)) * np.sign(x.v) * 6.0 * x.load_kg


def wavy(x: Truth) -> np.ndarray:
    """Weight and angle change all of dry friction, each by its own factor."""
    dry = 0.08 + 0.08 * np.exp(-np.abs(x.v) / 0.25)
    return dry * np.sign(x.v) * ((1.0 + 6.0 * x.load_kg) * (1.0 + 0.35 * np.cos(ORDER * x.q)) - 1.0)


def meshed(x: Truth) -> np.ndarray:
    """Teeth that transmit what bearings beyond them take, too."""
    load = (0.25 + x.load_kg * G_M_S2 * x.arm_m) * np.sin(x.q) + x.load_kg * x.arm_m**2 * x.a
    return 0.3 * np.abs(load + 0.08 * np.sign(x.v)) * np.sign(x.v)


def test_what_the_formula_of_a_complete_model_misses_is_no_effect():
    found = diagnose(fitted(Joint(static_excess=0.08, extra=grown), "weight_friction", "weight_stribeck"))
    assert found.verdict != "missing", found.sentence


def test_teeth_that_transmit_friction_too_rub_by_quadrant():
    """0.3 |load + f sgn v| is 0.3 |load|, and 0.3 f more where the motor drives and less where it holds back."""
    found = diagnose(fitted(Joint(static_excess=0.08, extra=meshed), "load_friction"))
    assert found.classes[0][0] == "coulomb_quadrant", found.sentence
    assert found.candidates[0].gain.low > 0.3


def heavier(x: Truth) -> np.ndarray:
    """Weight changes Coulomb friction alone."""
    return 0.08 * np.sign(x.v) * 6.0 * x.load_kg


@pytest.mark.parametrize(("law", "named"), [(grown, ["weight_stribeck"]), (heavier, [])])
def test_weight_that_changes_static_friction_as_well_is_no_product_that_is_left_open(law, named):
    found = diagnose(fitted(Joint(static_excess=0.08, extra=law), "weight_friction"))
    assert [name for names in found.classes[:1] for name in names if found.verdict == "missing"] == named


def test_shares_of_dry_friction_may_multiply():
    fit = fitted(Joint(static_excess=0.08, extra=wavy), "weight_friction", "position_periodic_friction")
    rows, effort = fit.training, fit.dataset.effort
    wide = np.column_stack([fit.columns, discrepancy_columns(fit)])
    left = [float(np.linalg.lstsq(some[rows], effort[rows], rcond=None)[1][0]) for some in (fit.columns, wide)]
    # of Stribeck, weight and angle each two, and two tangents of Stribeck with either of the others
    assert wide.shape[1] == fit.columns.shape[1] + 7
    assert left[1] < 0.3 * left[0]


def test_a_model_of_speed_alone_leaves_nothing_open():
    assert discrepancy_columns(fitted(Joint())).shape[1] == 0


def near_load(m: Motion, more: np.ndarray) -> np.ndarray:
    """Load friction of a load that is a little more than the model knows."""
    return np.abs(m.load_effort + 1e-6 * more) * m.direction


def near_square(m: Motion, more: np.ndarray) -> np.ndarray:
    return (m.load_effort + 1e-6 * more) ** 2 * m.direction


def near_sign(m: Motion, more: np.ndarray) -> np.ndarray:
    return np.tanh((predicted(m) + 1e-6 * more) / (0.02 * 1.5))


NEAR: dict[str, tuple[Callable[[Motion, np.ndarray], np.ndarray], Callable[[Motion], list[np.ndarray]]]] = {
    "load_friction": (near_load, lambda m: [m.direction, m.velocity, m.acceleration, m.direction]),
    "load_friction_quadratic": (near_square, lambda m: [m.velocity, m.acceleration]),
    "dead_time": (near_sign, lambda m: [np.ones(41), m.direction, m.velocity]),
}


@pytest.mark.parametrize("name", NEAR)
def test_what_is_left_open_is_the_change_to_a_truth_near_by(name):
    law, changes = NEAR[name]
    m = motion()
    clear = (np.abs(m.velocity) > 0.2) & (np.abs(m.load_effort) > 0.3)
    effect = effect_named(name)
    assert effect.discrepancy is not None
    columns = effect.discrepancy(m, (0.02,))
    wanted = [law(m, change) - law(m, 0.0 * change) for change in changes(m)]
    assert len(columns) == len(wanted)
    for found, change in zip(columns, wanted, strict=True):
        assert np.corrcoef(found[clear], change[clear])[0, 1] > 0.999


def test_without_load_teeth_transmit_the_friction_beyond_them():
    m = replace(motion(), load_effort=np.linspace(-0.06, 0.06, 41), largest_effort=1.5)
    effect = effect_named("load_friction")
    assert effect.discrepancy is not None
    transmitted = np.abs(m.load_effort) * m.direction + effect.discrepancy(m, ())[-1]
    assert transmitted == pytest.approx(np.abs(m.load_effort + 0.03 * m.direction) * m.direction)


def test_what_falls_may_fall_with_the_way_instead_of_time():
    made = [
        replace(one, conditions={**one.conditions, SESSION_START: 12.0 * place})
        for place, one in reversed(list(enumerate(recordings(seed=5)[:6])))
    ]
    dataset = make_dataset(made, FACTS, Processing())
    ways = [np.abs(trial.motion.velocity) * trial.motion.step_s for trial in dataset.trials]
    span_s = dataset.scales.session_span_s
    whole = sum(float(way.sum()) for way in ways)
    before = 0.0
    for trial, way in reversed(list(zip(dataset.trials, ways, strict=True))):
        gone = (before + np.cumsum(way)) / whole  # of the session's way
        found = effect_named("warm_up").discrepancy(trial.motion, (0.5 * span_s,))
        assert found[0] == pytest.approx(np.exp(-2.0 * gone) * trial.motion.direction)
        before += float(way.sum())


def test_an_angle_may_be_misread_twice_as_often_round_and_a_speed_late():
    found = effect_named("encoder_eccentricity").discrepancy(motion(), (2.0,))
    once, twice = ([slope(part(order * motion().position)) for part in (np.cos, np.sin)] for order in (2.0, 4.0))
    late = [slope(rate) for rate in once]
    assert found == pytest.approx(np.array([*late, *(0.3 * slope(rate) for rate in twice), *twice]))


def misread(one: Recording) -> Recording:
    """The same, read by an encoder off its centre."""
    position = one.channels["position_rad"]
    return replace(one, channels={**one.channels, "position_rad": position + MISREAD * np.sin(TURNS * position)})


def test_what_all_effects_make_of_a_misread_angle_is_no_effect():
    joint = Joint(static_excess=0.08, stribeck_speed=0.4)
    recorded = [misread(one) for one in recordings(joint, Bench(noise=0.002, quantum=0.0), seed=5)]
    dataset = make_dataset(recorded, replace(FACTS, gear_ratio=TURNS), Processing())
    fit = fit_model(dataset, [*default_effects(FACTS), "encoder_eccentricity"])
    found = diagnose(fit)
    assert found.verdict != "missing", found.sentence


def term(name: str, coefficients: list[float], *shape: float) -> Term:
    kept = np.ones(len(coefficients), dtype=bool)
    return Term(effect_named(name), shape, np.array(coefficients), kept, ~kept)


def test_an_angle_that_is_misread_a_little_otherwise_is_left_open_in_any_phase():
    m, size = motion(), 1e-4
    cogging = term("cogging", [0.4, 0.0], 8.0)
    found = _misread([cogging, term("encoder_eccentricity", [0.6 * size, 0.8 * size, 0.0, 0.0], TURNS)], m)
    for column, part in zip(found, (np.cos, np.sin), strict=True):
        angle = size * part(TURNS * m.position)
        speed = m.velocity + rate_of_change(angle, 1.0 / m.step_s)
        there = np.cos(8.0 * (m.position + angle)) * np.sinc(8.0 * speed * m.step_s / (2.0 * np.pi))
        here = np.cos(8.0 * m.position) * np.sinc(8.0 * m.velocity * m.step_s / (2.0 * np.pi))
        assert column == pytest.approx(0.4 * (there - here), abs=5e-7)


def test_teeth_lose_a_part_of_what_a_spring_pulls_at_angle_0():
    m = motion()
    known = 0.3 * np.abs(m.load_effort) * m.direction
    found = _carried([term("offset", [0.2]), term("spring", [0.5]), term("load_friction", [0.3])], m)
    assert len(found) == 2  # the offset, which may be all of it, and a spring that is a little stiffer
    assert found[0] == pytest.approx(0.3 * np.abs(m.load_effort + 0.2) * m.direction - known)
    stiffer = 0.3 * np.abs(m.load_effort + 0.05 * 0.5 * m.position) * m.direction - known
    assert found[1] == pytest.approx(stiffer)
    assert _carried([term("offset", [0.2]), term("weight_friction", [0.3])], m) == []


def test_a_load_that_is_a_little_otherwise_is_among_what_a_model_leaves_open():
    fit = fitted(Joint(static_excess=0.08, extra=meshed), "load_friction")
    wide = discrepancy_columns(fit)
    carried = fit.dataset.stack([np.array(_carried(list(fit.terms), one.motion)) for one in fit.dataset.trials])
    assert carried.shape[1] > 0
    missed = carried - wide @ np.linalg.lstsq(wide, carried, rcond=None)[0]
    assert np.linalg.norm(missed) < 1e-6 * np.linalg.norm(carried)


def test_every_effect_that_leaves_something_open_is_tested_here():
    assert {n for n, e in catalogue().items() if e.discrepancy is not None} == {
        *NEAR,
        "encoder_eccentricity",
        "warm_up",
        "winding_temperature",  # with the next one in tests/lab/effects/test_winding_temperature.py
        "motor_warm_up",
    }
