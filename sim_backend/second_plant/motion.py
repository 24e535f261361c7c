"""Equations of motion: rotor and arm, rigid or with a twisting, gapped gear; hanging cable and swinging tip.

Positions drift by half steps, speeds are kicked by Heun's rule in between (Strang splitting; Hairer, Lubich, Wanner
2006, section II.5): second order, and without drift of the energy where nothing is lost.
"""

from math import copysign, cos, sin, tanh
from typing import NamedTuple

from sim_backend.second_plant.compiled import compiled
from sim_backend.second_plant.friction import flow_n_m
from sim_backend.second_plant.physics import GRAVITY_M_S2, Physics

CABLE_DAMPING, TIP_DAMPING = 0.05, 0.03  # of critical
SETTLING = 20  # passes to where the spring carries the weight: the twist is small


class Places(NamedTuple):
    """Angles of rotor and arm, of the tip on its spring, and of the cable off the vertical [rad]."""

    rotor: float
    arm: float
    tip: float
    cable: float


class Speeds(NamedTuple):
    """Their rates [rad/s]."""

    rotor: float
    arm: float
    tip: float
    cable: float


@compiled
def drifted(at: Places, speeds: Speeds, step_s: float) -> Places:
    """Places after a step of constant speed."""
    return Places(
        at.rotor + step_s * speeds.rotor,
        at.arm + step_s * speeds.arm,
        at.tip + step_s * speeds.tip,
        at.cable + step_s * speeds.cable,
    )


@compiled
def coupling_n_m(p: Physics, at: Places, speeds: Speeds) -> float:
    """Torque that the gear passes on to the arm: a spring and damper beyond half of the gap to either side."""
    twist, half = at.rotor - at.arm, 0.5 * p.gap_rad
    if abs(twist) <= half:
        return 0.0
    beyond = twist - half if twist > 0.0 else twist + half
    torque = p.stiffness_n_m_rad * beyond + p.coupling_n_m_s * (speeds.rotor - speeds.arm)
    if p.gap_rad > 0.0:  # flanks push, they do not pull
        return max(torque, 0.0) if beyond > 0.0 else min(torque, 0.0)
    return torque


@compiled
def load_n_m(p: Physics, at: Places, speeds: Speeds) -> float:
    """Torque that the arm at rest would need: weight, springs, cable and tip."""
    torque = p.moment_n_m * sin(at.arm + p.centre_rad) + p.spring_n_m_rad * (at.arm - p.spring_zero_rad)
    if p.cable_kg_m > 0.0:
        torque -= p.cable_kg_m * GRAVITY_M_S2 * at.cable * cos(at.arm)
    if p.tip_kg_m2 > 0.0:
        rate = p.tip_rad_s
        torque += p.tip_kg_m2 * (rate * rate * (at.arm - at.tip) + 2.0 * TIP_DAMPING * rate * (speeds.arm - speeds.tip))
    return torque


@compiled
def resting_at(p: Physics, rotor_rad: float) -> Places:
    """Places at rest: the arm hangs on the spring, on one side of the gap, behind a rotor that is held."""
    at = Places(rotor_rad, rotor_rad, rotor_rad, 0.0)
    if p.stiffness_n_m_rad > 0.0:
        for _ in range(SETTLING):
            load = load_n_m(p, at, Speeds(0.0, 0.0, 0.0, 0.0))
            flank = copysign(0.5 * p.gap_rad, load) if load != 0.0 else 0.0
            arm = rotor_rad - load / p.stiffness_n_m_rad - flank
            at = Places(rotor_rad, arm, arm, 0.0)
    return at


@compiled
def accelerations(p: Physics, at: Places, speeds: Speeds, motor_n_m: float) -> tuple[Speeds, float]:
    """Accelerations [rad/s^2] and the torque passed on to the arm [N m].

    Args:
        p: the joint.
        at: places.
        speeds: rates.
        motor_n_m: torque of the motor less its bristle friction.
    """
    load, flow = load_n_m(p, at, speeds), flow_n_m(p, speeds.rotor)
    if p.stiffness_n_m_rad > 0.0:
        passed = coupling_n_m(p, at, speeds)
        rotor, arm = (motor_n_m - flow - passed) / p.rotor_kg_m2, (passed - load) / p.arm_kg_m2
    else:
        rotor = (motor_n_m - flow - load) / (p.rotor_kg_m2 + p.arm_kg_m2)
        arm, passed = rotor, load + p.arm_kg_m2 * rotor
    tip = p.tip_rad_s * (p.tip_rad_s * (at.arm - at.tip) + 2.0 * TIP_DAMPING * (speeds.arm - speeds.tip))
    cable = 0.0
    if p.cable_kg_m > 0.0:
        rate = p.cable_rad_s
        pull = rate * rate / GRAVITY_M_S2 * cos(at.arm) * arm  # of its point of suspension, taken at unit radius
        cable = -rate * rate * at.cable - 2.0 * CABLE_DAMPING * rate * speeds.cable - 0.3 * pull
    return Speeds(rotor, arm, tip, cable), passed


@compiled
def kicked(p: Physics, at: Places, speeds: Speeds, motor_n_m: float, step_s: float) -> tuple[Speeds, float, float]:
    """Speeds after a step at fixed places; the rotor's acceleration and the torque passed on."""
    first, _ = accelerations(p, at, speeds, motor_n_m)
    guess = Speeds(
        speeds.rotor + step_s * first.rotor,
        speeds.arm + step_s * first.arm,
        speeds.tip + step_s * first.tip,
        speeds.cable + step_s * first.cable,
    )
    second, passed = accelerations(p, at, guess, motor_n_m)
    half = 0.5 * step_s
    rates = Speeds(
        speeds.rotor + half * (first.rotor + second.rotor),
        speeds.arm + half * (first.arm + second.arm),
        speeds.tip + half * (first.tip + second.tip),
        speeds.cable + half * (first.cable + second.cable),
    )
    return rates, 0.5 * (first.rotor + second.rotor), passed


@compiled
def seal_n_m(p: Physics, deflection: float) -> float:
    """Drag of a seal lip that gives way like a spring and recovers with time."""
    return p.seal_n_m * tanh(deflection / p.seal_rad)
