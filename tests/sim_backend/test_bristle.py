"""Bristles against a fine-step reference integration of the papers' equations (`reference.py`)."""

from math import log2, pi
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from sim_backend.mechanisms.motor.motor import OPEN, VOLTAGE
from sim_backend.plant.plant import Plant
from tests.sim_backend.plants import RATIO, RESISTANCE, ROTOR, G, K, duty_for_torque, plant
from tests.sim_backend.reference import BristledRotor

COULOMB, STATIC, STRIBECK, VISCOUS = 5e-3, 8e-3, 1.0, 1e-4
STIFFNESS, DAMPING = 2.0, 5e-3
FRICTION = {
    "coulomb_n_m": COULOMB, "static_n_m": STATIC, "stribeck_rad_s": STRIBECK, "viscous_n_m_s_rad": VISCOUS
}  # fmt: skip
BRISTLE = {"stiffness_n_m_rad": STIFFNESS, "damping_n_m_s_rad": DAMPING}
PERIOD_S = 1e-3
TIME_S = np.arange(500) * PERIOD_S
ELASTIC = [0.0, 0.7]


def _rotor(elastic: float = 0.0, step_s: float = 1e-4, viscous: float = VISCOUS, **tables: dict[str, Any]) -> Plant:
    """The rotor alone, inside a wide free play."""
    bristle = {"bristle": BRISTLE | {"elastic_fraction": elastic}}
    return plant(
        step_s=step_s,
        gear={"backlash_rad": 6.0},
        friction=FRICTION | {"viscous_n_m_s_rad": viscous},
        **(bristle | tables),
    )


def _run(rotor: Plant, torques: NDArray[np.float64], period_s: float = PERIOD_S) -> NDArray[np.float64]:
    """Motor angle, speed and deflection after each period of constant stall torque."""
    states = []
    for torque in torques:
        rotor.advance(VOLTAGE, duty_for_torque(RATIO * torque), round(period_s / rotor.step_s))
        truth = rotor.truth()
        states.append((RATIO * truth.rotor_rad, RATIO * truth.rotor_rad_s, truth.bristle_rad))
    return np.array(states)


def _reference(elastic: float = 0.0, viscous: float = VISCOUS) -> BristledRotor:
    # the back-EMF brakes as viscous friction does
    return BristledRotor(
        ROTOR, viscous + K**2 / RESISTANCE, COULOMB, STATIC, STRIBECK, STIFFNESS, DAMPING, elastic
    )  # fmt: skip


def _loop(amplitude: float) -> NDArray[np.float64]:
    """Torque that swings five times a second: within the bristles' reach, or through slip and reversal."""
    return amplitude * np.sin(2.0 * pi * 5.0 * TIME_S)


@pytest.mark.parametrize("elastic", ELASTIC)
@pytest.mark.parametrize("amplitude", [0.75 * STATIC, 1.5 * STATIC, 6.0 * STATIC])
def test_motion_is_the_references_and_converges_with_the_square_of_the_step(amplitude: float, elastic: float) -> None:
    """Pre-sliding and hysteresis; stick, breakaway, slip and reversal; fast sliding."""
    exact = _reference(elastic).run(_loop(amplitude), PERIOD_S)
    errors = []
    for step_s in (1e-4, 2.5e-5):
        moved = _run(_rotor(elastic, step_s), _loop(amplitude))
        errors.append(np.abs(moved - exact).max(axis=0) / np.abs(exact).max(axis=0))
    assert errors[0][:2].max() < 2e-4
    assert log2(errors[0].max() / errors[1].max()) / 2.0 > 1.8


def test_small_motion_is_a_spring_of_the_bristles_stiffness() -> None:
    held = _rotor(elastic=0.7)
    for torque in (0.3 * STATIC, -0.3 * STATIC, 0.0):
        angle = _run(held, np.full(1000, torque))[-1, 0]
        assert angle == pytest.approx(torque / STIFFNESS, rel=1e-6, abs=1e-12)


def test_pre_sliding_loop_encloses_what_friction_loses() -> None:
    rotor = _rotor()
    angles = np.concatenate([[0.0], _run(rotor, _loop(0.75 * STATIC))[:, 0]])
    began = rotor.energy()
    torques = _loop(0.75 * STATIC)[200:]
    loop = _run(rotor, torques)
    # once around the settled loop (200 periods): stall torque times way, less the back-EMF's and viscous share
    one = slice(99, 299)
    way = np.diff(np.concatenate([[angles[-1]], loop[:, 0]]))
    area = float((torques * way)[one].sum())
    speeds = loop[one, 1]
    linear = (VISCOUS + K**2 / RESISTANCE) * float((speeds**2).sum()) * PERIOD_S
    assert area - linear > 0.1 * STATIC**2 / STIFFNESS
    assert rotor.energy().lost_j > began.lost_j


def _breakaway(rate_n_m_s: float) -> tuple[float, float]:
    """Greatest friction of the joint as its torque is ramped until it slides: (plant, reference)."""
    period_s = 2e-4
    torques = np.arange(0.0, 1.5 * STATIC, rate_n_m_s * period_s)
    reference = _reference()
    runs = _run(_rotor(), torques, period_s), reference.run(torques, period_s)
    plants, references = (max(reference.friction(z, w) - reference.viscous * w for _, w, z in run) for run in runs)
    return plants, references


