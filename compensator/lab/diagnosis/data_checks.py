"""Problems of the data themselves, looked for before any effect is: a wrong sign or one odd trial mimics physics."""

from collections.abc import Sequence

import numpy as np
from scipy.stats import spearmanr

from compensator.lab.diagnosis.alien_effort import alien_effort
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import LEAST_OF_EFFORT, rms
from compensator.lab.model.intervals import standard_errors
from compensator.lab.model.linear import solve, solve_without
from compensator.lab.recordings.processing import SATURATED_DUTY, Signals
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.recordings.stuck_sensor import stuck_positions
from compensator.lab.rows.dataset import FEWEST_ROWS, Dataset

ODD_TRIAL_FACTOR = 4.0  # times the median trial's error
FEWEST_TRIALS_TO_COMPARE = 5
SATURATED_SHARE = 0.2
MIRRORED = 0.5  # of the error of one trial: what turning the sign of its effort must bring
UNLIKE = 2.0  # times what the median of the other trials leaves: less is what the model leaves anywhere
FEWEST_ROWS_OF_ODD = 5  # of a trial: an error of four times the others' is no chance in so many
TENFOLD = 10.0  # what loads seem to weigh of what they are said to, or the reverse: more is another unit
WORSE = 1.5  # times the error that the loads as told leave, for that to be sure
ABOUT_TOLD = 0.25  # of an arm's weight: masses and centres are known so well at the least
SURELY = 3.0  # standard deviations
ORDERED = 0.95  # rank correlation of two conditions over the trials
WARMER_K = 2.0
MOST_NAMES = 3


def fatal_problems(fit: Fit) -> list[str]:
    """Problems that make any ranking of effects one of noise, whatever is missing: stuck sensors, signs, units."""
    stuck = stuck_positions([trial.signals.recording for trial in fit.dataset.trials], fit.dataset.facts)
    return [*stuck, *_mirrored_trials(fit), *_load_units(fit)]


def data_problems(fit: Fit) -> list[str]:
    """Sentences, each naming the trial or channel, what was found, and what to do; those that are fatal first."""
    alien = alien_effort(fit)
    return [*fatal_problems(fit), *([] if alien is None else [alien.text]), *lesser_problems(fit)]


def lesser_problems(fit: Fit) -> list[str]:
    """Those with which effects can be ranked: what loads and warmth do together, and trials that are odd or idle."""
    return [
        *_arm_weight(fit),
        *_half_told_loads(fit),
        *_ordered_conditions(fit),
        *_odd_trials(fit),
        *_few_usable(fit),
        *_unused(fit),
        *_same_samples(fit),
    ]


def _mirrored_trials(fit: Fit) -> list[str]:
    """Trials that the model explains far better with their effort turned: fitted to all others, and to them, too.

    The others alone may leave open what this trial is the only one to tell, and be wrong about it by any amount. Where
    the others leave about as much, what is missing in all of them may outweigh the small effort of a coast-down.
    """
    dataset, found = fit.dataset, []
    kept = np.concatenate([term.kept for term in fit.terms])
    bounds, columns, effort = fit.bounds.of(kept), fit.columns[:, kept], fit.target
    training = columns[fit.training]
    whole = training.T @ training, training.T @ effort[fit.training]
    for index, there in enumerate(dataset.trial_rows):
        rows = there.start + np.flatnonzero(dataset.counted[there])
        trained = rows[fit.training[rows]]
        own, own_effort = columns[trained], effort[trained]
        without = solve_without(whole, (own.T @ own, own.T @ own_effort), bounds)
        predicted = columns[rows] @ without
        as_is, turned = (rms(sign * effort[rows] - predicted) for sign in (1.0, -1.0))
        if len(rows) >= FEWEST_ROWS and turned < MIRRORED * as_is:
            others = _errors(dataset, effort - columns @ without, dataset.counted)
            others.pop(index, None)
            if others and as_is < UNLIKE * float(np.median(list(others.values()))):
                continue
            nothing = np.zeros_like(whole[0])
            with_turned = solve_without(whole, (nothing, 2.0 * own.T @ own_effort), bounds)
            if rms(-effort[rows] - columns[rows] @ with_turned) > MIRRORED * rms(fit.residual[rows]):
                continue
            found.append(
                f"trial '{dataset.trials[index].signals.recording.name}' has the other sign: its effort leaves "
                f"{as_is:.3g} {dataset.effort_definition.unit}, turned {turned:.3g}; turn it, or leave the trial out"
            )
    return found


