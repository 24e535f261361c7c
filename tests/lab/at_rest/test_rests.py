"""Rest bounds the effort: a complete model holds, what is wrong at rest alone is found, with its side and its size."""

import re
from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.at_rest.rest_comparison import RestComparison, Side, at_rest_in_words, compare_at_rest
from compensator.lab.at_rest.rests import extrapolated
from compensator.lab.comparison.comparison import compare
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.at_rest.test_breakaways import falling
from tests.lab.ramps import HORIZONTAL, MODEL, RATE_HZ, STATIC, ramp_fit, ramp_recordings

COULOMB, MOMENT, LEAN_RAD, HELD_RAD = 0.05, 0.5, 0.3, 1.2
NOISE = 5e-4


def biased(bias: float, only_at_rest: bool = True) -> Fit:
    """Swings and ramps whose effort is off by a bias, while the joint stands or all the time."""
    made = ramp_recordings()
    for one in made:
        speed = np.abs(np.gradient(one.channels["position_rad"], one.channels["time_s"]))
        one.channels["torque_n_m"] += bias * (np.exp(-speed / 0.05) if only_at_rest else 1.0)
    return fit_model(make_dataset(made, HORIZONTAL, Processing(cutoff_hz=12.0)), MODEL)


@pytest.mark.parametrize("seed", range(4))
def test_a_complete_model_holds_at_rest(seed):
    found = compare_at_rest(ramp_fit(seed=seed))
    assert found.windows > 1000
    assert found.by_starts
    assert not found.is_evidence
    assert found.largest < 0.1 * STATIC
    assert re.search("no more than chance|all lie within", at_rest_in_words(found, "N m"))


def test_what_a_poor_model_says_of_rest_is_not_called_chance():
    def said(outside, largest, by_starts=True):
        side = Side(outside, largest, 1.0, "one", 2.0)
        return at_rest_in_words(RestComparison(40, 2, side, replace(side, outside=0.0), 0.01, 0.5, by_starts), "A")

    assert said(0.9, 0.6).endswith(
        "no more than what the model leaves while the joint slides, so that rest tells "
        "nothing; mend the model there first."
    )
    assert said(0.9, 0.6, by_starts=False).endswith("record breakaway ramps.")
    assert "no more than chance" in said(0.02, 0.01)
    beyond = RestComparison(40, 2, Side(0.5, 0.1, 1e-3, "one", 2.0), Side(0.0, 0.0, 1.0, "one", 2.0), 0.05, 0.5, False)
    assert "static friction may be more than sliding shows" in at_rest_in_words(beyond, "A")
    assert "that is no friction" in at_rest_in_words(replace(beyond, by_starts=True), "A")
    assert said(0.0, 0.0) == "At rest: of 40 stretches of 0.1 s, all lie within what friction holds."


def test_a_joint_with_a_torque_sensor_is_judged_at_rest():
    made = ramp_recordings()
    for one in made:
        one.channels["load_torque_n_m"] = 0.01 * np.sin(one.channels["position_rad"])
        one.channels["torque_n_m"] += one.channels["load_torque_n_m"]
    fit = fit_model(make_dataset(made, HORIZONTAL, Processing(cutoff_hz=12.0)), (*MODEL, "measured_load"))
    found = compare_at_rest(fit)
    assert found.by_starts
    assert not found.is_evidence


@pytest.mark.parametrize("bias", [0.03, -0.03])
def test_a_bias_at_rest_that_sliding_does_not_have_is_found_on_its_side(bias):
    fit = biased(bias)
    found = compare_at_rest(fit)
    side, other = (found.above, found.below) if bias > 0.0 else (found.below, found.above)
    assert side.chance <= 0.001 < 0.5 < other.chance
    assert side.largest == pytest.approx(abs(bias), abs=0.015)  # static friction itself scatters
    words = at_rest_in_words(found, "N m")
    assert f"{'above' if bias > 0.0 else 'below'} only" in words
    assert "that is no friction" in words
    assert words in map(str, diagnose(fit).notes)


def test_an_encoder_off_its_centre_makes_nothing_of_rest():
    geared = replace(HORIZONTAL, gear_ratio=20.0)
    fit = fit_model(
        make_dataset(ramp_recordings(), geared, Processing(cutoff_hz=12.0)), [*MODEL, "encoder_eccentricity"]
    )
    eccentric = next(term for term in fit.terms if term.effect.name == "encoder_eccentricity")
    large = replace(eccentric, coefficients=np.full(len(eccentric.coefficients), 1.0))
    off = replace(fit, terms=tuple(large if term is eccentric else term for term in fit.terms))
    assert compare_at_rest(off).largest == pytest.approx(compare_at_rest(fit).largest)


def test_an_offset_that_sliding_has_too_is_none():
    assert not compare_at_rest(biased(0.03, only_at_rest=False)).is_evidence


def test_friction_that_holds_less_the_quicker_the_effort_rises_is_no_violation():
    assert not compare_at_rest(ramp_fit(falling)).is_evidence


