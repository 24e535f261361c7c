"""The rows of a study: every trial's signals, and columns of any effect filtered and thinned like the effort."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from compensator.lab.bandwidth import choose_cutoff_hz
from compensator.lab.effects.effect import Effect, Motion, Shape
from compensator.lab.effort import Effort, choose_effort
from compensator.lab.errors import NotApplicableError, UnusableDataError
from compensator.lab.facts import Facts
from compensator.lab.processing import DIFFERENTIATION_FACTOR, Signals, low_pass, make_signals
from compensator.lab.recording import FloatArray, Recording
from compensator.lab.regimes import BoolArray, Regime, classify, near_flank_change

RowChoice = Literal["sliding", "moving", "all"]
IntArray = NDArray[np.int64]

SLOW_SHARE = 0.02  # of the 95 % quantile of speed: below, the direction of motion is uncertain
NOISE_FACTOR = 3.0  # slow is at least this many standard deviations of the velocity noise
TINY_SHARE = 0.01  # of slow: the sign of velocity is never smoothed less, so that it stays differentiable
ROWS_PER_CUTOFF_PERIOD = 2.5  # Nyquist rate and a margin for the filter's slope: at 2.0 the errors alias
NUMERIC_CONDITIONS = ("load_kg", "arm_m")
BLOCK_S = 2.0  # rows closer than this are not independent
FEWEST_ROWS = 40
CONSTANT = 1e-9  # of its largest value: what changes less does not change
FLANK_SHARE = 0.1  # of the sliding rows that must be left when those near a crossing of the free play are dropped


@dataclass(frozen=True, slots=True)
class Processing:
    """How recordings become rows.

    Attributes:
        cutoff_hz: of the final low-pass; None lets the data choose (see `bandwidth`).
        rows: which rows a model is fitted to and judged on.
    """

    cutoff_hz: float | None = None
    rows: RowChoice = "sliding"


@dataclass(frozen=True)
class Trial:
    """One recording, ready: its motion at the full rate and which of its samples are rows."""

    signals: Signals
    motion: Motion
    picked: IntArray  # indices into the full-rate signals, thinned to the Nyquist rate
    regime: NDArray[np.uint8]  # of the picked samples


@dataclass(frozen=True)
class Dataset:
    """All rows of a study's trials. N rows in all.

    Attributes:
        trials: in the order given.
        effort_definition: what `effort` holds, with its unit.
        facts: of the joint.
        cutoff_hz: of the final low-pass.
        rows: which regimes count.
        crosses_free_play: rows near a crossing of the free play are counted, since nearly all are.
    """

    trials: tuple[Trial, ...]
    effort_definition: Effort
    facts: Facts
    cutoff_hz: float
    rows: RowChoice
    crosses_free_play: bool = False
    cache: dict[tuple[str, Shape], FloatArray] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def effort(self) -> FloatArray:
        """Filtered effort, shape (N,)."""
        return np.concatenate([self._filtered(trial, trial.signals.effort[None])[0] for trial in self.trials])

    @cached_property
    def trial_index(self) -> IntArray:
        """Which trial each row belongs to, shape (N,)."""
        return np.concatenate([np.full(len(t.picked), i, dtype=np.int64) for i, t in enumerate(self.trials)])

    @cached_property
    def block_index(self) -> IntArray:
        """Which stretch of BLOCK_S each row belongs to, shape (N,); stretches never cross trials."""
        labels, start = [], 0
        for trial in self.trials:
            block = (self.time_of(trial) // BLOCK_S).astype(np.int64)
            _, dense = np.unique(block, return_inverse=True)
            labels.append(dense + start)
            start += int(dense.max()) + 1 if len(dense) else 0
        return np.concatenate(labels)

    @cached_property
    def regime(self) -> NDArray[np.uint8]:
        """`Regime` of each row, shape (N,)."""
        return np.concatenate([trial.regime for trial in self.trials])

    @cached_property
    def counted(self) -> BoolArray:
        """Rows that a model is fitted to and judged on, shape (N,)."""
        return self.in_regimes(self.rows)

    def in_regimes(self, choice: RowChoice) -> BoolArray:
        """Rows of these regimes, shape (N,)."""
        if choice == "all":
            return np.ones(len(self.regime), dtype=bool)
        chosen: BoolArray = self.regime == Regime.SLIDING if choice == "sliding" else self.regime != Regime.STUCK
        return chosen

    @staticmethod
    def time_of(trial: Trial) -> FloatArray:
        """Time of the trial's rows since its start [s]."""
        time: FloatArray = trial.signals.time_s[trial.picked] - trial.signals.time_s[0]
        return time

    def columns(self, effect: Effect, shape: Shape) -> FloatArray:
        """The effect's columns over all rows, filtered like the effort; shape (N, k).

        Raises:
            NotApplicableError: a channel or a varying condition that the effect needs is not there.
        """
        return self.columns_of_shapes(effect, [shape])[0]

    def columns_of_shapes(self, effect: Effect, shapes: Sequence[Shape]) -> list[FloatArray]:
        """The effect's columns for each shape, (N, k) each; all shapes are filtered in one pass per trial.

        Columns that do not depend on the predicted load are kept: shape searches ask for them again and again.

        Raises:
            NotApplicableError: as `columns`.
        """
        self.check_applicable(effect)
        missing = [shape for shape in shapes if (effect.name, shape) not in self.cache]
        made: dict[Shape, FloatArray] = {}
        if missing:
            stacks = [np.concatenate([effect.columns(t.motion, shape) for shape in missing]) for t in self.trials]
            made = dict(zip(missing, np.split(self.stack(stacks), len(missing), axis=1), strict=True))
            if not effect.uses_prediction:
                self.cache.update({(effect.name, shape): columns for shape, columns in made.items()})
        return [made[shape] if shape in made else self.cache[effect.name, shape] for shape in shapes]

    def stack(self, full_rate: Sequence[FloatArray]) -> FloatArray:
        """Filter and thin arrays (k, n) given per trial; shape (N, k)."""
        parts = [self._filtered(trial, rows) for trial, rows in zip(self.trials, full_rate, strict=True)]
        return np.concatenate(parts, axis=1).T

    def rows_of(self, full_rate: Sequence[FloatArray]) -> FloatArray:
        """Thin arrays (n,) given per trial, without filtering; shape (N,)."""
        return np.concatenate([rows[trial.picked] for trial, rows in zip(self.trials, full_rate, strict=True)])

    def with_prediction(self, load_effort: Sequence[FloatArray], effort_rate: Sequence[FloatArray]) -> "Dataset":
        """The same rows, with the predicted load and its rate of change in every trial's motion (n,) each."""
        trials = tuple(
            replace(trial, motion=replace(trial.motion, load_effort=load, effort_rate=rate))
            for trial, load, rate in zip(self.trials, load_effort, effort_rate, strict=True)
        )
        return replace(self, trials=trials)

    def check_applicable(self, effect: Effect) -> None:
        """Raise NotApplicableError, in words, where the recordings lack what the effect needs."""
        for channel in effect.channels:
            if not all(channel in trial.signals.recording.channels for trial in self.trials):
                raise NotApplicableError(f"{effect.name} needs channel {channel} in every trial; record it")
        if effect.varies_with and not self._varies(effect.varies_with):
            raise NotApplicableError(
                f"{effect.name} needs {effect.varies_with} to differ over the data, and it does not; "
                f"record {effect.excited_by}"
            )

    def _varies(self, quantity: str) -> bool:
        if quantity == "temperature_c":
            values = self.rows_of([trial.motion.temperature_c for trial in self.trials])
            return bool(np.isfinite(values).all() and np.ptp(values) >= 1.0)
        values = np.array([trial.motion.condition(quantity, 0.0) for trial in self.trials])
        return bool(np.ptp(values) > 0.0)

    def _filtered(self, trial: Trial, full_rate: FloatArray) -> FloatArray:
        return low_pass(full_rate, self.cutoff_hz, trial.signals.rate_hz)[:, trial.picked]