def test_breakaway_depends_on_the_rate_of_the_ramp_as_in_the_reference() -> None:
    forces = []
    for rate in (0.02, 0.1, 0.5):
        found, wanted = _breakaway(rate)
        assert found == pytest.approx(wanted, rel=2e-4)
        forces.append(found)
    # the bristles of a slow ramp reach the static limit; a fast one slides before they are bent that far
    assert STATIC > forces[0] > 1.01 * forces[1] > 1.02 * forces[2] > COULOMB


def _lag(frequency_hz: float) -> tuple[float, float]:
    """How much more friction there is at speeding up than at slowing down, at one speed: (plant, reference)."""
    cycle = round(1.0 / frequency_hz / PERIOD_S)
    torques = 2.0 * STATIC * (1.0 - 0.6 * np.cos(2.0 * pi * np.arange(3 * cycle) / cycle))
    reference = _reference(viscous=0.01)
    gaps = []
    for states in (_run(_rotor(viscous=0.01), torques), reference.run(torques, PERIOD_S)):
        _, speeds, deflections = states[-cycle:].T
        pairs = zip(speeds, deflections, strict=True)
        friction = np.array([reference.friction(z, w) - reference.viscous * w for w, z in pairs])
        middle = 0.5 * (speeds.min() + speeds.max())
        up, down = (np.interp(middle, *_branch(speeds, friction, rising)) for rising in (True, False))
        gaps.append(float(up - down))
    return gaps[0], gaps[1]


def _branch(
    speeds: NDArray[np.float64], friction: NDArray[np.float64], rising: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    chosen = (np.gradient(speeds) > 0.0) == rising
    order = np.argsort(speeds[chosen])
    return speeds[chosen][order], friction[chosen][order]


def test_friction_lags_behind_the_speed_and_more_so_when_it_changes_faster() -> None:
    gaps = []
    for frequency_hz in (5.0, 20.0):
        found, wanted = _lag(frequency_hz)
        assert found == pytest.approx(wanted, rel=2e-2, abs=1e-3 * COULOMB)
        gaps.append(found)
    assert 0.0 < gaps[0] < gaps[1]


@pytest.mark.parametrize(("elastic", "creeps"), [(0.0, True), (0.7, False)])
def test_only_lugre_creeps_under_a_trembling_torque_below_breakaway(elastic: float, creeps: bool) -> None:
    held = _rotor(elastic)
    tremble = STATIC * (0.3 + 0.25 * np.sin(2.0 * pi * 50.0 * np.arange(1000) * PERIOD_S))
    angles = _run(held, tremble)[:, 0]
    crept = angles[-200:].mean() - angles[200:400].mean()
    assert bool(crept > STATIC / STIFFNESS) is creeps
    assert creeps or abs(crept) < 1e-9


def test_arm_on_bristles_hangs_by_them_and_drags_when_it_slides() -> None:
    """On the arm's side of the free play, and against gravity instead of the motor."""
    moment = 0.2 * G * 0.3
    friction = {"coulomb_n_m": 0.3, "static_n_m": 0.4, "stribeck_rad_s": 0.5}
    bristle = {"stiffness_n_m_rad": 100.0, "damping_n_m_s_rad": 0.5, "elastic_fraction": 0.8}
    arm = plant(gear={"backlash_rad": 6.0}, load={"mass_kg": 0.2}, arm_friction=friction, arm_bristle=bristle)
    arm.place(0.0, 0.2)
    arm.advance(OPEN, 0.0, 20_000)
    truth = arm.truth()
    # gravity's torque is 0.12 N m, and below 0.32 even as it swings: an elastic sag, and nothing but
    assert 100.0 * truth.arm_bristle_rad == pytest.approx(-moment * np.sin(truth.arm_rad), rel=1e-6)
    assert truth.arm_rad - 0.2 == pytest.approx(truth.arm_bristle_rad, rel=1e-9)
    arm.place(0.0, 1.2)
    arm.advance(OPEN, 0.0, 20_000)
    # 0.55 N m: it slid to where its friction holds it
    assert arm.truth().arm_rad < 1.0
    assert abs(moment * np.sin(arm.truth().arm_rad)) <= 0.4


def test_bristles_of_a_steady_slide_carry_the_friction_of_the_curve() -> None:
    """Weight, position and transmitted torque change the bristles' limit as they change rigid friction."""
    tables: dict[str, dict[str, Any]] = {
        "load": {"mass_kg": 0.1, "balanced": True},
        "friction": FRICTION | {"growth_per_n": 0.5},
        "arm_friction": {"viscous_n_m_s_rad": 2e-3},
        "load_friction": {"driving": 0.3},
        "coulomb_asymmetry": {"fraction": 0.1},
    }
    speeds = []
    for bristle in ({}, BRISTLE):
        sliding = plant(bristle=bristle, **tables)
        sliding.advance(VOLTAGE, 0.2, 60_000)
        speeds.append(sliding.truth().rotor_rad_s)
    assert speeds[1] == pytest.approx(speeds[0], rel=1e-6)


def test_static_friction_is_drawn_once_per_stop() -> None:
    scattered = _rotor(scatter={"static_fraction": 0.1})
    factors = set()
    for _ in range(12):
        _run(scattered, np.full(100, 3.0 * STATIC))
        for _ in range(300):
            _run(scattered, np.zeros(1))
            factors.add(float(scattered._state["static_factor"][0]))
    # the one before the first stop, and one for each stop however the bristles swing
    assert len(factors) == 13
