"""What a fitted model says of where the joint is, of the load, and of the effort's rate: input of other terms.

The load that the gear transmits is gravity, springs, and the inertia of what hangs beyond the gear; the rotor's own
inertia is accelerated before the teeth. It is always the model's prediction, never the measured effort: built from the
measurement, a load-dependent term would explain the effort with itself.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compensator.lab.effects.effect import Motion
from compensator.lab.model.linear import Term
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.far_side import flights
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import SLOPE_STEP, Dataset, Trial

MOST_PASSES = 30  # each shrinks the change by the slope of what is misread, a few hundredths
STEEP = 0.5
SAME_SHARE = 1e-3  # of the fastest speed: corrections whose rates differ by less are the same


def with_own_prediction(dataset: Dataset, terms: Sequence[Term]) -> Dataset:
    """The rows, with the model's own predicted load and effort in every motion."""
    dataset = at_true_position(dataset, terms)
    acceleration = np.concatenate([trial.motion.acceleration for trial in dataset.trials])
    total, carried, slope = np.zeros((3, len(acceleration)))
    for term in terms:
        if term.effect.builds_on == "effort":
            continue  # its column is made of the rest
        part = term.coefficients @ dataset.at_full_rate(term.effect, term.shape)
        total += part
        if term.effect.carried:
            carried += part
            slope += term.coefficients @ dataset.slopes_at_full_rate(term.effect, term.shape)
    beyond, whole, of_load = _inertias(terms, dataset)
    load = carried + dataset.at_samples(beyond) * acceleration
    inertia = beyond if dataset.facts.arm_inertia_kg_m2 else whole
    driven = carried + dataset.at_samples(inertia) * acceleration
    parting = driven / dataset.at_samples(np.where(inertia == 0.0, np.inf, inertia))
    inertias = np.stack([inertia, whole, of_load])
    dataset = dataset.with_prediction(load, total, parting, slope, inertias, _late_s(terms), _back_emf(dataset, terms))
    steep = [term for term in terms if term.effect.slope is not None and np.any(term.coefficients)]
    if not steep:
        return dataset
    motions = [trial.motion for trial in dataset.trials]
    return dataset.with_bend([_bend(steep, one) for one in motions], [_doubt(steep, one) for one in motions])


def _late_s(terms: Sequence[Term]) -> float:
    """By how much the position is older than the effort."""
    return next((float(term.coefficients[0]) for term in terms if term.effect.name == "measurement_delay"), 0.0)


def _back_emf(dataset: Dataset, terms: Sequence[Term]) -> float:
    """Effort per speed that drives no current: of a voltage, all that goes by the speed where no constant is told.

    Of a motor's voltage at speed that is most by far; what grease takes of it is little beside.
    """
    if dataset.effort_definition.quantity != "terminal_voltage":
        return 0.0
    told = dataset.facts.back_emf_v_s_rad
    return told or next((float(term.coefficients[0]) for term in terms if term.effect.name == "viscous"), 0.0)


def beyond_tangent(dataset: Dataset, terms: Sequence[Term], index: int, coefficients: FloatArray) -> FloatArray:
    """What a model that bends predicts with other coefficients (K,), less what its columns make of them.

    Returns:
        Of the rows of one trial, shape (n,).
    """
    trial = dataset.trials[index]
    ends = np.cumsum([len(term.coefficients) for term in terms])[:-1]
    parts = list(zip(terms, np.split(coefficients, ends), strict=True))
    shares = [part @ t.effect.columns(trial.motion, t.shape) for t, part in parts if t.effect.builds_on != "effort"]
    total = np.sum(shares, axis=0)
    moved = replace(trial.motion, predicted=total)
    found = trial.motion.bend * (trial.motion.predicted - total)
    for term, part in parts:
        if term.effect.slope is not None:
            found = found + part @ (
                term.effect.columns(moved, term.shape) - term.effect.columns(trial.motion, term.shape)
            )
    return replace(dataset, trials=(trial,), cache={}, unfiltered={}).stack([found[None]])[:, 0]