def make_dataset(recordings: Sequence[Recording], facts: Facts, processing: Processing) -> Dataset:
    """Filter every recording and pick its rows.

    Raises:
        UnusableDataError: no common effort, no position, no motion, or too few rows; the message says which
            trial would supply what is missing.
    """
    if not recordings:
        raise UnusableDataError("no recordings: choose at least one trial")
    _check_conditions(recordings)
    effort = choose_effort(recordings, facts)
    cutoff = processing.cutoff_hz or choose_cutoff_hz(recordings, effort, facts)
    signals = [make_signals(recording, effort, facts, cutoff) for recording in recordings]
    usable = np.concatenate([s.usable for s in signals])
    if not usable.any():
        raise UnusableDataError("no usable rows: every sample is in a gap, with the power stage off, or saturated")
    speed = np.abs(np.concatenate([s.velocity for s in signals]))[usable]
    position = np.concatenate([s.position for s in signals])[usable]
    fast, span = float(np.quantile(speed, 0.95)), float(np.ptp(position))
    if not span > CONSTANT * float(np.abs(position).max()):
        raise UnusableDataError("the joint does not move in any trial; record trials with motion in both directions")
    measured = np.concatenate([s.effort for s in signals])[usable]
    if not float(np.ptp(measured)) > CONSTANT * float(np.abs(measured).max()):
        raise UnusableDataError(
            f"{' x '.join(effort.channels)} is {measured[0]:.3g} {effort.unit} all the time; check the channel's "
            "mapping, or choose trials in which it is measured"
        )
    noise = max(_velocity_noise(s, facts, cutoff) for s in signals)
    slow = max(SLOW_SHARE * fast, NOISE_FACTOR * noise)
    trials = tuple(_make_trial(s, facts, cutoff, noise, slow, fast, span) for s in signals)
    plain = Dataset(trials, effort, facts, cutoff, processing.rows)
    settled = replace(plain, trials=_on_one_flank(trials), cache={})
    enough = max(FEWEST_ROWS, FLANK_SHARE * int(plain.counted.sum()))
    dataset = settled if int(settled.counted.sum()) >= enough else replace(plain, crosses_free_play=True)
    found = int(dataset.counted.sum())
    if found < FEWEST_ROWS:
        raise UnusableDataError(
            f"{found} rows where the joint moves faster than {slow:.3g} {facts.position_unit}/s; at least "
            f"{FEWEST_ROWS} are needed: record longer motion"
        )
    return dataset


