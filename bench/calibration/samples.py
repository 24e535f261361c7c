"""Points of a friction curve from the samples of a trial of the balanced joint, whoever recorded it.

Trials of this bench keep what each stroke measured. A recording set has samples alone: it is cut into short windows,
and a parabola through the positions of each gives its speed and acceleration.
"""

from itertools import pairwise

import numpy as np

from bench.calibration.points import FrictionPoint
from bench.config.rig import Rig
from compensator.errors import CalibrationError
from compensator.lab.recordings.recording import Recording
from compensator.motion.kinetic_friction import FloatArray
from compensator.motor import dc_motor as motor
from compensator.motor.dc_motor import MotorConstants

WINDOW_S = 0.2
LEAST_ROWS = 8  # of a window
LEAST_COUNTS = 20.0  # that the sensor moves within a window
LOSES, GAINS = 0.005, 0.05  # of its speed, that a window may lose or gain: slower, and the teeth may have parted


def points_of_recording(recording: Recording, rig: Rig, trial_id: int | None = None) -> list[FrictionPoint]:
    """The points that a trial shows.

    Args:
        recording: with time_s, position_rad, a current (or what eq. (3) needs) and the condition load_kg.
        rig: gear ratio and encoder counts; resistance and back-EMF constant where no current was measured.
        trial_id: kept with every point.

    Raises:
        CalibrationError: the joint was not balanced, or a channel, a condition or a value of the rig is missing.
    """
    load_kg = recording.conditions.get("load_kg")
    if recording.conditions.get("balanced") is not True or not isinstance(load_kg, float | int):
        raise CalibrationError(
            f"trial '{recording.name}' has balanced = {recording.conditions.get('balanced')} and load_kg = {load_kg}; "
            "allowed is balanced = true and a load: gravity would be taken for friction. Add both to trials.csv"
        )
    if rig.gear.ratio is None or rig.sensor.counts_per_turn is None:
        raise CalibrationError(
            f"rig '{rig.name}': gear.ratio and sensor.counts_per_turn are needed to tell motion from rest; add them"
        )
    time_s, shaft_rad = _channel(recording, "time_s"), _channel(recording, "position_rad") * rig.gear.ratio
    current_a, duty = _current_a(recording, rig), recording.channels.get("duty", np.full_like(time_s, np.nan))
    least_rad = LEAST_COUNTS * 2.0 * np.pi / rig.sensor.counts_per_turn
    points = []
    for rows in _windows(time_s):
        mid_s = time_s[rows] - np.mean(time_s[rows])
        half_acceleration, speed, _ = np.polyfit(mid_s, shaft_rad[rows], 2)
        span_s = float(np.ptp(mid_s))
        change = 2.0 * half_acceleration * span_s * np.sign(speed)
        moves = abs(speed) * span_s >= least_rad and -LOSES * abs(speed) <= change <= GAINS * abs(speed)
        if moves and np.all(np.isfinite(current_a[rows])):
            means = float(np.mean(current_a[rows])), float(np.mean(duty[rows]))
            point = FrictionPoint(float(load_kg), float(speed), float(2.0 * half_acceleration), *means, trial_id)
            points.append(point)
    return points


def _windows(time_s: FloatArray) -> list[slice]:
    """Windows of a fifth of a second, one after the other, each with enough rows and no gap."""
    edges = np.searchsorted(time_s, np.arange(time_s[0], time_s[-1], WINDOW_S))
    period_s = float(np.median(np.diff(time_s)))
    found = []
    for first, last in pairwise(edges.tolist()):
        whole = last - first >= LEAST_ROWS and np.max(np.diff(time_s[first:last])) < 3.0 * period_s
        if whole:
            found.append(slice(first, last))
    return found


def _current_a(recording: Recording, rig: Rig) -> FloatArray:
    """Measured, estimated when it was recorded, or by eq. (3)."""
    for name in ("current_a", "current_estimate_a"):
        found = recording.channels.get(name)
        if found is not None and np.any(np.isfinite(found)):
            return found
    resistance_ohm, back_emf_v_s_rad = rig.motor.resistance_ohm, rig.motor.back_emf_v_s_rad
    if resistance_ohm is None or back_emf_v_s_rad is None or rig.gear.ratio is None:
        raise CalibrationError(
            f"trial '{recording.name}' has no current, and rig '{rig.name}' lacks the motor.resistance_ohm and "
            "motor.back_emf_v_s_rad that the paper's eq. (3) takes it from; add one or the other"
        )
    speed = np.gradient(_channel(recording, "position_rad"), _channel(recording, "time_s")) * rig.gear.ratio
    voltage_v = _channel(recording, "duty") * _channel(recording, "supply_v")
    return motor.current_a(MotorConstants(resistance_ohm, back_emf_v_s_rad), voltage_v, speed, 1.0)


def _channel(recording: Recording, name: str) -> FloatArray:
    if name not in recording.channels:
        raise CalibrationError(f"trial '{recording.name}' has no channel {name}; a friction curve needs it")
    return recording.channels[name]
