"""Channels that cannot be what their names say, looked for before anything is filtered: wraps, units, signs."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.gaps import LONGEST_GAP_PERIODS, typical_step_s
from compensator.lab.recordings.recording import FloatArray, Recording

MOST_DUTY = 1.05  # rounding included
SAME_PERIOD = 0.02  # relative: how near the period of a wrap is to a turn
JUMP = 0.5  # of the span of position, from one sample to the next
QUICK = 10.0  # times the step that 19 in 20 samples stay below
ENDS = 0.1  # of its largest value: where the values of a channel lie that wraps
FEW, MOST_BETWEEN = 0.02, 0.1  # shares of the samples at either end, at least, and between, at most
NARROW = 0.05  # of the largest value: standard deviation at either end
TOLD = 0.8  # squared correlation from which one channel tells another's scale
FACTOR = 3.0  # between two channels of one quantity: more is another unit
AGREE = 1.5  # between a speed and its position's own rate: a late or filtered speed differs by less, or is not TOLD
COARSE = 3.0  # steps of a speed, root mean square: one that is rounded to fewer may differ by more
POOR_SERVO = 1.0 / 20.0  # of its set point: a weak servo under load follows by little
BLOCK = 20  # samples over which speed is averaged
FEWEST_BLOCKS = 10
CONSTANT = 1e-9  # of its largest value: what changes less does not change
DEGREES = 180.0 / np.pi


def check_channels(recordings: Sequence[Recording], effort: Effort, facts: Facts) -> None:
    """Look at every recording.

    Raises:
        UnusableDataError: a channel wraps, has another unit or the other sign; the message names recording and channel,
            and says what to do.
    """
    for recording in recordings:
        found = (
            _too_much_duty(recording)
            or _unsigned(recording, effort)
            or _wrapped_position(recording, facts.position_unit)
            or _scale(recording, facts.position_unit)
        )
        if found:
            raise UnusableDataError(f"recording '{recording.name}': {found}")


def _too_much_duty(recording: Recording) -> str:
    duty = recording.channels.get("duty")
    largest = 0.0 if duty is None or not np.isfinite(duty).any() else float(np.nanmax(np.abs(duty)))
    if largest <= MOST_DUTY:
        return ""
    return (
        f"duty goes up to {largest:.4g}, wanted is -1 .. 1; map it with its scale (0.01 for per cent), and where "
        "values above half of the range stand for negative ones, subtract the range from them before the import"
    )


def _unsigned(recording: Recording, effort: Effort) -> str:
    """Signed counts read as unsigned: two narrow heaps at the ends of the range, none of them negative."""
    for name in effort.channels:
        values = recording.channels[name]
        values = values[np.isfinite(values)]
        largest = float(values.max(initial=0.0))
        if name == "supply_v" or largest <= 0.0 or values.min() < 0.0:
            continue
        low, high = values[values < ENDS * largest], values[values > (1.0 - ENDS) * largest]
        heaps = all(
            len(one) > FEW * len(values) and np.ptp(one) > 0.0 and one.std() < NARROW * largest for one in (low, high)
        )
        if heaps and len(values) - len(low) - len(high) < MOST_BETWEEN * len(values):
            return (
                f"{name} is never negative and jumps between {low.min():.4g} .. {low.max():.4g} and {high.min():.4g} "
                f".. {largest:.4g}: signed values were read as unsigned ones; subtract the range (65536 counts of 16 "
                "bits) from those in its upper half, before anything is interpolated, and import again"
            )
    return ""


@dataclass(frozen=True, slots=True)
class _Jumps:
    """Jumps against the motion before and after them. Attributes: how many, the first one's size and row, period."""

    count: int
    first: float
    row: int
    period: float


def _jumps(time_s: FloatArray, position: FloatArray) -> _Jumps | None:
    if len(position) < 4:
        return None
    step, period_s = np.diff(position), typical_step_s(time_s)
    step[~(np.diff(time_s) <= LONGEST_GAP_PERIODS * period_s)] = np.nan
    if not np.isfinite(step).any():
        return None
    size = np.abs(step)
    large = max(JUMP * float(np.nanmax(position) - np.nanmin(position)), QUICK * float(np.nanquantile(size, 0.95)))
    before, jump, after = step[:-2], step[1:-1], step[2:]
    sign = -np.sign(jump)
    against = (before * sign > 0.0) & (after * sign > 0.0) & (size[:-2] < large) & (size[2:] < large)
    jumps = np.flatnonzero((size[1:-1] >= large) & against)
    if not len(jumps):
        return None
    # what the joint moves during a wrap is added to the jump: the neighbouring steps tell it
    wraps = np.abs(jump[jumps] - 0.5 * (before[jumps] + after[jumps]))
    return _Jumps(len(jumps), float(jump[jumps[0]]), int(jumps[0]) + 2, float(np.median(wraps)))


