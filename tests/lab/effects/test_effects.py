"""Every effect file: its columns against the equation that it states, and what it says about itself."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.fft import next_fast_len

from compensator.lab.effects.catalogue import catalogue
from compensator.lab.effects.effect import Motion
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.facts import Facts
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.screening.nuisance import NEAR_REVERSALS

EFFECTS = catalogue()
LOAD_KG, ARM_M = 0.2, 0.4
WEIGHT_N_M = 0.2 * 9.80665 * 0.4


def motion(joint: str = "rotary", **conditions: float | bool) -> Motion:
    time_s = np.linspace(0.0, 2.0, 41)
    q, v, a = np.sin(3 * time_s), 3 * np.cos(3 * time_s), -9 * np.sin(3 * time_s)
    return Motion(
        facts=Facts(joint=joint),
        conditions={"load_kg": LOAD_KG, "arm_m": ARM_M, "session_s": 30.0, **conditions},
        time_s=time_s,
        position=q,
        velocity=v,
        acceleration=a,
        jerk=-9 * v,
        direction=np.tanh(v / 0.01),
        load_effort=1.3 * np.sin(q) - 0.2,
        inertia_beyond=0.1,
        inertia=0.3,
        parting=13.0 * np.sin(q) - 2.0,
        predicted=0.7 * np.cos(q) - 0.3,
        effort_rate=4.0 * v,
        largest_effort=1.5,
        bend=np.zeros(41),
        temperature_c=20.0 + 5.0 * time_s,
        supply_v=np.full(41, 12.0),
        position_span=2.0,
        session_span_s=60.0,
        slow=0.06,
        fast=2.9,
        measured_load=0.9 * np.cos(q),
        start_rate=0.5 + time_s,
        usual_start_rate=0.8,
    )


def predicted(m: Motion) -> np.ndarray:
    return 0.7 * np.cos(m.position) - 0.3


def back_driven(m: Motion, load: np.ndarray) -> np.ndarray:
    return np.where(load * m.velocity < 0.0, np.abs(load) * np.sign(m.velocity), 0.0)


def over_a_sample(m: Motion, order: float) -> list[np.ndarray]:
    """Cosine and sine of an order, averaged over the 0.05 s around each sample: midpoints of 2000 parts."""
    around = m.position[:, None] + m.velocity[:, None] * 0.05 * ((np.arange(2000) + 0.5) / 2000 - 0.5)
    return [np.cos(order * around).mean(axis=1), np.sin(order * around).mean(axis=1)]


def slope(values: np.ndarray) -> np.ndarray:
    return rate_of_change(values, 20.0)


def behind(values: np.ndarray, motion: Motion, lag_s: float) -> np.ndarray:
    """How far a first-order lag is behind values that are held over every step, from rest on the first."""
    state, states = values[0], []
    for value in values:
        state += (value - state) * (1.0 - np.exp(-motion.step_s / lag_s))
        states.append(state)
    return np.array(states) - values


def dahl(position: np.ndarray, distance: float) -> np.ndarray:
    """Dahl's equation, integrated in small steps between the samples, less the sign of the motion."""
    state, states, sign = 0.0, [0.0], [1.0]
    for here, there in pairwise(position):
        for _ in range(2000):
            step, going = (there - here) / 2000, np.sign(there - here)
            half = state + 0.5 * step / distance * (1.0 - state * going)
            state += step / distance * (1.0 - half * going)
        states.append(state)
        sign.append(np.sign(there - here))
    return np.array(states) - np.array(sign)


def crossing(m: Motion) -> list[np.ndarray]:
    """Half of a gap of 0.3 either side; the way between the flanks in steps of speed, caught where it meets one."""
    step_s, way, speed, gained = 0.05, 0.15 * np.sign(m.parting[0]), 0.0, []
    for parting in m.parting:
        wanted = way + step_s * (speed + step_s * parting)
        ahead = min(max(wanted, -0.15), 0.15)
        gained.append(((ahead - way) / step_s - speed) / step_s)
        way, speed = ahead, (ahead - way) / step_s
    return [-0.1 * np.array(gained)]


