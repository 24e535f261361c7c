"""The load that a motor current reflects, by the torque constant, the gear ratio and the lever of the rig."""

from math import copysign, pi, sin

from bench.config.rig import Rig
from bench.errors import ConfigurationError

STANDARD_GRAVITY_M_S2 = 9.80665
LEAST_LEVER = 0.1  # of the arm's length; below, gravity has no moment worth dividing by


def reflected_load_kg(load_current_a: float, angle_rad: float, rig: Rig) -> float | None:
    """Mass at the tip [kg] that a friction-compensated current holds up at an angle; None near angle 0.

        m g L sin(q) = I Kt N - (arm's own moment) g sin(q)

    Raises:
        ConfigurationError: the rig leaves out the torque constant, the gear ratio or the arm's length.
    """
    torque_n_m_a, length_m = _lever(rig)
    if abs(sin(angle_rad)) < LEAST_LEVER:
        return None
    moment_kg_m = load_current_a * torque_n_m_a / (STANDARD_GRAVITY_M_S2 * sin(angle_rad))
    return (moment_kg_m - _own_moment_kg_m(rig)) / length_m


def load_current_a(load_kg: float, angle_rad: float, rig: Rig) -> float:
    """The inverse: motor current [A] of a mass at the tip, and of the arm's own moment, at an angle. No friction.

    Raises:
        ConfigurationError: as `reflected_load_kg`.
    """
    torque_n_m_a, length_m = _lever(rig)
    moment_kg_m = load_kg * length_m + _own_moment_kg_m(rig)
    return moment_kg_m * STANDARD_GRAVITY_M_S2 * sin(angle_rad) / torque_n_m_a


def per_kg_a(rig: Rig) -> float:
    """Current that a kilogram more takes at 90 degrees [A/kg]. Errors as `load_current_a`."""
    return load_current_a(1.0, pi / 2, rig) - load_current_a(0.0, pi / 2, rig)


def arm_angle_rad(position_rad: float, load_current_a: float, rig: Rig) -> float:
    """Angle of the arm [rad] behind the free play, which a load closes on one side; the sensor is before it.

    Args:
        position_rad: by the sensor; its zero lies in the middle of the free play.
        load_current_a: of the load; none leaves the arm anywhere within the free play, in the middle on average.
        rig: free play that it leaves out counts as none.
    """
    if load_current_a == 0.0:
        return position_rad
    return position_rad - copysign((rig.gear.backlash_rad or 0.0) / 2.0, load_current_a)


def _own_moment_kg_m(rig: Rig) -> float:
    return (rig.arm.mass_kg or 0.0) * (rig.arm.centre_of_mass_m or 0.0)


def torque_n_m_a(rig: Rig) -> float:
    """Torque at the joint per motor current [N m/A].

    Raises:
        ConfigurationError: the rig leaves out the torque constant or the gear ratio.
    """
    return _lever(rig)[0]


def _lever(rig: Rig) -> tuple[float, float]:
    """Torque at the joint per motor current [N m/A], and the arm's length [m]."""
    torque_constant, ratio, length_m = rig.motor.torque_constant_n_m_a, rig.gear.ratio, rig.arm.length_m
    if torque_constant is None or ratio is None or length_m is None:
        raise ConfigurationError(
            f"rig '{rig.name}': a reflected load needs motor.torque_constant_n_m_a, gear.ratio and arm.length_m; add "
            "what is missing to the rig, or have it found: commission the joint first"
        )
    return torque_constant * ratio, length_m