def _errors(dataset: Dataset, residual: FloatArray, rows: BoolArray, fewest: int = 1) -> dict[int, float]:
    """What each trial that has so many of some rows (N,) leaves of them, root mean square, by its index."""
    return {
        index: rms(residual[there][own])
        for index, there in enumerate(dataset.trial_rows)
        if int((own := rows[there]).sum()) >= fewest
    }


def _load_units(fit: Fit) -> list[str]:
    """Loads that seem to weigh far more, or less, than they are said to, where the effort is known in N m."""
    gravity = next((term for term in fit.terms if term.effect.name == "gravity"), None)
    if gravity is None or not gravity.kept[1] or fit.dataset.effort_definition.unit != "N m":
        return []
    scale = float(gravity.coefficients[1])
    if 1.0 / TENFOLD < scale < TENFOLD:
        return []
    columns, effort = fit.training_equations
    place = sum(len(term.coefficients) for term in fit.terms[: fit.terms.index(gravity)]) + 1
    kept = np.arange(columns.shape[1]) != place
    given = effort - columns[:, place]  # the loads as told
    left = given - columns[:, kept] @ solve(columns[:, kept], given, fit.bounds.of(kept)).coefficients
    if rms(left) < WORSE * rms(effort - columns @ fit.coefficients):
        return []
    channels = " or ".join(fit.dataset.effort_definition.channels)
    seems = "nothing" if scale <= 0.0 else f"{scale:.3g} times what load_kg and arm_m say"
    return [
        f"the loads seem to weigh {seems}: check the units of {channels} (mA for A makes 1000), of load_kg (g for kg "
        "makes 0.001), of arm_m and of position (degrees), and which trial had which load"
    ]


def _arm_weight(fit: Fit) -> list[str]:
    """An arm that weighs otherwise than the rig says, where the effort is known in N m."""
    told = fit.dataset.facts.arm_moment_n_m
    firsts = np.cumsum([0, *(len(term.coefficients) for term in fit.terms)])
    swung = [first for first, term in zip(firsts, fit.terms, strict=False) if term.effect.by_angle and term.kept[0]]
    if not told or not swung or fit.dataset.effort_definition.unit != "N m":
        return []
    found = float(np.linalg.norm(fit.coefficients[swung]))
    error = float(np.linalg.norm(standard_errors(fit)[0][swung]))
    if not abs(found - told) > ABOUT_TOLD * told + SURELY * error:
        return []
    return [
        f"the arm weighs {found:.3g} N m at 90 degrees by the model, and {told:.3g} N m by the rig (arm.mass_kg x "
        "arm.centre_of_mass_m x g): check these; if they are right, something else goes by the position, as a spring "
        "or a cable does"
    ]


def _half_told_loads(fit: Fit) -> list[str]:
    """Loads that count as none, since a trial does not tell its own, or nobody tells where they hang."""
    motions = [(trial.motion, trial.signals.recording.name) for trial in fit.dataset.trials]
    loaded = [(motion, name) for motion, name in motions if motion.load_kg != 0.0]
    silent = [f"'{name}'" for motion, name in motions if "load_kg" not in motion.conditions]
    found = []
    if loaded and silent:
        found.append(
            f"{some_of(silent)} do not tell load_kg, others do: they count as without load; tell it of each trial"
        )
    armless = [f"'{name}'" for motion, name in loaded if motion.facts.joint == "rotary" and motion.arm_m == 0.0]
    if armless:
        found.append(
            f"load_kg of {some_of(armless)} is told, and not where it hangs: its weight and inertia count as none; put "
            "arm.length_m [m] into the rig, or arm_m into the conditions of the trials"
        )
    return found


def _ordered_conditions(fit: Fit) -> list[str]:
    """Load and warmth in step over the trials: what one does, the other could do."""
    trials = fit.dataset.trials
    loads = np.array([trial.motion.load_kg for trial in trials])
    warmth = np.array([float(np.mean(trial.motion.temperature_c)) for trial in trials])
    if len(trials) < FEWEST_TRIALS_TO_COMPARE or not np.ptp(loads) > 0.0 or not np.ptp(warmth) >= WARMER_K:
        return []
    together = float(spearmanr(loads, warmth).statistic)
    if abs(together) < ORDERED:
        return []
    which = "heavier" if together > 0.0 else "lighter"
    return [
        f"the {which} the load, the warmer the joint, over all trials: effects of load and of temperature cannot be "
        "told apart; repeat the first load at the end, or the last one cold"
    ]