def _wrapped_position(recording: Recording, unit: str) -> str:
    time_s, position = recording.channels["time_s"], recording.channels.get(f"position_{unit}")
    jumps = None if position is None else _jumps(time_s, position)
    if jumps is None:
        return ""
    period = jumps.period
    turn = unit == "rad" and abs(period - 2.0 * np.pi) < SAME_PERIOD * 2.0 * np.pi
    how = "once a turn" if turn else f"every {period:.4g} {unit}"
    exact = f"{2.0 * np.pi if turn else period:.5g}"
    return (
        f"position_{unit} jumps by {jumps.first:.4g} {unit} against the motion at {time_s[jumps.row]:.4g} s, and "
        f"{jumps.count} times in all: it wraps, {how}; unwrap it in a mapping (period = {exact}, in the unit of the "
        f"column), or by numpy.unwrap(position, period={exact}), and import again"
    )


def wrap_period(time_s: FloatArray, position: FloatArray) -> float | None:
    """The period at which a position wraps, in its own unit; None where it does not.

    Args:
        time_s: of its samples, rising.
        position: in any unit.
    """
    jumps = _jumps(time_s, position)
    return None if jumps is None else jumps.period


def _scale(recording: Recording, unit: str) -> str:
    """Position against the speed that the drive tells, and against the set point: one unit, one sign."""
    channels = recording.channels
    position = channels.get(f"position_{unit}")
    if position is None:
        return ""
    time_s = channels["time_s"][::BLOCK]
    speed, target = channels.get(f"velocity_{unit}_s"), channels.get(f"target_{unit}")
    pairs = []
    if speed is not None and len(time_s) > FEWEST_BLOCKS:
        # the mean speed of a block is what position gains in it
        means = speed[: (len(time_s) - 1) * BLOCK].reshape(-1, BLOCK).mean(axis=1)
        most = FACTOR if _is_coarse(speed) else AGREE
        pairs.append((f"velocity_{unit}_s", np.diff(position[::BLOCK]) / np.diff(time_s), means, 1.0 / most, most))
    if target is not None:
        pairs.append((f"target_{unit}", position, target, POOR_SERVO, FACTOR))
    for name, own, other, least, most in pairs:
        factor = _factor(own, other)
        if factor is not None and not least < factor < most:
            return f"position_{unit} and {name} {_unlike(factor, least, most, f'position_{unit}', name)}"
    return ""


def _is_coarse(speed: FloatArray) -> bool:
    """Whether a speed is hardly more than the steps that it is rounded to."""
    speed = speed[np.isfinite(speed)]
    steps = np.abs(np.diff(speed))
    steps = steps[steps > CONSTANT * np.abs(speed).max(initial=0.0)]
    return len(steps) > 0 and float(np.sqrt(np.mean(speed**2))) < COARSE * float(steps.min())


def _unlike(factor: float, least: float, most: float, own: str, other: str) -> str:
    if abs(factor + 1.0) < 0.5:
        return (
            "have opposite signs; turn the sign of one of them, so that they agree with the effort's, and import again"
        )
    hint = " (degrees?)" if abs(np.log(abs(factor) / DEGREES)) < 0.1 else ""
    return (
        f"differ by a factor of {factor:.3g}{hint}, allowed is {least:.3g} .. {most:.3g}; give the one that is wrong "
        f"its scale in the mapping (scale = {factor:.3g} for {other}, {1.0 / factor:.3g} for {own}), or leave it out: "
        "import --guess with --take 'NAME=ignore', the name of its column"
    )


def _factor(own: FloatArray, other: FloatArray) -> float | None:
    """What one quantity is of another, by least squares; None where they have little to do with each other."""
    known = np.isfinite(own) & np.isfinite(other)
    if np.count_nonzero(known) < FEWEST_BLOCKS:
        return None
    own, other = own[known], other[known]
    # the mean of a constant is off by rounding: what is left would have a sign, and a scale
    if any(np.ptp(one) <= CONSTANT * np.abs(one).max() for one in (own, other)):
        return None
    own, other = own - own.mean(), other - other.mean()
    powers = float(own @ own), float(other @ other)
    both = float(own @ other)
    return both / powers[1] if both**2 > TOLD * powers[0] * powers[1] else None
