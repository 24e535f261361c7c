"""How the joint of a fitted model moves: its base effects as an equation of motion.

What the model has beyond inertia, gravity, offset and friction of sliding hardly changes where a servo takes the joint.
"""

from dataclasses import dataclass
from math import copysign, exp, sin

from bench.config.rig import Rig
from bench.study.errors import StudyError
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.facts import STANDARD_GRAVITY_M_S2

LEAST_INERTIA = 0.3  # of what the rig says; less was lost to effects that motion does not tell apart from it


@dataclass(frozen=True, slots=True)
class Drive:
    """Effort per motor current and joint speed: torque constant, or winding and back-EMF where effort is a voltage."""

    per_a: float
    per_rad_s: float

    def effort(self, current_a: float, velocity_rad_s: float) -> float:
        """Effort of a current [A] at a speed [rad/s]."""
        return self.per_a * current_a + self.per_rad_s * velocity_rad_s


@dataclass(frozen=True, slots=True)
class Dynamics:
    """Equation of motion of a joint, all in the study's unit of effort.

    Attributes:
        drive: what a current is worth.
        inertia, load_inertia: per rad/s2, and per rad/s2 and kg m2 of the load.
        gravity, load_gravity: at 90 degrees, and per N m of the load's moment.
        offset, coulomb, viscous, excess, stribeck_rad_s, exponent: friction.
        arm_m: axis to the load.
    """

    drive: Drive
    inertia: float
    load_inertia: float
    gravity: float
    load_gravity: float
    offset: float
    coulomb: float
    viscous: float
    excess: float
    stribeck_rad_s: float
    exponent: float
    arm_m: float

    def step(
        self, position: float, velocity: float, current_a: float, load_kg: float, moment_kg: float, step_s: float
    ) -> tuple[float, float]:
        """Position and velocity after a step; friction holds a joint that it can hold (implicit, so it never chatters).

        Args:
            position: before it [rad].
            velocity: before it [rad/s].
            current_a: of the motor.
            load_kg: that is moved.
            moment_kg: of that, what gravity pulls at.
            step_s: length.
        """
        inertia = self.inertia + self.load_inertia * load_kg * self.arm_m**2
        weight = self.gravity + self.load_gravity * moment_kg * STANDARD_GRAVITY_M_S2 * self.arm_m
        pull = self.drive.effort(current_a, velocity) - weight * sin(position) - self.offset - self.viscous * velocity
        free = velocity + step_s * pull / inertia
        dry = self.coulomb + self.excess * exp(-((abs(velocity) / self.stribeck_rad_s) ** self.exponent))
        after = copysign(max(abs(free) - step_s * dry / inertia, 0.0), free)
        return position + step_s * after, after


def dynamics_of(fit: Fit, rig: Rig) -> Dynamics:
    """The equation of motion of a fitted model.

    Raises:
        StudyError: neither model nor rig tells the inertia, or the rig does not say what a current is worth.
    """
    found = {term.effect.name: term for term in fit.terms}
    drive = drive_of(fit, rig)
    own, of_load = _inertia(fit, rig, drive)
    gravity, stribeck = found.get("gravity"), found.get("stribeck")

    def first(name: str) -> float:
        return float(found[name].coefficients[0]) if name in found else 0.0

    speed, exponent = (1.0, 1.0) if stribeck is None else stribeck.shape
    return Dynamics(
        drive=drive,
        inertia=own,
        load_inertia=of_load,
        gravity=0.0 if gravity is None else float(gravity.coefficients[0]),
        load_gravity=0.0 if gravity is None else float(gravity.coefficients[1]),
        offset=first("offset"),
        coulomb=first("coulomb"),
        viscous=first("viscous"),
        excess=first("stribeck"),
        stribeck_rad_s=speed,
        exponent=exponent,
        arm_m=rig.arm.length_m or 0.0,
    )


def _inertia(fit: Fit, rig: Rig, drive: Drive) -> tuple[float, float]:
    """Effort per acceleration, and per acceleration and kg m2 of the load; the rig's where the trials tell less."""
    term = next((term for term in fit.terms if term.effect.name == "inertia"), None)
    fitted = (0.0, 0.0) if term is None else (float(term.coefficients[0]), float(term.coefficients[1]))
    told = _rig_inertia(rig, drive)
    if fitted[0] > LEAST_INERTIA * told[0]:
        return fitted
    if told[0] > 0.0:
        return told
    raise StudyError(
        "what a trial would show cannot be computed: neither the model nor the rig tells the inertia; let the model "
        "have the effect inertia and record motion that accelerates, or add arm.inertia_kg_m2 to the rig"
    )


def _rig_inertia(rig: Rig, drive: Drive) -> tuple[float, float]:
    """The same from rotor, gear and arm; zero where the rig leaves out what is needed."""
    constant, ratio, arm = rig.motor.torque_constant_n_m_a, rig.gear.ratio, rig.arm.inertia_kg_m2
    if constant is None or ratio is None or arm is None:
        return 0.0, 0.0
    per_n_m = drive.per_a / (constant * ratio)
    return per_n_m * (arm + (rig.motor.rotor_inertia_kg_m2 or 0.0) * ratio**2), per_n_m


def drive_of(fit: Fit, rig: Rig) -> Drive:
    """What a motor current is worth in the effort of a fitted model.

    Raises:
        StudyError: the rig does not say.
    """
    effort = fit.dataset.effort_definition
    motor, ratio = rig.motor, rig.gear.ratio
    if effort.quantity in ("current", "current_estimate"):
        return Drive(effort.factor, 0.0)
    if effort.quantity == "torque" and motor.torque_constant_n_m_a is not None and ratio is not None:
        return Drive(motor.torque_constant_n_m_a * ratio, 0.0)
    known = motor.resistance_ohm is not None and motor.back_emf_v_s_rad is not None and ratio is not None
    if effort.quantity == "terminal_voltage" and known:
        # the back-EMF is in the model's viscous term: effort and friction both hold it
        return Drive(motor.resistance_ohm or 0.0, (motor.back_emf_v_s_rad or 0.0) * (ratio or 0.0))
    raise StudyError(
        f"what a trial would show cannot be computed: the rig does not say what {effort.title} a motor current makes; "
        "add motor.torque_constant_n_m_a and gear.ratio (or resistance and back-EMF constant) to the rig"
    )
