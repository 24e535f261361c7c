"""Whether the trials that a study was extended by brought less than there seemed to be before."""

from collections.abc import Callable

from bench.study.errors import StudyError, lab_errors
from bench.study.suggestion.earlier_trials import CLOSER
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.model.fitted import Fit
from compensator.lab.next_trial.confounded import rivals_of
from compensator.lab.next_trial.suggest import d_prime_of

Judged = tuple[Fit, Diagnosis]


def fallen(before: Callable[[], Judged], now: Judged) -> str:
    """That the leading rival stands out less than on the trials before, and what to do; empty where it does not.

    Args:
        before: gives the model as it was on the trials before, and what it was found to lack.
        now: the same model on all trials.
    """
    rivals = rivals_of(now[1])
    if not rivals:
        return ""
    leading = rivals[0].effect
    try:
        with lab_errors():
            was, stands = (d_prime_of(*one, leading.name) for one in (before(), now))
    except StudyError:  # what was too little to be judged has nothing to be held against
        return ""
    if round(stands, 1) >= round(was, 1):
        return ""
    fell = f"the smallest d' of {leading.title} fell from {was:.1f} to {stands:.1f}"
    return f"With the trials that were added, {fell}. {CLOSER}"
