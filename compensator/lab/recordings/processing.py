"""From a recording to uniform, filtered signals: the same zero-phase filters on both sides of the equation.

Position is filtered with a cut-off well above the one finally applied to every column and to the effort, so
that differentiation does not shape the columns; nonlinear columns are computed at the full rate, then filtered,
then thinned to the Nyquist rate (Janot, Gautier, Brunot 2019; "parallel decimation").
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.driven import driven_from_outside
from compensator.lab.recordings.facts import Effort, Facts, lack_of_effort
from compensator.lab.recordings.gaps import is_before_gap, typical_step_s
from compensator.lab.recordings.low_pass import FILTER_ORDER, low_pass
from compensator.lab.recordings.position_noise import PositionNoise, mixed_by_interpolation, position_noise
from compensator.lab.recordings.recording import BoolArray, FloatArray, Recording

DIFFERENTIATION_FACTOR = 3.0  # differentiation cut-off / final cut-off; below 3 a false elasticity appears
REGULAR_SHARE = 0.05  # of the period: jitter that counts as regular sampling
SATURATED_DUTY = 0.98
EDGE_PERIODS = 3.0  # of the final cut-off, dropped at both ends of a trial, where the filter starts from nothing
MASK_PERIODS = 2.0  # of the final cut-off, dropped on both sides of an unusable sample, which the filter spreads


@dataclass(frozen=True, slots=True)
class Signals:
    """One recording on a uniform time grid; arrays have shape (n,).

    Attributes:
        recording: where they come from.
        time_s: uniform.
        rate_hz: of the grid.
        position, velocity, acceleration, jerk: differentiated after the wide filter.
        position_noise: its density before, in its unit squared per Hz.
        acceleration_noise: a draw of what noise of the position leaves in the acceleration.
        effort: raw, on the grid.
        temperature_c, supply_v, load: NaN where not measured; load: of a torque sensor [N m].
        usable: False in gaps, with the power stage off, in saturation, and at the ends.
    """

    recording: Recording
    time_s: FloatArray
    rate_hz: float
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray
    position_noise: float
    acceleration_noise: FloatArray
    effort: FloatArray
    temperature_c: FloatArray
    supply_v: FloatArray
    load: FloatArray
    usable: BoolArray


@dataclass(frozen=True, slots=True)
class EvenSamples:
    """One recording on a uniform time grid, before any filter; arrays have shape (n,), raw ones that of the recording.

    Attributes:
        recording: where they come from.
        time_s: uniform.
        rate_hz: of the grid.
        position: on the grid.
        noise: of the position.
        raw_position, raw_effort: as recorded.
    """

    recording: Recording
    time_s: FloatArray
    rate_hz: float
    position: FloatArray
    noise: PositionNoise
    raw_position: FloatArray
    raw_effort: FloatArray

    def filtered(self, cutoff_hz: float) -> Signals:
        """Filter and differentiate.

        Raises:
            UnusableDataError: too short for the filter.
        """
        recording, time, rate_hz = self.recording, self.time_s, self.rate_hz
        shortest = shortest_samples(rate_hz, cutoff_hz)
        if len(time) < shortest:
            raise UnusableDataError(
                f"recording '{recording.name}' has {len(time)} samples; at least {shortest} are needed "
                f"to filter at {cutoff_hz:.3g} Hz; record longer, choose a higher cut-off, or leave the trial out"
            )
        wide_hz = DIFFERENTIATION_FACTOR * cutoff_hz
        position = low_pass(self.position, wide_hz, rate_hz)
        velocity = rate_of_change(position, rate_hz)
        acceleration = self.noise.removed_from(rate_of_change(velocity, rate_hz))
        return Signals(
            recording=recording,
            time_s=time,
            rate_hz=rate_hz,
            position=position,
            velocity=velocity,
            acceleration=acceleration,
            jerk=rate_of_change(acceleration, rate_hz),
            position_noise=self.noise.density,
            acceleration_noise=low_pass(self.noise.kept, wide_hz, rate_hz),
            effort=_resample(time, recording.channels["time_s"], self.raw_effort),
            temperature_c=_optional(recording, "temperature_c", time),
            supply_v=_optional(recording, "supply_v", time),
            load=_optional(recording, "load_torque_n_m", time),
            usable=_usable(self, cutoff_hz),
        )


def sample_rate_hz(recording: Recording) -> float:
    """Rate of a recording, by its typical step.

    Raises:
        UnusableDataError: it has fewer than two samples.
    """
    time = recording.channels["time_s"]
    if len(time) < 2:
        raise UnusableDataError(
            f"recording '{recording.name}' has {len(time)} sample(s); record longer, or leave it out"
        )
    return 1.0 / typical_step_s(time)


def shortest_samples(rate_hz: float, cutoff_hz: float) -> int:
    """How many samples a recording must have to be filtered: less is all edge."""
    return int(np.ceil(2 * EDGE_PERIODS * rate_hz / cutoff_hz)) + 6 * FILTER_ORDER


def lowest_cutoff_hz(recording: Recording) -> float:
    """The lowest cut-off with which a recording can be filtered [Hz]; infinite for one of a few samples."""
    time_s, rate_hz = recording.channels["time_s"], sample_rate_hz(recording)
    inside = float(time_s[-1] - time_s[0]) * rate_hz - 6 * FILTER_ORDER - 1
    return 2 * EDGE_PERIODS * rate_hz / inside if inside > 0.0 else float("inf")


def make_signals(recording: Recording, effort: Effort, facts: Facts, cutoff_hz: float) -> Signals:
    """Resample, filter and differentiate one recording.

    Raises:
        UnusableDataError: no position, no effort, or too short for the filter.
    """
    return even_samples(recording, effort, facts).filtered(cutoff_hz)


def even_samples(recording: Recording, effort: Effort, facts: Facts) -> EvenSamples:
    """Resample one recording.

    Raises:
        UnusableDataError: no position, no effort.
    """
    position_name = f"position_{facts.position_unit}"
    if position_name not in recording.channels:
        raise UnusableDataError(
            f"recording '{recording.name}': channel {position_name} is missing, found "
            f"{', '.join(sorted(recording.channels))}; a {facts.joint} joint needs its position"
        )
    raw_position = recording.channels[position_name]
    if not np.isfinite(raw_position).any():
        raise UnusableDataError(
            f"recording '{recording.name}': {position_name} has no finite sample; leave the trial out"
        )
    if lack := lack_of_effort(recording, [effort]):
        raise UnusableDataError(lack)
    rate_hz = sample_rate_hz(recording)
    raw_time = recording.channels["time_s"]
    time = _uniform(raw_time, 1.0 / rate_hz)
    position = _resample(time, raw_time, raw_position)
    mixed = mixed_by_interpolation(time, raw_time[np.isfinite(raw_position)])
    noise = position_noise(position, mixed, rate_hz)
    return EvenSamples(recording, time, rate_hz, position, noise, raw_position, effort.of(recording))


def _uniform(raw_time: FloatArray, period: float) -> FloatArray:
    """The recording's own time stamps where they are regular: interpolation between them would smooth unevenly."""
    if len(raw_time) > 1 and np.abs(np.diff(raw_time) - period).max() <= REGULAR_SHARE * period:
        return raw_time
    return np.arange(raw_time[0], raw_time[-1], period)