def trial(name: str, position: np.ndarray, lean_rad: float, seed: int) -> Recording:
    """A joint whose centre of mass stands beside its arm; at rest the servo holds exactly what gravity asks."""
    time_s = np.arange(len(position)) / RATE_HZ
    velocity = np.gradient(position, time_s)
    effort = 0.02 * np.gradient(velocity, time_s) + 0.03 * velocity + COULOMB * np.sign(velocity)
    effort += MOMENT * np.sin(position + lean_rad) + NOISE * np.random.default_rng(seed).standard_normal(len(position))
    return Recording(name, "x", {}, {"time_s": time_s, "position_rad": position, "torque_n_m": effort})


def held_at(*efforts: float) -> Fit:
    """Swings with a Stribeck curve, and a joint that is held by these efforts without having started."""
    time_s = np.arange(0.0, 8.0, 1.0 / RATE_HZ)
    made = []
    for number, hz in enumerate((0.3, 0.5, 0.8, 1.2) * 3):
        one = trial(f"swing-{number}", 0.4 * np.sin(2.0 * np.pi * hz * time_s), 0.0, number)
        velocity = np.gradient(one.channels["position_rad"], time_s)
        one.channels["torque_n_m"] += COULOMB * np.exp(-np.abs(velocity) / 0.2) * np.sign(velocity)
        made.append(one)
    for number, effort in enumerate(efforts):
        made.append(trial(f"held-{number}", np.zeros(len(time_s)), 0.0, 9))
        made[-1].channels["torque_n_m"] += effort
    effects = ("inertia", "gravity", "offset", "coulomb", "viscous", "stribeck")
    return fit_model(make_dataset(made, Facts(), Processing(cutoff_hz=8.0)), effects)


def test_static_friction_below_the_slowest_sliding_is_not_known_without_starts():
    friction = 2.0 * COULOMB
    rise = extrapolated(held_at(friction))
    assert 0.05 * COULOMB < rise < COULOMB
    assert not compare_at_rest(held_at(friction + rise)).is_evidence
    assert compare_at_rest(held_at(friction + 8.0 * rise)).is_evidence


@pytest.mark.parametrize(("share", "sticks"), [(0.9, False), (4.0, True)])
def test_a_power_law_of_the_speed_holds_at_rest_what_it_brakes_at_the_slowest(share, sticks):
    time_s, power = np.arange(0.0, 8.0, 1.0 / RATE_HZ), 0.3
    made = [
        trial(f"swing-{number}", 0.4 * np.sin(2.0 * np.pi * hz * time_s), 0.0, number)
        for number, hz in enumerate((0.05, 0.3, 0.8, 1.2) * 3)
    ]
    made += [trial(f"held-{way}", np.zeros(len(time_s)), 0.0, 9) for way in (1.0, -1.0)]
    for one in made:
        velocity = np.gradient(one.channels["position_rad"], time_s)
        one.channels["torque_n_m"] += COULOMB * (np.abs(velocity) ** power - 1.0) * np.sign(velocity)
    dataset = make_dataset(made, Facts(), Processing(cutoff_hz=8.0))
    slowest = COULOMB * dataset.scales.slow**power
    for way, one in zip((1.0, -1.0), made[-2:], strict=True):
        one.channels["torque_n_m"] += way * share * slowest
    dataset = make_dataset(made, Facts(), Processing(cutoff_hz=8.0))
    fit = fit_model(dataset, ("inertia", "gravity", "offset", "viscous", "viscous_power"))
    assert compare_at_rest(fit).is_friction == sticks


@pytest.mark.parametrize(("efforts", "sticks"), [((1.5, -1.5), False), ((6.0, -6.0), True), ((6.0, 0.0), False)])
def test_static_friction_beyond_the_models_is_missing_though_sliding_leaves_nothing(efforts, sticks):
    found = diagnose(held_at(*(share * COULOMB for share in efforts)))
    assert (found.verdict, found.remains) == ("nothing", sticks), found.sentence
    assert found.sentence.startswith("At rest: ") == sticks
    assert ("static friction is more than this model has" in found.sentence) == sticks


def leaning(lean_rad: float) -> Fit:
    """Swings about the lowest angle, where a centre of mass beside the arm looks like an offset, and a rest far off."""
    time_s = np.arange(0.0, 8.0, 1.0 / RATE_HZ)
    made = [
        trial(f"swing-{number}", 0.12 * np.sin(2.0 * np.pi * hz * time_s), lean_rad, number)
        for number, hz in enumerate((0.5, 0.8, 1.2, 1.7))
    ]
    made.append(trial("held", np.full(len(time_s), HELD_RAD), lean_rad, 9))
    effects = ("inertia", "gravity", "offset", "coulomb", "viscous")
    return fit_model(make_dataset(made, Facts(), Processing(cutoff_hz=8.0)), effects)


def test_a_centre_of_mass_that_sliding_takes_for_an_offset_is_found_at_rest():
    assert not compare_at_rest(leaning(0.0)).is_evidence
    found = compare_at_rest(leaning(LEAN_RAD))
    assert found.below.chance <= 0.01
    assert found.below.trial == "held"
    assert not found.by_starts


def test_rest_is_a_regime_by_what_lies_beyond_friction():
    found = compare(biased(0.03))
    stuck = next(one for one in found.regimes if one.name == "stuck")
    assert stuck.rows == found.at_rest.windows
    assert stuck.rms == pytest.approx(found.at_rest.rms)
    assert 0.0 < stuck.rms < found.at_rest.largest
    assert 0.0 < found.at_rest.outside < 0.2
