"""From the columns of a file to the channels of a recording: units, sums, times in order, wraps, constants."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from bench.recording_set.condition_columns import held
from bench.recording_set.conditions import TEXTS
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats.column_table import ColumnTable
from bench.recording_set.mapping import SPEED_UNITS, Column, Mapping
from bench.recording_set.text.columns import TIME, Plan, plan
from bench.recording_set.text.stamps import NoStamp, seconds_of
from compensator.lab.recordings.recording import Condition, FloatArray, IntArray

CLOCK_S = 1e6  # a trial that begins so late tells the time of a clock
RESTART = 0.5  # of the time that passed: a clock that falls back by so much began anew


@dataclass(frozen=True)
class Raw:
    """The columns of a file that are wanted, all of one length.

    Attributes:
        numbers: column -> values, NaN where not known.
        texts: column -> its cells: date and time, or a condition in words.
        error: makes an error of a message, a row (from 0) and a column.
    """

    numbers: dict[str, FloatArray]
    texts: dict[str, list[str]]
    error: Callable[[str, int, str], RecordingSetError]

    def __len__(self) -> int:
        return len(next(iter(self.numbers.values()), next(iter(self.texts.values()), [])))


class Converted(NamedTuple):
    """The channels, which row of the file each sample is, and the conditions that columns of the file hold."""

    channels: dict[str, FloatArray]
    order: IntArray | None
    conditions: dict[str, Condition]


def channels_of(raw: Raw, plan: Plan, mapping: Mapping) -> Converted:
    """The channels and conditions of a trial.

    Raises:
        RecordingSetError: a value that is infinite, a time that is not known, stands still or runs backwards, a
            condition that changes.
    """
    time_s = _time(raw, plan, mapping)
    for name, values in raw.numbers.items():
        _check_finite(raw, name, values)
    order = None
    if mapping.stamps != "rise":
        time_s, order = _in_order(raw, time_s, mapping, plan)
    _check_rises(raw, time_s, plan, order)
    channels = {}
    for channel, column in plan.channels.items():
        if channel == TIME:
            channels[TIME] = time_s
            continue
        values = _values(raw, column, mapping)
        channels[channel] = values if order is None else values[order]
        if column.period is not None:
            channels[channel] = _unwrapped(channels[channel], abs(mapping.factors(column)[0][0]) * column.period)
    channels.setdefault(TIME, time_s)
    for channel, value in mapping.constants.items():
        channels.setdefault(channel, np.full(len(time_s), value))
    if mapping.position_from_speed:
        _integrate(channels)
    conditions: dict[str, Condition] = {}
    for name, source in plan.conditions.items():
        cells = raw.texts[source.source] if name in TEXTS else raw.numbers[source.source]
        if (constant := held(name, source, cells, raw.error)) is not None:
            conditions[name] = constant
    return Converted(channels, order, conditions)


def channels_of_table(table: ColumnTable, mapping: Mapping) -> Converted:
    """The channels and conditions of a trial in a file that is no text. Errors as `channels_of`, and of `plan`."""
    wanted = plan(table, mapping)

    def error(message: str, row: int, column: str) -> RecordingSetError:
        return table.error(message, row + 1, column)

    found: dict[str, FloatArray] = {}
    for name in wanted.numbers:
        values = table.columns[name]
        if isinstance(values, list):
            raise table.error("is text; wanted numbers, or for a time the unit 'stamp' in a mapping", column=name)
        found[name] = values
    texts = {name: [str(one) for one in table.columns[name]] for name in wanted.texts}
    return channels_of(Raw(found, texts, error), wanted, mapping)


def _values(raw: Raw, column: Column, mapping: Mapping) -> FloatArray:
    """Without factor and offset not a bit is changed."""
    if column.sign_from is not None:
        sign = np.sign(raw.numbers[column.sign_from])
        magnitude = np.abs(_values(raw, column.model_copy(update={"sign_from": None}), mapping))
        return np.where((sign == 0.0) & (magnitude > 0.0), np.nan, magnitude * sign)
    factors, offset = mapping.factors(column)
    first, *others = column.sources
    if not others and factors[0] == 1.0 and offset == 0.0:
        return raw.numbers[first]
    total = raw.numbers[first] * factors[0]
    for name, factor in zip(others, factors[1:], strict=True):
        total = total + raw.numbers[name] * factor
    return total + offset if offset else total


def _time(raw: Raw, plan: Plan, mapping: Mapping) -> FloatArray:
    if mapping.rate_hz is not None:
        return np.arange(len(raw)) / mapping.rate_hz
    column = plan.channels[TIME]
    if column.is_stamp:
        cells = [" ".join(parts) for parts in zip(*(raw.texts[name] for name in column.sources), strict=True)]
        try:
            return seconds_of(cells)
        except NoStamp as error:
            message = f"found '{error.text[:40]}'; wanted date and time, such as 2026-05-01T12:00:00.125"
            raise raw.error(message, error.index, column.sources[0]) from None
    time_s = _values(raw, column, mapping)
    unknown = np.flatnonzero(~np.isfinite(time_s))
    if len(unknown):
        row = int(unknown[0])
        raise raw.error(f"found {time_s[row]}; wanted a finite time in every row", row, column.sources[0])
    if TIME in mapping.columns and len(time_s) and time_s[0] > CLOCK_S:
        # from the file's own numbers: their difference is exact, where that of rounded seconds is not
        return _values(replace(raw, numbers={n: v - v[0] for n, v in raw.numbers.items()}), column, mapping)
    return time_s


def _in_order(raw: Raw, time_s: FloatArray, mapping: Mapping, plan: Plan) -> tuple[FloatArray, IntArray]:
    """Times that rise, and the row of each."""
    span = np.maximum.accumulate(time_s) - time_s[0]
    back = np.flatnonzero(span - (time_s - time_s[0]) > np.maximum(RESTART * span, 0.0))
    if len(back) and span[back[0]] > 0.0:
        row = int(back[0])
        message = (
            f"time falls back from {time_s[row - 1]:.6g} to {time_s[row]:.6g} s, as where a second run begins; split "
            "the file there: each run is a trial"
        )
        raise raw.error(message, row, _time_name(plan))
    order = np.argsort(time_s, kind="stable")
    if mapping.stamps == "spread":
        return spread(time_s[order]), order
    kept = np.append(True, np.diff(time_s[order]) > 0.0)
    return time_s[order][kept], order[kept]


def spread(time_s: FloatArray) -> FloatArray:
    """Times of which several are the same, because the clock is coarse, laid evenly up to the next one; rising."""
    starts = np.flatnonzero(np.append(True, np.diff(time_s) > 0.0))
    steps = np.diff(time_s[starts])
    usual = float(np.median(steps)) if len(steps) else 1.0
    counts = np.diff(np.append(starts, len(time_s)))
    within = np.arange(len(time_s)) - np.repeat(starts, counts)
    wide = np.repeat(np.append(np.minimum(steps, usual), usual) / counts, counts)
    found: FloatArray = time_s + within * wide
    return found


def _check_rises(raw: Raw, time_s: FloatArray, plan: Plan, order: IntArray | None) -> None:
    wrong = np.flatnonzero(np.diff(time_s) <= 0)
    if not len(wrong):
        return
    row = int(wrong[0]) + 1
    before, now = float(time_s[row - 1]), float(time_s[row])
    how = "stands still" if now == before else "runs backwards"
    message = f"time {how}: found {now!r} s after {before!r} s; wanted a time that rises from row to row"
    if order is None:
        message += ', or in a mapping: stamps = "sort" (or "spread" for a coarse clock)'
    raise raw.error(message, row, _time_name(plan))


def _time_name(plan: Plan) -> str:
    return plan.channels[TIME].sources[0] if TIME in plan.channels else TIME


def _check_finite(raw: Raw, name: str, values: FloatArray) -> None:
    infinite = np.flatnonzero(np.isinf(values))
    if len(infinite):
        row = int(infinite[0])
        raise raw.error(f"found {values[row]}; wanted a finite number, or nothing where it is not known", row, name)


def _unwrapped(values: FloatArray, period: float) -> FloatArray:
    """The same without its wraps; values that are not known stay so."""
    found = values.copy()
    known = np.isfinite(values)
    found[known] = np.unwrap(values[known], period=period)
    return found


def _trapezoids(rate: FloatArray, time_s: FloatArray) -> FloatArray:
    """The integral from the first sample to each, shape (n,)."""
    steps = np.diff(time_s) * (rate[1:] + rate[:-1]) / 2.0
    return np.append(np.zeros(min(1, len(rate))), np.cumsum(steps))


def _integrate(channels: dict[str, FloatArray]) -> None:
    for speed, unit in SPEED_UNITS.items():
        if speed in channels and f"position_{unit}" not in channels:
            rate, time_s = channels[speed], channels[TIME]
            known = np.isfinite(rate)
            position = np.full(len(rate), np.nan)
            position[known] = _trapezoids(rate[known], time_s[known])
            channels[f"position_{unit}"] = position
