"""From recordings to a dataset: one effort, one cut-off, and which of every trial's samples are rows."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from compensator.lab import progress
from compensator.lab.effects.effect import Motion
from compensator.lab.errors import NeverSlidesError, UnusableDataError
from compensator.lab.recordings.bandwidth import choose_cutoff_hz
from compensator.lab.recordings.channel_checks import check_channels
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.processing import DIFFERENTIATION_FACTOR, SATURATED_DUTY, Signals, make_signals
from compensator.lab.recordings.pushed import pushed
from compensator.lab.recordings.recording import SESSION_START, FloatArray, Recording
from compensator.lab.recordings.regimes import CARRIED_PERIODS, Regime, classify, near_flank_change
from compensator.lab.recordings.reversals import start_rate
from compensator.lab.rows.dataset import Dataset, Processing, Scales, Trial

SLOW_SHARE = 0.02  # of the 95 % quantile of speed: below, the direction of motion is uncertain
NOISE_FACTOR = 3.0  # slow is at least this many standard deviations of the velocity noise
COARSE_SHARE = 0.5  # of the same speed: where the noise alone makes so much slow, no longer trial helps
TINY_SHARE = 0.01  # of slow: the sign of velocity is never smoothed less, so that it stays differentiable
ROWS_PER_CUTOFF_PERIOD = 2.5  # Nyquist rate and a margin for the filter's slope: at 2.0 the errors alias
NUMERIC_CONDITIONS = ("load_kg", "arm_m", SESSION_START)
FEWEST_ROWS = 40
LOWEST_STEPS = 0.01
CONSTANT = 1e-9  # of its largest value: what changes less does not change
WANTED_MOTION = "record trials with motion in both directions: sines or triangles of several speeds"
FLANK_SHARE = 0.1  # of the sliding rows that must be left when those near a crossing of the free play are dropped


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
    facts = replace(facts, effort=effort.quantity, supply_is_nominal=_supply_is_nominal(recordings, facts))
    check_channels(recordings, effort, facts)
    cutoff = processing.cutoff_hz or choose_cutoff_hz(recordings, effort, facts)
    signals = [make_signals(recording, effort, facts, cutoff) for recording in recordings]
    usable = np.concatenate([s.usable for s in signals])
    if not usable.any():
        _check_effort(np.concatenate([s.effort for s in signals]), effort)
        raise UnusableDataError(_no_usable(recordings, effort, facts))
    speed = np.abs(np.concatenate([s.velocity for s in signals]))[usable]
    position = np.concatenate([s.position for s in signals])[usable]
    fast, span = float(np.quantile(speed, 0.95)), float(np.ptp(position))
    _check_effort(np.concatenate([s.effort for s in signals])[usable], effort)
    if (found_stuck := pushed(recordings, effort, facts)) is not None:
        raise NeverSlidesError(found_stuck.in_words())
    if not span > CONSTANT * float(np.abs(position).max()):
        raise UnusableDataError(f"the joint does not move in any trial; {WANTED_MOTION}")
    noise = _velocity_noise(signals, facts, cutoff)
    slow = max(SLOW_SHARE * fast, NOISE_FACTOR * noise)
    scales = Scales(noise, slow, fast, span, _session_span_s(signals), _usual_start_rate(signals, slow))
    trials = _with_way([_make_trial(s, facts, cutoff, scales) for s in progress.each(signals)])
    plain = Dataset(trials, effort, facts, cutoff, processing.rows, scales)
    settled = replace(plain, trials=_on_one_flank(trials, cutoff), cache={}, unfiltered={})
    enough = max(FEWEST_ROWS, FLANK_SHARE * int(plain.counted.sum()))
    dataset = settled if int(settled.counted.sum()) >= enough else replace(plain, crosses_free_play=True)
    if int(dataset.counted.sum()) < FEWEST_ROWS:
        raise UnusableDataError(_too_few(dataset, int((speed > slow).sum()), len(speed)))
    return dataset


def _too_few(dataset: Dataset, moving: int, samples: int) -> str:
    """Why a dataset has too few rows that count, and what would give more.

    Args:
        dataset: with them.
        moving: samples that are faster than what is too slow to tell a direction.
        samples: that can be used.
    """
    rows, near = len(dataset.regime), int((dataset.regime == Regime.TRANSIENT).sum())
    if moving < FEWEST_ROWS:
        remedy = WANTED_MOTION
    elif NOISE_FACTOR * dataset.scales.noise > COARSE_SHARE * dataset.scales.fast:
        remedy = "the position resolves no slower motion: use a sensor of more counts, or move faster"
    elif near >= FEWEST_ROWS:
        remedy = "record longer strokes at a steady speed, or count the rows near reversals, too (rows = moving)"
    else:
        remedy = "record for longer"
    return (
        f"{int(dataset.counted.sum())} rows count, and at least {FEWEST_ROWS} are needed: the joint moves faster than "
        f"{dataset.scales.slow:.3g} {dataset.facts.position_unit}/s in {moving} of {samples} usable samples, which are "
        f"{rows} rows at the cut-off of {dataset.cutoff_hz:.3g} Hz, {near} of them near a start or reversal; {remedy}"
    )


def _supply_is_nominal(recordings: Sequence[Recording], facts: Facts) -> bool | None:
    """What the owner says; else True where the supply keeps to the last digit what it was in every trial.

    A reading of a supply under load changes at least in its last digit. None where no trial has one.
    """
    readings = [one.channels["supply_v"] for one in recordings if "supply_v" in one.channels]
    if facts.supply_is_nominal is not None or not readings:
        return facts.supply_is_nominal
    return all(len(np.unique(values[np.isfinite(values)])) <= 1 for values in readings)


def more_trials(dataset: Dataset, recordings: Sequence[Recording]) -> Dataset:
    """Rows of other trials of the same joint, made with the very cut-off and scales of a dataset; none of its own.

    Raises:
        UnusableDataError: as `make_signals`.
    """
    effort, facts, cutoff = dataset.effort_definition, dataset.facts, dataset.cutoff_hz
    scales = dataset.scales_for_others
    signals = [make_signals(recording, effort, facts, cutoff) for recording in recordings]
    trials = tuple(_make_trial(s, facts, cutoff, scales) for s in signals)
    trials = trials if dataset.crosses_free_play else _on_one_flank(trials, cutoff)
    rows = replace(dataset, trials=trials, scales=scales, uncorrected=None, cache={}, unfiltered={})
    return replace(rows, held_out=frozenset())


def usable(dataset: Dataset, recordings: Sequence[Recording]) -> list[Recording]:
    """Those recordings that the dataset could be given: others are too short for its filter, or lack a channel."""
    found = []
    for recording in recordings:
        try:
            make_signals(recording, dataset.effort_definition, dataset.facts, dataset.cutoff_hz)
        except UnusableDataError:
            continue
        found.append(recording)
    return found


def _check_effort(measured: FloatArray, effort: Effort) -> None:
    """Raise where the effort is the same all the time: nobody measured it."""
    known = measured[np.isfinite(measured)]
    if len(known) and not float(np.ptp(known)) > CONSTANT * float(np.abs(known).max()):
        raise UnusableDataError(
            f"{' x '.join(effort.channels)} is {known[0]:.3g} {effort.unit} all the time; check the channel's "
            "mapping, or choose trials in which it is measured"
        )


def _no_usable(recordings: Sequence[Recording], effort: Effort, facts: Facts) -> str:
    """Why no row of any recording is left, and what to record instead: the reason that takes most samples."""
    names = (f"position_{facts.position_unit}", *effort.channels)
    unknown, off, saturated = (
        float(np.mean(np.concatenate([of(recording) for recording in recordings])))
        for of in (
            lambda one: ~np.isfinite([one.channels[name] for name in names]).all(axis=0),
            lambda one: ~(one.channels.get("enabled", np.ones(len(one))) > 0.5),
            lambda one: np.abs(one.channels.get("duty", np.zeros(len(one)))) >= SATURATED_DUTY,
        )
    )
    if saturated > max(unknown, off):
        return (
            f"no usable rows: the duty is at its limit in {saturated:.0%} of the samples, where it tells nothing "
            "of the load; record with a lighter load or slower"
        )
    if off > unknown:
        return f"no usable rows: the power stage is off in {off:.0%} of the samples; record with it on"
    if unknown > 0.0:
        return (
            f"no usable rows: {' or '.join(names)} is missing in {unknown:.0%} of the samples, and no stretch without "
            "a gap is long enough to be filtered; leave out the lines that do not hold all of them (time may be "
            "irregular), or record all channels at every sample"
        )
    return "no usable rows: the trials are too short, or all gaps; record longer ones"


def _session_span_s(signals: Sequence[Signals]) -> float:
    """From the start of the first trial to the end of the last, as far as the trials tell when they began."""
    starts = [float(s.recording.conditions.get(SESSION_START, 0.0)) for s in signals]
    ends = [start + float(s.time_s[-1] - s.time_s[0]) for start, s in zip(starts, signals, strict=True)]
    return max(ends) - min(starts)


def _usual_start_rate(signals: Sequence[Signals], slow: float) -> float:
    """Geometric mean of the rates at which the effort changes when the joint stands, one of each sample after."""
    rates = np.concatenate([start_rate(s.effort, s.velocity, s.rate_hz, slow) for s in signals])
    known = rates[rates > 0.0]
    return float(np.exp(np.mean(np.log(known)))) if len(known) else float("nan")


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


def _make_trial(signals: Signals, facts: Facts, cutoff_hz: float, scales: Scales) -> Trial:
    nothing = np.zeros(len(signals.time_s))
    rate = start_rate(signals.effort, signals.velocity, signals.rate_hz, scales.slow)
    motion = Motion(
        facts=facts,
        conditions=signals.recording.conditions,
        time_s=signals.time_s - signals.time_s[0],
        position=signals.position,
        velocity=signals.velocity,
        acceleration=signals.acceleration,
        jerk=signals.jerk,
        direction=np.tanh(signals.velocity / max(scales.noise, TINY_SHARE * scales.slow)),
        load_effort=nothing,
        inertia_beyond=0.0,
        inertia=0.0,
        parting=nothing,
        predicted=nothing,
        effort_rate=nothing,
        largest_effort=0.0,
        bend=nothing,
        temperature_c=signals.temperature_c,
        supply_v=signals.supply_v,
        position_span=scales.position_span,
        session_span_s=scales.session_span_s,
        slow=scales.slow,
        fast=scales.fast,
        measured_load=signals.load,
        start_rate=np.where(np.isfinite(rate), rate, scales.start_rate),
        usual_start_rate=scales.start_rate,
    )
    step = max(1, int(signals.rate_hz / (ROWS_PER_CUTOFF_PERIOD * cutoff_hz)))
    picked = np.arange(step // 2, len(signals.time_s), step)
    picked = picked[signals.usable[picked]]
    regimes = classify(signals.velocity, scales.slow, signals.rate_hz, cutoff_hz)
    regimes = np.where(signals.usable, regimes, Regime.STUCK).astype(np.uint8)
    return Trial(signals, motion, picked, regimes, _window(regimes, signals.rate_hz, cutoff_hz))


def _window(regimes: NDArray[np.uint8], rate_hz: float, cutoff_hz: float) -> FloatArray:
    """Weights of the samples (n,) that rows in steady sliding see: 1 in it, 0 outside.

    They rise as far as the filter carries a step. What the filter of the position leaves out of an acceleration is
    fast: a sharp edge would carry it into the band.
    """
    inside = regimes == Regime.SLIDING
    if inside.all():
        return np.ones(len(inside))
    way = np.minimum(distance_transform_edt(inside) * cutoff_hz / (CARRIED_PERIODS * rate_hz), 1.0)
    found: FloatArray = np.sin(0.5 * np.pi * way) ** 2
    return found


def _with_way(trials: Sequence[Trial]) -> tuple[Trial, ...]:
    """The trials, each knowing the way before it."""
    starts = np.array([trial.motion.session_s[0] for trial in trials])
    if len(np.unique(starts)) < len(starts):
        return tuple(trials)  # nobody tells when they began
    order = np.argsort(starts)
    ways = np.array([float(np.sum(np.abs(trial.motion.velocity)) * trial.motion.step_s) for trial in trials])[order]
    before = np.empty(len(trials))
    before[order] = np.cumsum(ways) - ways
    usual = float(ways.sum()) / trials[0].motion.session_span_s
    return tuple(
        replace(trial, motion=replace(trial.motion, travelled=float(way), usual_speed=usual))
        for trial, way in zip(trials, before, strict=True)
    )


def _on_one_flank(trials: tuple[Trial, ...], cutoff_hz: float) -> tuple[Trial, ...]:
    """The trials with samples near a crossing of the free play no longer counted as sliding."""
    made = []
    for trial in trials:
        crossing = near_flank_change(_carried(trial.motion), trial.signals.rate_hz)
        if crossing.any():
            regimes = np.maximum(trial.regimes, np.where(crossing, Regime.TRANSIENT, Regime.SLIDING)).astype(np.uint8)
            window = _window(regimes, trial.signals.rate_hz, cutoff_hz)
            trial = replace(trial, regimes=regimes, window=window)
        made.append(trial)
    return tuple(made)


def _carried(motion: Motion) -> FloatArray:
    """Torque [N m] that the gear is known to carry: weight and inertia beyond it. All zero without known free play."""
    facts = motion.facts
    if not facts.backlash_rad or facts.joint == "linear":
        return np.zeros(len(motion.time_s))
    moment = 0.0 if facts.horizontal else motion.moment_n_m
    inertia = motion.load_inertia_kg_m2 + (facts.arm_inertia_kg_m2 or 0.0)
    return moment * np.sin(motion.position) + inertia * motion.acceleration


def _velocity_noise(signals: Sequence[Signals], facts: Facts, cutoff_hz: float) -> float:
    """Standard deviation of the velocity from the position's quantisation, after the differentiation filter.

    One sensor measures all trials, so there is one count; where the rate differs, the noisiest trial counts.
    """
    count = facts.position_count or _finest_step(signals, facts)
    return max(_noise_of_count(count, s.rate_hz, cutoff_hz) for s in signals)


def _noise_of_count(count: float, rate_hz: float, cutoff_hz: float) -> float:
    """Of white rounding errors, uniform over one count, differentiated within the band of the wide filter."""
    wide_hz = min(DIFFERENTIATION_FACTOR * cutoff_hz, 0.5 * rate_hz)
    in_band = np.sqrt(wide_hz / (0.5 * rate_hz))
    return float(count / np.sqrt(12.0) * in_band * 2.0 * np.pi * wide_hz / np.sqrt(3.0))


def _finest_step(signals: Sequence[Signals], facts: Facts) -> float:
    """The position's count as the recordings tell: the slowest trial shows it, a fast one steps over several at once.

    The lowest percent of a trial's steps is left out, which rounding in a file can make smaller than a count.
    """
    found = []
    for one in signals:
        steps = np.abs(np.diff(one.recording.channels[f"position_{facts.position_unit}"]))
        steps = steps[steps > 0]
        if len(steps):
            found.append(float(np.quantile(steps, LOWEST_STEPS)))
    return min(found, default=0.0)