def _check_conditions(recordings: Sequence[Recording]) -> None:
    """Raise where a load or a length is told, but not as a number: it would count as none."""
    for recording in recordings:
        for name in NUMERIC_CONDITIONS:
            value = recording.conditions.get(name, 0.0)
            if not isinstance(value, int | float) or not np.isfinite(value):
                raise UnusableDataError(
                    f"recording '{recording.name}': condition {name} is '{value}', wanted is a number; "
                    "correct it, or leave it out where it is not known"
                )


def _make_trial(
    signals: Signals, facts: Facts, cutoff_hz: float, noise: float, slow: float, fast: float, span: float
) -> Trial:
    nothing = np.zeros(len(signals.time_s))
    motion = Motion(
        facts=facts,
        conditions=signals.recording.conditions,
        time_s=signals.time_s - signals.time_s[0],
        position=signals.position,
        velocity=signals.velocity,
        acceleration=signals.acceleration,
        jerk=signals.jerk,
        direction=np.tanh(signals.velocity / max(noise, TINY_SHARE * slow)),
        load_effort=nothing,
        effort_rate=nothing,
        temperature_c=signals.temperature_c,
        supply_v=signals.supply_v,
        position_span=span,
        slow=slow,
        fast=fast,
    )
    step = max(1, int(signals.rate_hz / (ROWS_PER_CUTOFF_PERIOD * cutoff_hz)))
    picked = np.arange(step // 2, len(signals.time_s), step)
    picked = picked[signals.usable[picked]]
    return Trial(signals, motion, picked, classify(signals.velocity, slow, signals.rate_hz)[picked])


def _on_one_flank(trials: tuple[Trial, ...]) -> tuple[Trial, ...]:
    """The trials with rows near a crossing of the free play no longer counted as sliding."""
    made = []
    for trial in trials:
        crossing = near_flank_change(_carried(trial.motion), trial.signals.rate_hz)[trial.picked]
        sliding = trial.regime == Regime.SLIDING
        regime = np.where(sliding & crossing, Regime.TRANSIENT, trial.regime).astype(np.uint8)
        made.append(replace(trial, regime=regime))
    return tuple(made)


def _carried(motion: Motion) -> FloatArray:
    """Torque [N m] that the gear is known to carry: weight and inertia beyond it. All zero without known free play."""
    facts = motion.facts
    if not facts.backlash_rad or facts.joint == "linear":
        return np.zeros(len(motion.time_s))
    moment = 0.0 if facts.horizontal else motion.load_moment_n_m
    inertia = motion.load_inertia_kg_m2 + (facts.arm_inertia_kg_m2 or 0.0)
    return moment * np.sin(motion.position) + inertia * motion.acceleration


def _velocity_noise(signals: Signals, facts: Facts, cutoff_hz: float) -> float:
    """Standard deviation of the velocity from the position's quantisation, after the differentiation filter."""
    raw = signals.recording.channels[f"position_{facts.position_unit}"]
    steps = np.abs(np.diff(raw))
    steps = steps[steps > 0]
    if len(steps) == 0:
        return 0.0
    quantum = float(np.quantile(steps, 0.01))
    wide_hz = min(DIFFERENTIATION_FACTOR * cutoff_hz, 0.5 * signals.rate_hz)
    in_band = np.sqrt(wide_hz / (0.5 * signals.rate_hz))
    return float(quantum / np.sqrt(12.0) * in_band * 2.0 * np.pi * wide_hz / np.sqrt(3.0))
