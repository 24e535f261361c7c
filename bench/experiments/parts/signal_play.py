"""A signal played cycle by cycle: a position that the servo follows, or a current or duty that the motor is given."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import unit_of
from bench.control.cycle import Procedure, Reading
from bench.errors import LimitError, quantity_message
from bench.experiments.parts.excursion import BRAKING_SHARE, Excursion
from bench.experiments.parts.joint import Joint, Part
from bench.experiments.parts.profile import SetPoint
from bench.experiments.parts.refusal import refuse_angles, refuse_duty, refuse_servo
from bench.json_types import Value
from compensator.lab.recordings.recording import FloatArray
from drivers.contract import Command, Mode

Quantity = Literal["position_rad", "current_a", "duty"]
OVERSHOOT_RAD = 0.1  # of the servo, at most
PLAYED_RESULTS = {
    "played_s": "how long the signal was played",
    "travel_rad": "from the lowest to the highest position",
    "peak_speed_rad_s": "highest speed",
    "peak_current_a": "highest current",
    "rms_current_a": "root mean square of the current",
    "rms_tracking_error_rad": "root mean square of position less set point, where a position is followed",
    "ended_early": "why the signal was not played to its end; empty where it was",
}
"""What the results of a trial are that plays a signal."""
MODES = {"current_a": Mode.CURRENT, "duty": Mode.DUTY}


@dataclass(frozen=True, slots=True)
class Signal:
    """What is played.

    Attributes:
        quantity: what the values are; its unit is in its name, a duty is a share of the supply.
        values: one per control period, shape (n,).
        excursion_rad: farthest from angle 0 that a current or duty may drive the joint; None: what the limits leave.
    """

    quantity: Quantity
    values: FloatArray
    excursion_rad: float | None = None


def play(configuration: BenchConfiguration, signal: Signal) -> Procedure:
    """The procedure: to the first position (or angle 0), through the signal, and to rest at angle 0.

    A current or duty leaves the joint free: before it leaves the excursion, it is braked, and the signal ends there.

    Results:
        played_s: of the signal.
        ended_early: why it was not played to its end; "" where it was.
        peak_speed_rad_s, peak_current_a, rms_current_a, travel_rad: of the joint and the motor, while it was played.
        rms_tracking_error_rad: of a position.
    """
    joint = Joint(configuration)
    acceleration = BRAKING_SHARE * configuration.motion.acceleration_rad_s2
    start_rad = float(signal.values[0]) if signal.quantity == "position_rad" else 0.0
    yield from joint.wake()
    yield from joint.rest_at(start_rad)
    reason = ""
    if signal.quantity == "position_rad":
        readings = yield from joint.follow(set_points(signal, configuration), ("signal", "begin"))
    else:
        readings, reason = yield from _push(joint, signal, configuration)
        yield from joint.brake(acceleration)
    yield from joint.rest_at(0.0)
    return _results(signal, readings, configuration) | {"ended_early": reason}


def set_points(signal: Signal, configuration: BenchConfiguration) -> list[SetPoint]:
    """Position and speed of every cycle."""
    velocity_rad_s = np.gradient(signal.values, configuration.control.period_s)
    return [SetPoint(*point) for point in np.column_stack([signal.values, velocity_rad_s]).tolist()]


def _push(joint: Joint, signal: Signal, configuration: BenchConfiguration) -> Part[tuple[list[Reading], str]]:
    """The readings, and why it ended early."""
    excursion = Excursion.of(configuration, reach_rad=signal.excursion_rad)
    mode, readings = MODES[signal.quantity], []
    event: tuple[str, str] | None = ("signal", "begin")
    for value in signal.values.tolist():
        readings.append((yield from joint.push(Command(mode, value), event)))
        event = None
        if reason := excursion.used_up(readings[-1]):
            return readings, reason
    return readings, ""


def _results(signal: Signal, readings: list[Reading], configuration: BenchConfiguration) -> dict[str, Value]:
    measured = np.array([(r.sample.position_rad, r.velocity_rad_s, r.current_a) for r in readings])
    position_rad, velocity_rad_s, current_a = measured.T
    results: dict[str, Value] = {
        "played_s": len(readings) * configuration.control.period_s,
        "travel_rad": float(np.ptp(position_rad)),
        "peak_speed_rad_s": float(np.max(np.abs(velocity_rad_s))),
        "peak_current_a": float(np.max(np.abs(current_a))),
        "rms_current_a": float(np.sqrt(np.mean(current_a**2))),
    }
    if signal.quantity == "position_rad":
        results["rms_tracking_error_rad"] = float(np.sqrt(np.mean((position_rad - signal.values) ** 2)))
    return results


def refuse_signal(name: str, signal: Signal, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for a signal that the bench must not play.

    Args:
        name: what it is called in the message ("the chirp").
        signal: as it would be played.
        configuration: of the bench.
    """
    refuse_servo(configuration)
    if signal.quantity == "position_rad":
        _refuse_position(name, signal.values, configuration)
        return
    _refuse_excursion(signal, configuration)
    peak = float(np.max(np.abs(signal.values)))
    if signal.quantity == "duty":
        refuse_duty(f"the largest duty of {name}", peak, configuration)
    elif peak > configuration.limits.current_a:
        allowed = f"at most limits.current_a, {configuration.limits.current_a:g}"
        raise LimitError(quantity_message(f"the largest current of {name}", peak, allowed, "A"))


def _refuse_position(name: str, position_rad: FloatArray, configuration: BenchConfiguration) -> None:
    period_s = configuration.control.period_s
    ends_rad = [float(position_rad.min()), float(position_rad.max())]
    refuse_angles(f"a position of {name}", [0.0, *ends_rad], OVERSHOOT_RAD, configuration)
    # from rest and to rest: a signal that begins or ends in motion jumps there
    around = np.concatenate([position_rad[:1], position_rad, position_rad[-1:]])
    velocity_rad_s = np.diff(around) / period_s
    for quantity, values, allowed, source in (
        ("speed_rad_s", velocity_rad_s, configuration.limits.speed_rad_s, "limits.speed_rad_s"),
        (
            "acceleration_rad_s2",
            np.diff(velocity_rad_s) / period_s,
            configuration.motion.acceleration_rad_s2,
            "motion.acceleration_rad_s2",
        ),
    ):
        worst = int(np.argmax(np.abs(values)))
        if abs(values[worst]) > allowed:
            what = f"the {quantity.split('_')[0]} of {name} at {worst * period_s:.4g} s"
            step = "Make it smaller, slower or smoother, and let it begin and end at rest"
            bounds = f"{-allowed:g} .. {allowed:g} ({source})"
            raise LimitError(quantity_message(what, float(values[worst]), bounds, unit_of(quantity), step))


def _refuse_excursion(signal: Signal, configuration: BenchConfiguration) -> None:
    if signal.excursion_rad is not None:
        ends_rad = [-signal.excursion_rad, signal.excursion_rad]
        refuse_angles("excursion_rad", ends_rad, OVERSHOOT_RAD, configuration)