def _odd_trials(fit: Fit) -> list[str]:
    """A trial that is unlike the others, in a sentence; where several are, what they share is no disturbance of one."""
    dataset, unit = fit.dataset, fit.dataset.effort_definition.unit
    errors = _errors(dataset, fit.residual, fit.training, FEWEST_ROWS_OF_ODD)
    if len(errors) < FEWEST_TRIALS_TO_COMPARE:
        return []
    median, worst = float(np.median(list(errors.values()))), max(errors.values())
    # where nothing is noisy, the errors are those of filters and rounding, and differ by any factor
    odd = max(ODD_TRIAL_FACTOR * median, LEAST_OF_EFFORT * rms(dataset.effort[fit.training]))
    if worst <= odd:
        return []
    apart = sorted((index for index in errors if errors[index] > min(odd, worst / UNLIKE)), key=lambda i: -errors[i])
    names = [f"'{dataset.trials[index].signals.recording.name}'" for index in apart]
    if len(names) == 1:
        return [
            f"trial {names[0]} is unlike the others: its error is {worst:.3g} {unit}, the median trial's is "
            f"{median:.3g}; look at it, and leave it out if it was disturbed"
        ]
    return [
        f"trials {some_of(names)} are unlike the others: their errors are {errors[apart[-1]]:.3g} to {worst:.3g} "
        f"{unit}, the median trial's is {median:.3g}; look at what they share, and leave none out for its error alone"
    ]


def _few_usable(fit: Fit) -> list[str]:
    """Trials under saturation for much of their time, in one sentence: where loads are too heavy, most are."""
    found = []
    for trial in fit.dataset.trials:
        left_out = 1.0 - float(np.mean(trial.signals.usable))
        duty = trial.signals.recording.channels.get("duty")
        at_limit = 0.0 if duty is None else float(np.mean(np.abs(duty) >= SATURATED_DUTY))
        if at_limit > SATURATED_SHARE:
            found.append((at_limit, left_out, f"'{trial.signals.recording.name}'"))
    if not found:
        return []
    at_limit, left_out, worst = max(found)
    others = [name for _, _, name in sorted(found, reverse=True)[1:]]
    also = f" (and for more than {SATURATED_SHARE:.0%} in {some_of(others)})" if others else ""
    return [
        f"trial {worst}: the duty is at its limit for {at_limit:.0%} of the time and {left_out:.0%} of the rows are "
        f"left out{also}; record with a lighter load or slower"
    ]


def _unused(fit: Fit) -> list[str]:
    """Trials of no use to any effect. Those that only reverse still tell of effects with memory."""
    dataset = fit.dataset
    used = set(np.unique(dataset.trial_index[dataset.in_regimes("moving")]).tolist())
    idle: dict[tuple[str, str], list[str]] = {}
    for index, trial in enumerate(dataset.trials):
        if index not in used:
            idle.setdefault(_why_idle(trial.signals), []).append(f"'{trial.signals.recording.name}'")
    return [
        f"not used, since {why}: {', '.join(names)}; {remedy}, or leave them out"
        for (why, remedy), names in idle.items()
    ]


def _why_idle(signals: Signals) -> tuple[str, str]:
    """Why no row of a trial shows motion, and what to record: what takes most samples, where that can be seen."""
    channels = signals.recording.channels
    off = 1.0 - float(np.mean(channels["enabled"] > 0.5)) if "enabled" in channels else 0.0
    at_limit = float(np.mean(np.abs(channels["duty"]) >= SATURATED_DUTY)) if "duty" in channels else 0.0
    if not signals.usable.any() and off > max(at_limit, SATURATED_SHARE):
        return "the power stage is off in all that could be used of them (enabled = 0)", "record with it on"
    if not signals.usable.any() and at_limit > SATURATED_SHARE:
        return (
            "the duty is at its limit in all that could be used of them",
            "record motion, with the duty below its limit",
        )
    return "the joint does not move in any usable row of theirs", "record motion"


def _same_samples(fit: Fit) -> list[str]:
    """Copies are not independent: a trial that judges its own copy proves nothing."""
    names: dict[tuple[bytes, bytes], list[str]] = {}
    for trial in fit.dataset.trials:
        # a commanded effort is the same in every repeat: the motion tells whether a trial is one
        samples = trial.signals.effort.tobytes(), trial.signals.position.tobytes()
        names.setdefault(samples, []).append(f"'{trial.signals.recording.name}'")
    return [
        f"trials {', '.join(same)} hold the same samples: held-out errors and intervals look better than they are; "
        "keep one of them"
        for same in names.values()
        if len(same) > 1
    ]


def some_of(names: Sequence[str]) -> str:
    """The first few of them, and how many more there are."""
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more