def twisted(m: Motion) -> list[np.ndarray]:
    """A far side on a spring of 2 Hz, 0.05 of critical damping: its transfer function, frequency by frequency."""
    begun, w = m.parting - m.parting[0], 2.0 * np.pi * 2.0
    later = np.arange(1, 12)
    fading = (begun[-1] + later * (begun[-1] - begun[-2])) * np.cos(0.5 * np.pi * later / 11) ** 2
    whole = next_fast_len(52 + int(4.6 / (0.05 * w * 0.05)), real=True)
    driven = np.concatenate([begun, fading, np.zeros(whole - 52)])
    at = np.arange(whole)
    s = 2j * np.pi * np.fft.fftfreq(whole, 0.05)
    waves = np.exp(2j * np.pi * np.outer(at, at) / whole)
    passed = s**2 / (s**2 + 2.0 * 0.05 * w * s + w**2)
    passed[whole // 2] = passed[whole // 2].real if whole % 2 == 0 else passed[whole // 2]
    return [-0.1 * (waves @ (passed * (waves.conj() @ driven))).real[:41] / whole]


def smoothed(m: Motion, time_constant_s: float) -> np.ndarray:
    """Predicted effort behind a low-pass of first order that is settled at the start."""
    kept, now, found = np.exp(-0.05 / time_constant_s), predicted(m)[0], []
    for value in predicted(m):
        now = kept * now + (1.0 - kept) * value
        found.append(now)
    return np.array(found)


def flank(m: Motion) -> np.ndarray:
    """Which flank carries the load, unsure below a hundredth of the largest effort."""
    return np.tanh((1.3 * np.sin(m.position) - 0.2) / (0.01 * 1.5))


# one row per parameter, from the equation in the effect's file; shape values in its order
EQUATIONS: dict[str, tuple[tuple[float, ...], Callable[[Motion], list[np.ndarray]]]] = {
    "inertia": ((), lambda m: [m.acceleration, LOAD_KG * ARM_M**2 * m.acceleration]),
    "gravity": ((), lambda m: [np.sin(m.position), WEIGHT_N_M * np.sin(m.position)]),
    "measured_load": ((), lambda m: [0.9 * np.cos(m.position)]),
    "offset": ((), lambda m: [np.ones(41)]),
    "coulomb": ((), lambda m: [np.sign(m.velocity)]),
    "viscous": ((), lambda m: [m.velocity]),
    "stribeck": ((0.7, 2.0), lambda m: [np.sign(m.velocity) * np.exp(-((m.velocity / 0.7) ** 2))]),
    "coulomb_asymmetry": ((), lambda m: [np.ones(41)]),
    "viscous_asymmetry": ((), lambda m: [np.abs(m.velocity)]),
    "viscous_quadratic": ((), lambda m: [np.sign(m.velocity) * m.velocity**2]),
    "viscous_power": ((0.5,), lambda m: [np.sign(m.velocity) * np.sqrt(np.abs(m.velocity) / m.fast)]),
    "coulomb_quadrant": (
        (),
        lambda m: [flank(m), flank(m) * np.sign(m.velocity)],
    ),
    "load_friction": ((), lambda m: [np.abs(1.3 * np.sin(m.position) - 0.2) * np.sign(m.velocity)]),
    "load_friction_quadratic": ((), lambda m: [(1.3 * np.sin(m.position) - 0.2) ** 2 * np.sign(m.velocity)]),
    "weight_friction": ((), lambda m: [LOAD_KG * np.sign(m.velocity)]),
    "weight_stribeck": (
        (0.7, 2.0),
        lambda m: [LOAD_KG * np.sign(m.velocity) * np.exp(-((m.velocity / 0.7) ** 2))],
    ),
    "coulomb_temperature": ((), lambda m: [(5.0 * m.time_s - 5.0) * np.sign(m.velocity)]),
    "viscous_temperature": ((), lambda m: [(5.0 * m.time_s - 5.0) * m.velocity]),
    "position_periodic_friction": ((7.0,), lambda m: [part * np.sign(m.velocity) for part in over_a_sample(m, 7.0)]),
    "spring": ((), lambda m: [m.position]),
    "hardening_spring": ((), lambda m: [m.position, m.position**2, m.position**3]),
    "centre_of_mass_angle": ((), lambda m: [np.cos(m.position), WEIGHT_N_M * np.cos(m.position)]),
    "measurement_delay": ((), lambda m: [4.0 * m.velocity]),
    "effort_filter": ((0.2,), lambda m: [smoothed(m, 0.2) - predicted(m)]),
    "back_driving_friction": ((), lambda m: [back_driven(m, 1.3 * np.sin(m.position) - 0.2)]),
    "cogging": ((9.0,), lambda m: over_a_sample(m, 9.0)),
    "cogging_orders": (
        (9.0, 4.0, 0.0, 0.0, 0.0, 0.0),
        lambda m: [*over_a_sample(m, 9.0), *over_a_sample(m, 4.0), *np.zeros((8, 41))],
    ),
    "torque_constant_saturation": ((), lambda m: [predicted(m) * np.abs(predicted(m))]),
    "current_gain_asymmetry": ((), lambda m: [np.abs(predicted(m))]),
    "dead_time": ((0.02,), lambda m: [np.tanh(predicted(m) / (0.02 * 1.5))]),
    "supply_sag": ((2.0,), lambda m: [predicted(m) * ((predicted(m) / 1.5 + 2.0 * m.velocity / 2.9) / 3.0) ** 2]),
    "back_emf_error": ((), lambda m: [m.velocity]),
    "winding_temperature": ((), lambda m: [(5.0 * m.time_s - 5.0) * predicted(m)]),
    "motor_warm_up": ((40.0,), lambda m: [(1.0 - np.exp(-(m.time_s + 30.0) / 40.0)) * predicted(m)]),
    "warm_up": ((40.0,), lambda m: [np.exp(-(m.time_s + 30.0) / 40.0) * np.sign(m.velocity)]),
    "frictional_lag": (
        (0.5, 0.05),
        lambda m: [
            np.sign(m.velocity) * behind(level, m, 0.05)
            for level in (np.exp(-np.abs(m.velocity) / 0.5), np.abs(m.velocity))
        ],
    ),
    "pre_sliding": ((0.1,), lambda m: [dahl(m.position, 0.1)]),
    "backlash": ((0.3, 1.0), crossing),
    "dwell_strengthening": ((0.1,), lambda m: [np.zeros(41)]),
    "rate_dependent_breakaway": (
        (0.6,),
        lambda m: [(0.3 - m.time_s) / (1.3 + m.time_s) * np.exp(-np.abs(m.velocity) / 0.6) * np.sign(m.velocity)],
    ),
    "elasticity": ((2.0, 0.05, 1.0), twisted),
    "encoder_eccentricity": (
        (2.0,),
        lambda m: [
            0.3 * slope(slope(np.cos(2 * m.position))),
            0.3 * slope(slope(np.sin(2 * m.position))),
            slope(np.cos(2 * m.position)),
            slope(np.sin(2 * m.position)),
        ],
    ),
}


def test_every_effect_of_the_catalogue_has_its_equation_here():
    assert set(EQUATIONS) == set(EFFECTS)


@pytest.mark.parametrize("name", EQUATIONS)
def test_columns_are_the_written_equation(name):
    shape, equation = EQUATIONS[name]
    found, wanted = EFFECTS[name].columns(motion(), shape), np.array(equation(motion()))
    assert found.shape == (len(EFFECTS[name].parameters), 41)
    assert found == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize("name", EFFECTS)
def test_what_an_effect_says_of_itself(name):
    effect = EFFECTS[name]
    assert effect.driver in DRIVERS
    assert set(effect.confused_with) <= set(EFFECTS) - {name}
    assert effect.standing_in <= {*("jerk",), *NEAR_REVERSALS}
    assert effect.title
    assert effect.physics.endswith(".")
    for parameter in effect.parameters:
        assert parameter.low < parameter.high
        assert "{" not in parameter.unit_in("N m", "rad")
    for shape in effect.shapes(motion()):
        assert len(shape) == len(effect.shape_names)


@pytest.mark.parametrize("name", ["cogging", "position_periodic_friction"])
def test_of_a_single_moment_nothing_is_averaged(name):
    """One start from rest, and one reading on the bench."""
    whole = motion()
    arrays = {name: value for name, value in vars(whole).items() if isinstance(value, np.ndarray)}
    moment = replace(whole, **{name: value[3:4] for name, value in arrays.items()})
    phase, way = 9.0 * np.sin(0.45), 1.0 if name == "cogging" else np.tanh(3 * np.cos(0.45) / 0.01)
    assert EFFECTS[name].columns(moment, (9.0,))[:, 0] == pytest.approx([way * np.cos(phase), way * np.sin(phase)])


@pytest.mark.parametrize("name", ["cogging", "position_periodic_friction"])
def test_what_goes_round_with_the_motor_is_looked_for_where_the_gear_is_known(name):
    geared = replace(motion(), facts=Facts(gear_ratio=76.0))
    assert {(76.0,), (152.0,)} <= set(EFFECTS[name].shapes(geared)) - set(EFFECTS[name].shapes(motion()))
    direct = replace(motion(), facts=Facts(gear_ratio=1.0))
    assert all(1.0 not in shape for shape in EFFECTS[name].shapes(direct))


@pytest.mark.parametrize(("span", "low"), [(1.5, []), (1.6, [2.0]), (3.2, [1.0, 2.0])])
def test_friction_once_and_twice_a_turn_is_looked_for_where_the_travel_holds_half_a_wave_of_it(span, low):
    found = EFFECTS["position_periodic_friction"].shapes(replace(motion(), position_span=span))
    assert [order for (order,) in found if order < 3.0] == low
    weights = [order for (order,) in EFFECTS["cogging"].shapes(replace(motion(), position_span=span)) if order < 3.0]
    assert weights == []


def test_units_are_the_studys_own():
    (viscous,) = EFFECTS["viscous"].parameters
    assert viscous.unit_in("N", "m") == "N s/m"


def test_friction_and_inertia_are_never_negative_and_a_lubricant_never_thickens():
    for name in ("inertia", "coulomb", "viscous", "stribeck", "load_friction", "weight_friction"):
        assert EFFECTS[name].parameters[0].low == 0.0
    assert EFFECTS["viscous_temperature"].parameters[0].high == 0.0
    assert EFFECTS["load_friction"].parameters[0].high == 1.0


def test_a_balanced_arm_has_inertia_but_no_moment():
    balanced = motion(balanced=True)
    assert not EFFECTS["gravity"].columns(balanced, ())[1].any()
    assert EFFECTS["gravity"].columns(balanced, ())[0].any()
    assert EFFECTS["inertia"].columns(balanced, ())[1].any()


def test_what_is_not_told_of_a_load_is_nothing():
    bare = motion()
    untold = Motion(**{**{name: getattr(bare, name) for name in bare.__dataclass_fields__}, "conditions": {}})
    assert untold.load_kg == untold.load_moment_n_m == untold.arm_m == 0.0
    worded = motion(load_kg="heavy")
    assert worded.load_kg == 0.0


def test_stribeck_speeds_lie_between_the_uncertain_and_half_the_fast():
    speeds = [speed for speed, _ in EFFECTS["stribeck"].shapes(motion())]
    assert min(speeds) == pytest.approx(0.12)
    assert max(speeds) == pytest.approx(1.45)


def test_orders_of_a_linear_joint_are_cycles_over_its_travel():
    (first,), *_, (last,) = EFFECTS["position_periodic_friction"].shapes(motion("linear"))
    assert (first, last) == pytest.approx((np.pi, 30 * np.pi))
    assert EFFECTS["position_periodic_friction"].shapes(motion())[0] == (2.0,)


CURRENT = ("winding_temperature", "motor_warm_up", "torque_constant_saturation", "supply_sag", "dead_time")


@pytest.mark.parametrize("name", CURRENT)
def test_what_goes_by_the_current_leaves_out_the_back_emf_of_a_voltage(name):
    effect, plain = EFFECTS[name], motion()
    shape = effect.shapes(plain)[0] if effect.shape_names else ()
    held = replace(plain, predicted=plain.predicted + 0.4 * plain.velocity, back_emf=0.4)
    found, same, without = (effect.columns(one, shape) for one in (held, plain, replace(held, back_emf=0.0)))
    if name == "supply_sag":  # the duty holds the back-EMF
        more = 0.1 * plain.velocity * 1.5 / 2.9
        same = same * ((held.predicted + more) / (plain.predicted + more)) ** 2
    assert found == pytest.approx(same)
    assert without != pytest.approx(same, rel=0.01)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("coulomb_asymmetry", "direction-asymmetric Coulomb friction"),
        ("coulomb_quadrant", "Coulomb friction by quadrant"),
        ("back_emf_error", "back-EMF constant in error"),
        ("load_friction_quadratic", "quadratic load-dependent friction"),
    ],
)
def test_a_title_within_a_sentence_keeps_names_of_people(name, words):
    assert EFFECTS[name].in_sentence == words
