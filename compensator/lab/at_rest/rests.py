"""A joint at rest: between which efforts friction holds it, by a fitted model.

Rest fixes no effort. It bounds it: what the model's load does not balance, friction must, and friction has a most. With
p(q, d) the model's effort at speed zero for a motion about to go the way d = 1 or -1, a complete model has

    p(q, -1) <= effort <= p(q, 1)

in every rest (Armstrong, Dupont, Canudas de Wit 1994). Half the span is static friction: what sliding tells of it, at
rest or as slow as any sliding was, or, where starts from rest tell of more, that. A power law of the speed has nothing
at speed zero, which no sliding shows. Its middle is gravity, springs and offset, which sliding tells.
"""

from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.at_rest.breakaway_regression import BACK, LAG, BreakawayFit
from compensator.lab.at_rest.breakaway_rows import at_rest_motion, measured_position
from compensator.lab.at_rest.breakaways import resolution_of, rests_of
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import BreakawayShare, Motion, Onset
from compensator.lab.model.fitted import STATIC, Fit
from compensator.lab.model.intervals import without_each
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset

WINDOW_S = 0.1  # over which the effort at rest is averaged
TRIM_S = 0.1  # at both ends of a rest: the joint still brakes, or lets go already
STILL = 4.0  # counts of position, from TRIM_S before a window to TRIM_S after it: what turns slowly still accelerates
SLOWEST = 1e-3  # of a model's static friction per second: an effort that rises less is held


@dataclass(frozen=True)
class Windows:
    """Stretches of WINDOW_S at rest, of all trials. W in all, in the order of trials and time.

    Attributes:
        trial_index: in the dataset, shape (W,).
        rest: which rest each is of, shape (W,).
        index: middle sample in the trial's signals, shape (W,).
        position: as measured there, shape (W,).
        effort: mean, in the effort's unit, shape (W,).
        rate: of the effort within the window [effort/s], shape (W,).
        rest_s: since the joint came to rest, shape (W,).
    """

    trial_index: IntArray
    rest: IntArray
    index: IntArray
    position: FloatArray
    effort: FloatArray
    rate: FloatArray
    rest_s: FloatArray

    def __len__(self) -> int:
        return len(self.effort)


@dataclass(frozen=True)
class Limits:
    """Between what friction holds the joint, shape (W,) each, in the effort's unit.

    Attributes:
        low, high: of the effort.
        low_sd, high_sd: standard deviations of them: of the coefficients, by leaving out whole units.
        known_from: units that these rest on, less one.
    """

    low: FloatArray
    high: FloatArray
    low_sd: FloatArray
    high_sd: FloatArray
    known_from: int


def windows_of(dataset: Dataset) -> Windows:
    """Every usable stretch of rest of a dataset's trials."""
    positions = [measured_position(trial, dataset) for trial in dataset.trials]
    count = resolution_of(positions)
    rows: list[tuple[float, ...]] = []
    rests = 0
    for number, (trial, position) in enumerate(zip(dataset.trials, positions, strict=True)):
        signals = trial.signals
        size, trim = (max(2, round(span_s * signals.rate_hz)) for span_s in (WINDOW_S, TRIM_S))
        for begin, end in rests_of(signals, position, count, dataset.scales.slow):
            for start in range(begin + trim, end - trim - size + 2, size):
                part, around = slice(start, start + size), slice(start - trim, start + size + trim)
                effort = signals.effort[part]
                still = float(np.ptp(position[around])) <= STILL * count
                if still and signals.usable[part].all() and np.isfinite(effort).all():
                    middle, since_s = start + size // 2, (start - begin) / signals.rate_hz
                    rate = float(np.polyfit(signals.time_s[part], effort, 1)[0])
                    rows.append((number, rests, middle, position[middle], float(effort.mean()), rate, since_s))
            rests += 1
    table = np.array(rows).reshape(-1, 7).T
    whole = [column.astype(np.int64) for column in table[:3]]
    return Windows(whole[0], whole[1], whole[2], *table[3:])


