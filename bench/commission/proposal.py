"""Limits, servo, motion and search that are proposed for a joint, out of what was asked and identified."""

from dataclasses import dataclass

from bench.config.sections import Limits, MotionSettings, SearchSettings, ServoSettings
from bench.errors import ConfigurationError
from compensator.motion.servo_design import Loop, ServoDesign, design

SERVO_SHARE, CEILING_SHARE = 0.85, 0.8  # of the current limit: servo, search
BREAKAWAY_A = 0.1  # of the joint that the default rates of the search were chosen on
SPEED_SHARE = 0.6  # of the speed at which the back-EMF alone would take all of the supply
HIGHEST_RAD_S = 8.0
MOVE_SHARE = 0.25  # of the speed limit
SETTLING = 0.12  # of the servo's bandwidth: the share at which a move reaches its speed
ACCELERATION_SHARE = 0.5  # of what the current is enough for beside friction and gravity
HOLD_CYCLES = 1.5  # from a measured position to the current that answers it: a cycle, and half of the next
FREE_SHARE = 0.3  # of the unloaded inertia is the motor's alone, where nobody knows better
TWICE_BEHIND_S = 0.15
LEAST_BAND_COUNTS = 6.0
LEAST_STEP_SHARE = 0.2  # of breakaway, that friction falls by at least as the joint lets go
WIDEST_BAND_RAD = 0.03
CROSSINGS = 4.0  # of the band of friction by the integral, that a joint is given to settle


@dataclass(frozen=True, slots=True)
class Joint:
    """What the proposal goes by; currents are the motor's, angles the joint's.

    Attributes:
        motor_current_a: highest that the motor may have.
        travel_rad: to either side of straight down.
        period_s: control period.
        count_rad: joint angle of an encoder count.
        breakaway_a, coulomb_a, viscous_a_s_rad: friction.
        gravity_a: holds the heaviest load and the arm level.
        inertia_a_s2_rad: current per acceleration without load.
        loaded_a_s2_rad: with the heaviest load.
        no_load_rad_s: speed at which the back-EMF takes all of the supply; inf where it is not known.
        velocity_lag_s: of the drive's velocity.
        loaded_breakaway_a: with the heaviest load; as without where it was not tried.
    """

    motor_current_a: float
    travel_rad: float
    period_s: float
    count_rad: float
    breakaway_a: float
    coulomb_a: float
    viscous_a_s_rad: float
    gravity_a: float
    inertia_a_s2_rad: float
    loaded_a_s2_rad: float
    no_load_rad_s: float
    velocity_lag_s: float
    loaded_breakaway_a: float


@dataclass(frozen=True, slots=True)
class Proposal:
    """Sections of bench.toml."""

    limits: Limits
    motion: MotionSettings
    servo: ServoSettings
    search: SearchSettings
    design: ServoDesign


def propose(joint: Joint, load_kg: float) -> Proposal:
    """The sections.

    Raises:
        ConfigurationError: the motor is too weak for the load, or the loop too slow for any servo.
    """
    limit_a = joint.motor_current_a
    servo_a, ceiling_a = SERVO_SHARE * limit_a, CEILING_SHARE * limit_a
    needed_a = joint.gravity_a + joint.loaded_breakaway_a
    if needed_a > ceiling_a:
        raise ConfigurationError(
            f"the motor needs {needed_a:.3g} A to lift {1e3 * load_kg:g} g from level against friction, and of the "
            f"{limit_a:g} A that it may have, {ceiling_a:.3g} A are for the search; hang less, shorten the arm, or "
            "allow more current"
        )
    found = design(_loop(joint))
    speed_rad_s = min(HIGHEST_RAD_S, SPEED_SHARE * joint.no_load_rad_s)
    spare_a = servo_a - joint.gravity_a - joint.coulomb_a
    move_rad_s = min(MOVE_SHARE * speed_rad_s, 2.0)
    # no quicker than the servo follows: a joint that overshoots comes to rest at the edge of friction
    followed = SETTLING * found.bandwidth_rad_s * move_rad_s
    acceleration = min(ACCELERATION_SHARE * spare_a / joint.loaded_a_s2_rad, followed)
    dead_band_rad = _dead_band_rad(joint, found.gains.proportional_a_rad)
    # the integral crosses the whole band of friction from just outside of the dead-band
    crossing_s = 2.0 * joint.loaded_breakaway_a / (found.gains.integral_a_rad_s * dead_band_rad)
    rate = joint.breakaway_a / BREAKAWAY_A
    plain = SearchSettings()
    return Proposal(
        limits=Limits(
            position_min_rad=-joint.travel_rad, position_max_rad=joint.travel_rad, speed_rad_s=_digits(speed_rad_s),
            current_a=limit_a, sample_age_s=TWICE_BEHIND_S, load_kg=load_kg,
        ),
        motion=MotionSettings(
            speed_rad_s=_digits(move_rad_s), acceleration_rad_s2=_digits(acceleration),
            settle_timeout_s=_digits(min(max(CROSSINGS * crossing_s, 10.0), 40.0)),
        ),
        servo=ServoSettings(
            proportional_a_rad=_digits(found.gains.proportional_a_rad),
            integral_a_rad_s=_digits(found.gains.integral_a_rad_s),
            derivative_a_s_rad=_digits(found.gains.derivative_a_s_rad),
            dead_band_rad=_digits(dead_band_rad),
            current_a=_digits(servo_a),
        ),
        search=plain.model_copy(
            update={
                "ceiling_a": _digits(ceiling_a),
                "current_step_a": _digits(rate * plain.current_step_a),
                "coarse_rate_a_s": _digits(rate * plain.coarse_rate_a_s),
                "fine_rates_a_s": tuple(_digits(rate * one) for one in plain.fine_rates_a_s),
            }
        ),
        design=found,
    )  # fmt: skip


def _dead_band_rad(joint: Joint, proportional_a_rad: float) -> float:
    """At least the jump of the joint at breakaway, when friction falls from its static to its Coulomb value.

    A narrower one makes the servo hunt (Armstrong-Helouvry, Dupont, Canudas de Wit 1994, section 4.1).
    """
    grown = joint.loaded_breakaway_a / joint.breakaway_a
    step_a = grown * max(joint.breakaway_a - joint.coulomb_a, LEAST_STEP_SHARE * joint.breakaway_a)
    least_rad = max(ServoSettings().dead_band_rad, LEAST_BAND_COUNTS * joint.count_rad)
    return min(max(least_rad, step_a / proportional_a_rad), WIDEST_BAND_RAD)


def _loop(joint: Joint) -> Loop:
    inertias = (joint.inertia_a_s2_rad, max(joint.loaded_a_s2_rad, joint.inertia_a_s2_rad))
    delay_s = HOLD_CYCLES * joint.period_s
    free = FREE_SHARE * joint.inertia_a_s2_rad
    return Loop(inertias, free, max(joint.viscous_a_s_rad, 0.0), delay_s, joint.velocity_lag_s)


def _digits(value: float) -> float:
    """Three digits: no more is known."""
    return float(f"{value:.3g}")
