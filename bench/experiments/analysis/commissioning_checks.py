"""Whether a drive's signs and scales are those of the joint, from two small pushes: arrays in, findings out."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from bench.config.rig import Rig
from bench.control.cycle import Reading
from compensator.lab.recordings.recording import FloatArray

VELOCITY_BAND = (0.8, 1.25)  # filters and quantisation, but no wrong unit
CONSTANT_BAND = (0.5, 2.0)  # data sheets and warm windings, but no factor of four from counting lines for counts
MOVING_SHARE = 0.25  # of the highest speed
SEEN_SIGMAS = 3.0  # that two mean currents have to differ by
LEAST_SHARE = 0.2  # of the voltage that the back-EMF must make up to be told from the resistance's


class Finding(NamedTuple):
    """One check.

    Attributes:
        name: "sign", "velocity", "current", "ratio".
        passed: None where the drive does not measure what it takes.
        sentence: what was found, what is wanted, and what to correct.
        asks_for_more: whether a longer push would tell, as the joint gets faster on it.
    """

    name: str
    passed: bool | None
    sentence: str
    asks_for_more: bool = False


class Push(NamedTuple):
    """One push: the current was raised until the joint moved, then the power was taken away until it stood.

    Attributes:
        direction: 1 or -1, of the demand.
        driven: readings while current was demanded.
        coasting: readings afterwards.
    """

    direction: int
    driven: Sequence[Reading]
    coasting: Sequence[Reading]

    @property
    def travel_rad(self) -> float:
        """While it was driven [rad]."""
        return self.driven[-1].sample.position_rad - self.driven[0].sample.position_rad


def findings(pushes: Sequence[Push], rig: Rig) -> list[Finding]:
    """Every check, in the order in which a wrong one explains those after it."""
    return [check_sign(pushes), check_velocity(pushes), check_current(pushes), check_ratio(pushes, rig)]


def position_findings(pushes: Sequence[Push], rig: Rig) -> list[Finding]:
    """Every check of a move there and back that the drive itself has closed."""
    return [_sign_unseen(pushes), check_velocity(pushes), check_friction(pushes), check_ratio(pushes, rig)]


def _sign_unseen(pushes: Sequence[Push]) -> Finding:
    """Whoever closes a position by his own count finds its sign right in any case."""
    return Finding(
        "sign", None, "not checked: the drive follows its own count. By it the joint turned "
        f"{pushes[0].travel_rad:+.3g} rad first. Where you saw the arm turn the other way, change the sign of "
        "drive.encoder_sign",
    )  # fmt: skip


def check_friction(pushes: Sequence[Push]) -> Finding:
    """There and back over one way: the measured currents differ by friction, which has the sign of the motion.

    What speeds the joint up has slowed it down by the end: only over the whole passage does it cancel.
    """
    there_a, back_a = (column(_passage(push.driven), "current_a") for push in pushes)
    if np.isnan([*there_a, *back_a]).any():
        return Finding("current", None, "the drive measures no current; it is estimated by the paper's eq. (3)")
    means = float(np.mean(there_a)), float(np.mean(back_a))
    text = f"measured current: {means[0]:+.3g} A on the way there, {means[1]:+.3g} A on the way back"
    if abs(means[0] - means[1]) <= SEEN_SIGMAS * np.hypot(_error_of_mean(there_a), _error_of_mean(back_a)):
        return Finding("current", None, f"not checked: {text}; friction does not show in it")
    if means[0] > means[1]:
        return Finding("current", True, text)
    return Finding(
        "current", False, f"{text}; more is wanted on the way there, where friction is against it. Correct how the "
        "drive's settings take the sign of its current",
    )  # fmt: skip


def check_sign(pushes: Sequence[Push]) -> Finding:
    """A positive demand turns the joint to positive angles, by the drive's own count."""
    travelled = ", ".join(f"{push.travel_rad:+.3g} rad on a demand of sign {push.direction:+d}" for push in pushes)
    if all(push.travel_rad * push.direction > 0.0 for push in pushes):
        return Finding("sign", True, f"the joint turned {travelled}")
    return Finding(
        "sign", False, f"the joint turned {travelled}; the sign of the demand is wanted. Change the sign of "
        "drive.encoder_sign where the arm itself turned the right way, of drive.motor_sign where it did not",
    )  # fmt: skip


def check_velocity(pushes: Sequence[Push]) -> Finding:
    """The drive's velocity is what its position changes by."""
    if np.isnan([reading.sample.velocity_rad_s for push in pushes for reading in push.driven]).any():
        return Finding("velocity", None, "the drive measures no velocity; it is derived from the position")
    # from rest to rest, so that a filter's lag has gone by the end
    ratios = [_share_of_way([*push.driven, *push.coasting]) for push in pushes]
    text = f"velocity summed up over the way is {_range(ratios)} of the way; wanted is {_band(VELOCITY_BAND)}"
    if all(_within(ratio, VELOCITY_BAND) for ratio in ratios):
        return Finding("velocity", True, text)
    return Finding("velocity", False, f"{text}. The unit of the drive's velocity is another than its settings say")