def limits_of(fit: Fit, windows: Windows, starts: BreakawayFit | None) -> Limits:
    """Between what the fitted model's friction holds the joint.

    Args:
        fit: of sliding.
        windows: at rest; at least one.
        starts: the same model fitted to its starts from rest; None where there are too few.
    """
    low, high = (_columns(fit, windows, way, 0.0) for way in (-1.0, 1.0))
    low_slow, high_slow = (_columns(fit, windows, way, fit.dataset.scales.slow) for way in (-1.0, 1.0))
    holds_more = ((high_slow - low_slow - high + low) @ fit.coefficients > 0.0)[:, None]
    low, high = np.where(holds_more, low_slow, low), np.where(holds_more, high_slow, high)
    middle, half = 0.5 * (high + low) @ fit.coefficients, 0.5 * (high - low) @ fit.coefficients
    if starts is not None:
        half = np.maximum(half, _half_by_starts(fit, windows, starts))
    without = without_each(fit)
    count = len(without)
    spread = (without - without.mean(axis=0)) * np.sqrt((count - 1.0) / count)
    low_sd, high_sd = (np.linalg.norm(spread @ columns.T, axis=0) for columns in (low, high))
    return Limits(middle - half, middle + half, low_sd, high_sd, max(count - 1, 1))


def extrapolated(fit: Fit) -> float:
    """Static friction beyond that of the slowest sliding: its curve says it, no row shows it; in the effort's unit."""
    slowest = np.array([fit.dataset.scales.slow, 0.0])
    motion = replace(fit.dataset.trials[0].motion, velocity=slowest, direction=np.ones(2))
    static = [term for term in fit.terms if term.effect.name == STATIC]
    return float(sum(term.coefficients @ np.diff(term.effect.columns(motion, term.shape))[:, 0] for term in static))


def _columns(fit: Fit, windows: Windows, way: float, speed: float) -> FloatArray:
    """The model's columns at rest, about to move one way, or moving so at a speed, shape (W, K).

    Effects with memory have none there, nor has the measuring chain, which makes something of rates of change only.
    """
    parts = []
    for _, resting in _motions(fit, windows, way):
        motion = replace(resting, velocity=way * np.full(len(resting.time_s), speed))
        blocks = [
            term.effect.columns(motion, term.shape)
            if term.effect.rows == "sliding" and not term.effect.pipeline
            else np.zeros((len(term.coefficients), len(motion.time_s)))
            for term in fit.terms
        ]
        parts.append(np.concatenate(blocks))
    columns: FloatArray = np.nan_to_num(np.concatenate(parts, axis=1).T)
    return columns


def _half_by_starts(fit: Fit, windows: Windows, starts: BreakawayFit) -> FloatArray:
    """Static friction after that rest and at that rate, by the breakaway effort, shape (W,)."""
    shares = [share for share in starts.shares if share.name not in (BACK, LAG)]
    efforts = []
    for way in (-1.0, 1.0):
        parts = []
        for number, motion in _motions(fit, windows, way):
            own = windows.trial_index == number
            floor = SLOWEST * float(np.median(np.abs(starts.rows.effort)))
            onset = Onset(motion, windows.rest_s[own], np.maximum(np.abs(windows.rate[own]), floor))
            made = [_share_of(share.name).columns(onset, share.shape) for share in shares]
            coefficients = np.concatenate([share.coefficients for share in shares])
            parts.append(coefficients @ np.nan_to_num(np.concatenate(made)))
        efforts.append(np.concatenate(parts))
    half: FloatArray = 0.5 * (efforts[1] - efforts[0])
    return half


def _share_of(name: str) -> BreakawayShare:
    share = effect_named(name).breakaway
    assert share is not None  # a fitted share is of an effect that has one
    return share


def _motions(fit: Fit, windows: Windows, way: float) -> list[tuple[int, Motion]]:
    """Each trial's motion at its windows, at rest, about to go one way."""
    found = []
    for number in np.unique(windows.trial_index).tolist():
        own = windows.trial_index == number
        direction = np.full(int(own.sum()), way)
        motion = fit.dataset.trials[number].motion
        found.append((number, at_rest_motion(fit, motion, windows.index[own], windows.position[own], direction)))
    return found
