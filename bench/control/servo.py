"""The position servo, and the current servo of drives without a current mode."""

from math import isnan, nan

from bench.config.rig import Rig
from bench.config.sections import SearchSettings, ServoSettings
from bench.errors import ConfigurationError
from compensator.motor import dc_motor as motor
from compensator.motor.dc_motor import MotorConstants
from drivers.contract import Description, Mode, Sample

COPPER_PER_K = 0.00393  # growth of a copper winding's resistance; for a rig that does not tell


class PositionServo:
    """PID on position, with a dead-band (paper, section 3.2.2).

    Within the dead-band the error counts as zero, so the integral stands and with it the steady current: whatever
    value friction happens to allow. That is the paper's Fig. 4.
    """

    def __init__(self, settings: ServoSettings, period_s: float) -> None:
        self._period_s = period_s
        self._integral_a = 0.0
        self.use(settings)

    def use(self, settings: ServoSettings) -> None:
        """Go on with other gains."""
        self.settings = settings
        # at hand: pydantic takes 0.1 us to find a field
        self._gains = (settings.proportional_a_rad, settings.integral_a_rad_s, settings.derivative_a_s_rad)
        self._dead_band_rad, self._limit_a = settings.dead_band_rad, settings.current_a

    def reset(self, current_a: float = 0.0) -> None:
        """Start anew, from the current that flows now."""
        self._integral_a = current_a

    def current_a(
        self, target_rad: float, position_rad: float, velocity_rad_s: float, target_velocity_rad_s: float = 0.0
    ) -> float:
        """One control cycle: the current to ask for [A]."""
        proportional_a_rad, integral_a_rad_s, derivative_a_s_rad = self._gains
        error_rad = target_rad - position_rad
        if -self._dead_band_rad <= error_rad <= self._dead_band_rad:
            error_rad = 0.0
        limit_a = self._limit_a
        integral_a = self._integral_a + integral_a_rad_s * error_rad * self._period_s
        wanted_a = (
            integral_a + proportional_a_rad * error_rad + derivative_a_s_rad * (target_velocity_rad_s - velocity_rad_s)
        )
        clipped_a = _within(wanted_a, limit_a)
        # anti-windup: while the output is clipped, the integral may only come back
        if clipped_a == wanted_a or (wanted_a - clipped_a) * error_rad < 0.0:
            self._integral_a = _within(integral_a, limit_a)
        return clipped_a


class CurrentServo:
    """Eq. (3) both ways: current from duty and speed, and the duty that gives a wanted current.

    By the supply that is measured, where it is; and by the motor as warm as it is, where the drive measures a
    temperature and the rig says at which its constants hold. A temperature of the housing stands for the winding's.

    Args:
        rig: its resistance and back-EMF constant are needed; the supply voltage only where it is not measured.

    Raises:
        ConfigurationError: the rig leaves out a value that is needed.
    """

    def __init__(self, rig: Rig) -> None:
        resistance_ohm, back_emf_v_s_rad = rig.motor.resistance_ohm, rig.motor.back_emf_v_s_rad
        if resistance_ohm is None or back_emf_v_s_rad is None or rig.gear.ratio is None:
            raise ConfigurationError(
                f"rig '{rig.name}': the paper's eq. (3) needs motor.resistance_ohm, motor.back_emf_v_s_rad and "
                "gear.ratio; add what is missing to the rig"
            )
        self._motor = MotorConstants(resistance_ohm, back_emf_v_s_rad)
        self._ratio = rig.gear.ratio
        self._nominal_supply_v = rig.supply.voltage_v
        self._reference_c = rig.motor.constants_at_c
        told = rig.motor.copper_per_k
        self._copper_per_k = COPPER_PER_K if told is None else told
        self._magnet_per_k = rig.motor.magnet_per_k or 0.0

    def _warm_motor(self, sample: Sample) -> MotorConstants:
        if self._reference_c is None or isnan(sample.temperature_c):
            return self._motor
        return motor.at_temperature(
            self._motor, sample.temperature_c, self._reference_c, self._copper_per_k, self._magnet_per_k
        )

    def _supply_v(self, sample: Sample) -> float:
        measured_v = sample.supply_v
        if measured_v == measured_v:  # not NaN
            return measured_v
        if self._nominal_supply_v is None:
            raise ConfigurationError("the drive does not measure its supply: add supply.voltage_v [V] to the rig")
        return self._nominal_supply_v

    def estimate_a(self, sample: Sample, velocity_rad_s: float) -> float:
        """Motor current of a sample [A], eq. (3). The velocity is the joint's."""
        return motor.current_a(
            self._warm_motor(sample), sample.duty, velocity_rad_s * self._ratio, self._supply_v(sample)
        )

    def duty(self, current_a: float, sample: Sample, velocity_rad_s: float) -> float:
        """Duty that gives a current [A], eq. (3) inverted, within -1 .. 1."""
        supply_v = self._supply_v(sample)
        if supply_v <= 0.0:
            return 0.0  # no duty gives any current; what is wrong with the supply is the drive's to say
        return _within(motor.duty(self._warm_motor(sample), current_a, velocity_rad_s * self._ratio, supply_v), 1.0)


