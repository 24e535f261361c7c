"""Problems of the data themselves, looked for before any effect is: a wrong sign or one odd trial mimics physics."""

import numpy as np

from compensator.lab.fit import Fit
from compensator.lab.validation import relative_error, rms

ODD_TRIAL_FACTOR = 4.0  # times the median trial's error
FEWEST_TRIALS_TO_COMPARE = 5
SATURATED_SHARE = 0.2
UNEXPLAINED = 0.8  # of the effort: a rigid joint with friction explains more, whatever it lacks
DISSIPATIVE = ("inertia", "coulomb", "viscous")


def data_problems(fit: Fit) -> list[str]:
    """Sentences, each naming the trial or channel, what was found, and what to do."""
    return [
        *_wrong_sign(fit),
        *_unexplained(fit),
        *_odd_trials(fit),
        *_few_usable(fit),
        *_unused(fit),
        *_same_samples(fit),
    ]


def _wrong_sign(fit: Fit) -> list[str]:
    held = [
        term.effect.name
        for term in fit.terms
        if term.effect.name in DISSIPATIVE and term.kept[0] and term.at_bound[0] and term.coefficients[0] <= 0.0
    ]
    if "inertia" in held and len(held) > 1:
        return [
            f"{' and '.join(held)} would be negative: effort and motion have opposite signs, or one lags far behind "
            "the other; check the sign of the effort channel and of position"
        ]
    return []


def _unexplained(fit: Fit) -> list[str]:
    error = relative_error(fit.residual[fit.training], fit.dataset.effort[fit.training])
    if error < UNEXPLAINED or not set(DISSIPATIVE) <= set(fit.names):
        return []
    return [
        f"inertia and friction explain next to nothing: the error is {error:.0%} of the effort; check that effort and "
        "position are of the same joint and time, and their units"
    ]


def _odd_trials(fit: Fit) -> list[str]:
    dataset, found = fit.dataset, []
    errors = {}
    for index in np.unique(dataset.trial_index[fit.training]):
        rows = fit.training & (dataset.trial_index == index)
        errors[int(index)] = rms(fit.residual[rows])
    if len(errors) < FEWEST_TRIALS_TO_COMPARE:
        return []
    median = float(np.median(list(errors.values())))
    for index, error in errors.items():
        if error > ODD_TRIAL_FACTOR * median:
            name = dataset.trials[index].signals.recording.name
            found.append(
                f"trial '{name}' is unlike the others: its error is {error:.3g} {dataset.effort_definition.unit}, the "
                f"median trial's is {median:.3g}; look at it, and leave it out if it was disturbed"
            )
    return found


def _few_usable(fit: Fit) -> list[str]:
    found = []
    for trial in fit.dataset.trials:
        share = 1.0 - float(np.mean(trial.signals.usable))
        saturated = trial.signals.recording.channels.get("duty")
        at_limit = 0.0 if saturated is None else float(np.mean(np.abs(saturated) >= 0.98))
        if at_limit > SATURATED_SHARE:
            found.append(
                f"trial '{trial.signals.recording.name}': the duty is at its limit for {at_limit:.0%} of the time and "
                f"{share:.0%} of the rows are left out; record it with a lighter load or slower"
            )
    return found


def _unused(fit: Fit) -> list[str]:
    dataset = fit.dataset
    used = set(np.unique(dataset.trial_index[dataset.counted]).tolist())
    idle = [f"'{t.signals.recording.name}'" for index, t in enumerate(dataset.trials) if index not in used]
    if not idle:
        return []
    return [
        f"not used, since no row of theirs counts ({dataset.rows}): {', '.join(idle)}; the joint rests, reverses or "
        "crosses its free play all the time: record slower or longer motion in one direction"
    ]


def _same_samples(fit: Fit) -> list[str]:
    """Copies are not independent: a trial that judges its own copy proves nothing."""
    names: dict[bytes, list[str]] = {}
    for trial in fit.dataset.trials:
        names.setdefault(trial.signals.effort.tobytes(), []).append(f"'{trial.signals.recording.name}'")
    return [
        f"trials {', '.join(same)} hold the same samples: held-out errors and intervals look better than they are; "
        "keep one of them"
        for same in names.values()
        if len(same) > 1
    ]
