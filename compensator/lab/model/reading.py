"""Where a joint is, as far as the model knows, when one of its effects says that the position sensor misreads it.

An angle that is misread by a few hundredths of a turn's radian shows speeds and accelerations that never were, and
friction, gravity and ripple are those of where the joint is. To first order each could have a column; the higher ones
of all effects together are as large as a small effect. So every column is made of the corrected position, and the
correction anew with every fit, until it stays (Gauss-Newton).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compensator.lab.effects.effect import Motion
from compensator.lab.model.linear import Term
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset, Trial

MOST_PASSES = 30  # each shrinks the change by the slope of what is misread, a few hundredths
STEEP = 0.5
SLOPE_STEP = 1e-5  # of the span of position
SAME_SHARE = 1e-3  # of the fastest speed: corrections whose rates differ by less are the same


def at_true_position(dataset: Dataset, terms: Sequence[Term]) -> Dataset:
    """The same rows where the terms of a fitted model say that the joint is; the same object where that is known."""
    reading = [term for term in terms if term.effect.misreads is not None and np.any(term.coefficients)]
    if not reading:
        return dataset.as_read()
    if any(_is_steep(reading, trial.motion) for trial in dataset.trials):
        return dataset.as_read()  # no sensor reads so: nothing is known of where the joint is
    positions = [_true_position(reading, trial) for trial in dataset.trials]
    if all(_is_same(p, trial.motion) for p, trial in zip(positions, dataset.trials, strict=True)):
        return dataset
    return dataset.corrected(
        [at_position(trial.motion, position) for trial, position in zip(dataset.trials, positions, strict=True)]
    )


def at_position(motion: Motion, position: FloatArray) -> Motion:
    """The motion at another position (n,), read as before; the way that it goes stays."""
    rate = 1.0 / motion.step_s
    speed = rate_of_change(position - motion.position, rate)
    acceleration = rate_of_change(speed, rate)
    return replace(
        motion,
        position=position,
        velocity=motion.velocity + speed,
        acceleration=motion.acceleration + acceleration,
        jerk=motion.jerk + rate_of_change(acceleration, rate),
        misread_acceleration=motion.misread_acceleration - acceleration,
    )


def _true_position(reading: Sequence[Term], trial: Trial) -> FloatArray:
    """Where the trial's joint is: it is misread at where it is, not at where it seems to be; shape (n,)."""
    read, position = trial.signals.position, trial.motion.position
    for _ in range(MOST_PASSES):
        before, there = position, replace(trial.motion, position=position)
        position = read + _misread(reading, there)
        if np.abs(position - before).max(initial=0.0) <= np.finfo(float).eps * np.abs(read).max(initial=1.0):
            break
    return position


def _misread(reading: Sequence[Term], motion: Motion) -> FloatArray:
    """What is to be added to the position that is read where a motion is, (n,)."""
    total = np.zeros(len(motion.time_s))
    for term in reading:
        assert term.effect.misreads is not None
        angles = term.effect.misreads(motion, term.shape)
        total += term.coefficients[: len(angles)] @ angles
    return total


def _is_steep(reading: Sequence[Term], motion: Motion) -> bool:
    """Whether what is misread changes so much with the position that the sensor would nearly stand, or turn back."""
    step = SLOPE_STEP * motion.position_span
    ahead, behind = (_misread(reading, replace(motion, position=motion.position + way * step)) for way in (0.5, -0.5))
    return bool(np.abs(ahead - behind).max(initial=0.0) >= STEEP * step)


def _is_same(position: FloatArray, motion: Motion) -> bool:
    change = rate_of_change(position - motion.position, 1.0 / motion.step_s)
    return bool(np.abs(change).max(initial=0.0) <= SAME_SHARE * motion.fast)