def _within(value: float, limit: float) -> float:
    """A value clipped to -limit .. limit."""
    if value > limit:
        return limit
    return -limit if value < -limit else value


def current_servo(rig: Rig) -> CurrentServo | None:
    """The current servo of a rig; None where it lacks what eq. (3) needs, as drives with a current mode can do."""
    known = (rig.motor.resistance_ohm, rig.motor.back_emf_v_s_rad, rig.gear.ratio)
    return None if None in known else CurrentServo(rig)


def check_modes(settings: ServoSettings, drive: Description) -> None:
    """Refuse a position loop that the drive does not close, or that the bench cannot close.

    Raises:
        ConfigurationError: naming the modes that it has, and what to set.
    """
    if not drive.modes:
        raise ConfigurationError(without_mode(drive))
    names = ", ".join(sorted(mode.value for mode in drive.modes))
    if settings.closed_by == "drive" and Mode.POSITION not in drive.modes:
        raise ConfigurationError(
            f"servo.closed_by is 'drive', and drive '{drive.device}' has no position mode (it has {names}); "
            "set servo.closed_by = 'bench'"
        )
    if settings.closed_by == "bench" and closes_positions_alone(drive):
        raise ConfigurationError(
            f"servo.closed_by is 'bench', and drive '{drive.device}' takes neither current nor duty (it has {names}); "
            "set servo.closed_by = 'drive'"
        )


def without_mode(drive: Description) -> str:
    """What is wrong with a drive that can be asked for nothing, and what to do."""
    remedy = "'friction-bench doctor' says of each why"
    if drive.untold is not None and drive.untold.takes:
        remedy = drive.untold.remedy
    return f"drive '{drive.device}' has no mode that can be used: {remedy}"


def held_back(servo: ServoSettings, search: SearchSettings, drive: Description) -> str:
    """That a drive allows less current than this bench may ask for, in words; "" where it does not."""
    wanted_a = {
        "servo.current_a": servo.current_a, "search.ceiling_a": search.ceiling_a,
    }  # fmt: skip
    limit = drive.own_limit
    above = [] if limit is None else [f"{name} is {one:g} A" for name, one in wanted_a.items() if one > limit.current_a]
    return "" if limit is None or not above else f"{limit.words.removesuffix('.')} ({' and '.join(above)})"


def closes_positions_alone(drive: Description) -> bool:
    """Whether a drive can be asked for positions and for nothing else."""
    return drive.modes == {Mode.POSITION}


def torque_constant_n_m_a(rig: Rig) -> float:
    """What makes a torque of a current, for drives that take torques [N m/A]; NaN where the rig leaves it out."""
    return nan if rig.motor.torque_constant_n_m_a is None else rig.motor.torque_constant_n_m_a