def _resample(time: FloatArray, raw_time: FloatArray, raw: FloatArray) -> FloatArray:
    finite = np.isfinite(raw)
    if not finite.any():
        return np.full(len(time), np.nan)
    return np.interp(time, raw_time[finite], raw[finite])


def _optional(recording: Recording, name: str, time: FloatArray) -> FloatArray:
    if name not in recording.channels:
        return np.full(len(time), np.nan)
    return _resample(time, recording.channels["time_s"], recording.channels[name])


def _usable(samples: EvenSamples, cutoff_hz: float) -> BoolArray:
    """Rows whose position and effort were measured in closed loop, away from gaps, saturation and ends."""
    recording, time, raw_time = samples.recording, samples.time_s, samples.recording.channels["time_s"]
    good: BoolArray = np.isfinite(samples.raw_position) & np.isfinite(samples.raw_effort)
    if "enabled" in recording.channels:
        good &= recording.channels["enabled"] > 0.5
    if "duty" in recording.channels:
        good &= ~(np.abs(recording.channels["duty"]) >= SATURATED_DUTY)
    good &= ~driven_from_outside(raw_time, samples.raw_position, samples.raw_effort)
    before_gap = is_before_gap(raw_time)
    after_gap = np.roll(before_gap, 1)
    in_gap = before_gap[np.searchsorted(raw_time, time, side="right") - 1]
    edge_s = EDGE_PERIODS / cutoff_hz
    usable: BoolArray = (time >= time[0] + edge_s) & (time <= time[-1] - edge_s) & ~in_gap
    return usable & (distance_to_nearest(time, raw_time[~good | before_gap | after_gap]) > MASK_PERIODS / cutoff_hz)


def distance_to_nearest(values: FloatArray, marks: FloatArray) -> FloatArray:
    """Distance of each value to the nearest of the sorted marks; inf where there are none."""
    if len(marks) == 0:
        return np.full(len(values), np.inf)
    right = np.searchsorted(marks, values)
    after = np.where(right < len(marks), marks[np.minimum(right, len(marks) - 1)], np.inf)
    before = np.where(right > 0, marks[np.maximum(right - 1, 0)], -np.inf)
    nearest: FloatArray = np.minimum(after - values, values - before)
    return nearest