def _bend(steep: Sequence[Term], motion: Motion) -> FloatArray:
    """What steep terms add for each unit of effort that is predicted more, shape (n,)."""
    bend = np.zeros(len(motion.time_s))
    for term in steep:
        assert term.effect.slope is not None
        bend += term.coefficients @ term.effect.slope(motion, term.shape)
    return bend


def _doubt(steep: Sequence[Term], motion: Motion) -> FloatArray:
    """By how much steep terms may be wrong for what teeth do in the free play that is known, shape (n,).

    Where the far side flies, or is caught, the effort is another one than a rigid gear's, and so may its sign be. In
    the measure of a bend: over the effort at which steep terms are steep.
    """
    doubt, gap = np.zeros(len(motion.time_s)), motion.facts.backlash_rad
    if not gap or motion.inertia_beyond == 0.0:
        return doubt
    around_zero = replace(motion, predicted=np.zeros(1))
    for second in flights(motion.parting, gap, motion.step_s):
        moved = replace(motion, predicted=motion.predicted - motion.inertia_beyond * second)
        for term in steep:
            assert term.effect.slope is not None
            change = term.effect.columns(moved, term.shape) - term.effect.columns(motion, term.shape)
            steepest = term.effect.slope(around_zero, term.shape)
            doubt = np.maximum(doubt, np.abs(np.abs(term.coefficients) @ (np.abs(change) * steepest)))
    return doubt


def effort_per_torque(dataset: Dataset, terms: Sequence[Term]) -> float | None:
    """Effort per N m of load: 1 where the effort is a torque, else by the load's known weight, if any."""
    if dataset.effort_definition.unit in ("N m", "N"):
        return 1.0
    gravity = next((term for term in terms if term.effect.name == "gravity"), None)
    if gravity is None:
        return None
    arm, scale = gravity.coefficients
    if scale > 0.0:
        return float(scale)
    moments = [trial.motion.load_moment_n_m for trial in dataset.trials]
    return float(arm / max(moments)) if max(moments) > 0.0 and arm > 0.0 else None


def _inertias(terms: Sequence[Term], dataset: Dataset) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Effort per acceleration in each trial: of what hangs beyond the gear, of everything, of the tip load.

    Beyond the gear is what is known to be there; of a linear joint, all of it. The tip load is by its weight where that
    tells, else as it was fitted.
    """
    per_torque, tip_kg_m2 = effort_per_torque(dataset, terms), dataset.tip_kg_m2
    whole = whole_inertia(terms, tip_kg_m2)
    unknown = np.zeros(len(whole)) if dataset.facts.joint == "rotary" else whole
    if per_torque is None:
        return unknown, whole, _inertia(terms)[1] * tip_kg_m2
    beyond_kg_m2 = tip_kg_m2 + (dataset.facts.arm_inertia_kg_m2 or 0.0)
    beyond = np.where(beyond_kg_m2 > 0.0, per_torque * beyond_kg_m2, unknown)
    return beyond, whole, np.minimum(per_torque * tip_kg_m2, whole)


def whole_inertia(terms: Sequence[Term], tip_kg_m2: FloatArray) -> FloatArray:
    """Effort per acceleration of everything, rotor and all, with each load: the best guess where no drawing tells."""
    alone, of_load = _inertia(terms)
    found: FloatArray = alone + of_load * tip_kg_m2
    return found


def _inertia(terms: Sequence[Term]) -> FloatArray:
    """As it was fitted: without load, and for each kg m^2 of it; shape (2,)."""
    inertia = next((term for term in terms if term.effect.name == "inertia"), None)
    return np.zeros(2) if inertia is None else inertia.coefficients


def at_true_position(dataset: Dataset, terms: Sequence[Term]) -> Dataset:
    """The same rows where the terms of a fitted model say that the joint is; the same object where that is known.

    An angle that is misread by a few hundredths of a turn's radian shows speeds and accelerations that never were, and
    friction, gravity and ripple are those of where the joint is. To first order each could have a column; the higher
    ones of all effects together are as large as a small effect. So every column is made of the corrected position, and
    the correction anew with every fit, until it stays (Gauss-Newton).
    """
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