def check_current(pushes: Sequence[Push]) -> Finding:
    """The measured current has the sign of the acceleration that it makes."""
    currents_a = [float(np.mean(column(push.driven, "current_a"))) for push in pushes]
    if np.isnan(currents_a).any():
        return Finding("current", None, "the drive measures no current; it is estimated by the paper's eq. (3)")
    text = ", ".join(
        f"{current_a:+.3g} A while the joint went {push.travel_rad:+.3g} rad"
        for current_a, push in zip(currents_a, pushes, strict=True)
    )
    if all(current_a * push.travel_rad > 0.0 for current_a, push in zip(currents_a, pushes, strict=True)):
        return Finding("current", True, f"measured current: {text}")
    return Finding(
        "current", False, f"measured current: {text}; the sign of the motion is wanted. Correct how the drive's "
        "settings take the sign of its current",
    )  # fmt: skip


def check_ratio(pushes: Sequence[Push], rig: Rig) -> Finding:
    """Counts per turn and current scale fit the motor's constants, by V d = R i + Ke N w over both pushes."""
    resistance_ohm, back_emf_v_s_rad, gear_ratio = rig.motor.resistance_ohm, rig.motor.back_emf_v_s_rad, rig.gear.ratio
    if resistance_ohm is None or back_emf_v_s_rad is None or gear_ratio is None:
        return Finding("ratio", None, "not checked: it takes resistance, back-EMF constant and gear ratio of the rig")
    readings = [reading for push in pushes for reading in push.driven]
    current_a, motor_rad_s = column(readings, "current_a"), _velocity(readings) * gear_ratio
    voltage_v = column(readings, "duty") * column(readings, "supply_v")
    if not np.isfinite(current_a).all() or not np.isfinite(voltage_v).all():
        return Finding("ratio", None, "not checked: it takes measured current, duty and supply voltage")
    matrix = np.column_stack([current_a, motor_rad_s])
    (found_ohm, found_v_s_rad), *_ = np.linalg.lstsq(matrix, voltage_v, rcond=None)
    if np.max(np.abs(found_v_s_rad * motor_rad_s)) < LEAST_SHARE * np.max(np.abs(voltage_v)):
        sentence = "not checked: the joint did not get fast enough for its back-EMF to show; ask for a longer excursion"
        return Finding("ratio", None, sentence, asks_for_more=True)
    ratios = found_ohm / resistance_ohm, found_v_s_rad / back_emf_v_s_rad
    text = (
        f"the motor behaves like {found_ohm:.3g} ohm and {found_v_s_rad:.3g} V s/rad, {ratios[0]:.2f} and "
        f"{ratios[1]:.2f} of what the rig says; wanted is {_band(CONSTANT_BAND)}"
    )
    if all(_within(ratio, CONSTANT_BAND) for ratio in ratios):
        return Finding("ratio", True, text)
    return Finding(
        "ratio", False, f"{text}. Correct sensor.counts_per_turn (counts are four per line), the motor's constants or "
        "the scale of the drive's current",
    )  # fmt: skip


def _passage(readings: Sequence[Reading]) -> Sequence[Reading]:
    """The way itself, without the wait at its ends; with every stop between."""
    fastest_rad_s = max(abs(reading.velocity_rad_s) for reading in readings)
    moving = [n for n, one in enumerate(readings) if abs(one.velocity_rad_s) >= MOVING_SHARE * fastest_rad_s]
    return readings[moving[0] : moving[-1] + 1]


def _error_of_mean(values: FloatArray) -> float:
    """Standard error of a mean of rows in time: those alike count as one, and those that alternate as no more."""
    off = values - np.mean(values)
    power = float(off @ off)
    if power == 0.0:
        return 0.0
    alike = 1.0  # rows that count as one: twice the autocorrelation, until it is none
    for lag in range(1, len(off)):
        correlation = float(off[:-lag] @ off[lag:]) / power
        if correlation <= 0.0:
            break
        alike += 2.0 * correlation
    return float(np.sqrt(power * alike)) / len(off)


def column(readings: Sequence[Reading], name: str) -> FloatArray:
    """A field of each sample, shape (n,)."""
    return np.array([getattr(reading.sample, name) for reading in readings])


def _velocity(readings: Sequence[Reading]) -> FloatArray:
    return np.array([reading.velocity_rad_s for reading in readings])


def _share_of_way(readings: Sequence[Reading]) -> float:
    """The velocity summed up along the way, as a share of the way."""
    position_rad, velocity_rad_s = column(readings, "position_rad"), _velocity(readings)
    way_rad, elapsed_s = np.diff(position_rad), np.diff([reading.time_s for reading in readings])
    mean_rad_s = 0.5 * (velocity_rad_s[1:] + velocity_rad_s[:-1])
    return float(np.sum(mean_rad_s * np.sign(way_rad) * elapsed_s) / np.sum(np.abs(way_rad)))


def _within(value: float, band: tuple[float, float]) -> bool:
    return bool(band[0] <= value <= band[1])


def _band(band: tuple[float, float]) -> str:
    return f"{band[0]:g} .. {band[1]:g}"


def _range(values: Sequence[float]) -> str:
    return f"{min(values):.2f} .. {max(values):.2f}"
