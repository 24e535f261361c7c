"""Checks of what is asked against the limits of the bench, before anything moves."""

from collections.abc import Iterable
from math import pi, radians

from bench.config.configuration import BenchConfiguration
from bench.control.servo import closes_positions_alone
from bench.errors import ConfigurationError, LimitError, OutOfRange, ParameterError, quantity_message
from bench.experiments.parts.profile import Trapezoid
from drivers.contract import Description, Mode

LONGEST_MOVE_S = 600.0
MOST_TRIALS = 5000  # of an experiment
LONGEST_PLAYED_S = 7200.0  # of a motion whose every value is known before: two hours at 1 kHz are 58 MB


def refuse_coasting(configuration: BenchConfiguration) -> None:
    """Raise `ConfigurationError` where a joint without power would not coast: its drive sets the brake by itself."""
    if configuration.drive.brake.by == "drive":
        raise ConfigurationError(
            "the joint is to coast with the power off, and drive.brake.by is 'drive': its drive would set the brake "
            "while it moves. Have it coast at a current of 0 (coast-down: released = 'current'), or the bench set the "
            "brake ('output')"
        )


def refuse_many(trials: int, of: str) -> None:
    """Raise `ParameterError` for an experiment of more trials than anybody records; `of` says what they come from."""
    if trials > MOST_TRIALS:
        raise ParameterError(f"{of} make {trials} trials; allowed are {MOST_TRIALS}. Run several experiments")


def refuse_long_play(name: str, duration_s: float) -> None:
    """Raise `LimitError` for a motion of more values than are kept at once."""
    if duration_s > LONGEST_PLAYED_S:
        message = quantity_message(name, duration_s, f"at most {LONGEST_PLAYED_S:g}", "s", "Play it several times")
        raise LimitError(message, OutOfRange(name, duration_s, "s", high=LONGEST_PLAYED_S))


def refuse_load(name: str, load_kg: float, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for a load heavier than the bench carries."""
    limit_kg = configuration.limits.load_kg
    if load_kg > limit_kg:
        step = "Hang a lighter load"
        if load_kg >= 1.0 and load_kg * 1e-3 <= limit_kg:
            step = f"Are grams meant? {load_kg:g} g are {load_kg * 1e-3:g} kg"
        message = quantity_message(name, load_kg, f"at most {limit_kg:g}", "kg", step)
        raise LimitError(message, OutOfRange(name, load_kg, "kg", high=limit_kg))


def refuse_angles(name: str, angles_rad: Iterable[float], margin_rad: float, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for angles that, with a margin for what the motion may overshoot, leave the allowed range."""
    limits = configuration.limits
    low_rad, high_rad = limits.position_min_rad + margin_rad, limits.position_max_rad - margin_rad
    for angle_rad in angles_rad:
        if not low_rad <= angle_rad <= high_rad:
            allowed, why = f"{low_rad:.4g} .. {high_rad:.4g}", f"the limits less a margin of {margin_rad:.4g} rad"
            meant_rad = radians(angle_rad)
            degrees_meant = abs(angle_rad) > 2.0 * pi and low_rad <= meant_rad <= high_rad
            step = f"Are degrees meant? {angle_rad:g} degrees are {meant_rad:.4g} rad" if degrees_meant else ""
            message = quantity_message(name, angle_rad, allowed, "rad", step, why)
            raise LimitError(message, OutOfRange(name, angle_rad, "rad", low_rad, high_rad, margin_rad))


def refuse_short(name: str, way_rad: float, least_rad: float, why: str) -> None:
    """Raise `LimitError` for a way that is too short to tell anything; `why` says what the least is."""
    if way_rad < least_rad:
        message = quantity_message(name, way_rad, f"at least {least_rad:.3g}", "rad", why=why)
        raise LimitError(message, OutOfRange(name, way_rad, "rad", low=least_rad))


def refuse_speed(name: str, speed_rad_s: float, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for a speed above the limit."""
    limit_rad_s = configuration.limits.speed_rad_s
    if speed_rad_s > limit_rad_s:
        message = quantity_message(name, speed_rad_s, f"at most {limit_rad_s:g}", "rad/s")
        raise LimitError(message, OutOfRange(name, speed_rad_s, "rad/s", high=limit_rad_s))


def refuse_slow_move(name: str, speed_rad_s: float, way_rad: float, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for a speed at which a move would seem to have no end."""
    duration_s = Trapezoid(0.0, way_rad, speed_rad_s, configuration.motion.acceleration_rad_s2).duration_s
    if duration_s > LONGEST_MOVE_S:
        raise LimitError(
            f"{name} is {speed_rad_s:g} rad/s: a move of {way_rad:.4g} rad would take {duration_s:.4g} s; "
            f"allowed is at most {LONGEST_MOVE_S:g} s. Choose a higher speed or acceleration"
        )


def refuse_currents(configuration: BenchConfiguration) -> None:
    """Raise `LimitError` where the servo or the search may ask for more current than the limit."""
    limit_a = configuration.limits.current_a
    for name, asked_a in (
        ("servo.current_a", configuration.servo.current_a),
        ("search.ceiling_a", configuration.search.ceiling_a),
    ):
        if asked_a > limit_a:
            step = "Correct the bench configuration"
            raise LimitError(quantity_message(name, asked_a, f"at most limits.current_a, {limit_a:g}", "A", step))


def refuse_servo(configuration: BenchConfiguration) -> None:
    """Raise `LimitError` where moving from place to place may be faster, or ask for more current, than the limits."""
    refuse_speed("motion.speed_rad_s", configuration.motion.speed_rad_s, configuration)
    refuse_currents(configuration)


def refuse_duty(name: str, duty: float, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for a duty that drives more current than the limit through a joint that stands."""
    limit_a, rig = configuration.limits.current_a, configuration.rig
    if rig.supply.voltage_v is None or rig.motor.resistance_ohm is None:
        return
    limit = limit_a * rig.motor.resistance_ohm / rig.supply.voltage_v
    if duty > limit:
        allowed = f"at most {limit:.4g}, which is limits.current_a, {limit_a:g} A, while the joint stands"
        raise LimitError(quantity_message(name, duty, allowed, ""))


def refuse_modes(kind: str, wanted: frozenset[Mode], drive: Description) -> None:
    """Raise `LimitError` where a drive lacks a mode that an experiment needs of the drive itself."""
    # a current is asked for as a duty, by eq. (3), or as a torque
    there = drive.modes | ({Mode.CURRENT} if drive.modes & {Mode.DUTY, Mode.TORQUE} else set())
    missing = sorted(mode.value for mode in wanted - there)
    if missing:
        names = ", ".join(sorted(mode.value for mode in drive.modes))
        others = "a position" if closes_positions_alone(drive) else "a current or a position, which every drive can do"
        raise LimitError(
            f"{kind} needs the mode {' and '.join(missing)} of the drive, and drive '{drive.device}' has {names}; "
            f"choose an experiment that asks for {others}"
        )
