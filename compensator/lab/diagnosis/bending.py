"""Whether something bends along with the joint and slides: a hose, a cable, a seal, whatever formula imitates a part.

Held against the noise of all rows, as formulas are: a few stretches hold most of what a hysteresis of some tenths of a
radian shows, so that flips of their signs cannot be sure of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.chance import SIGNIFICANT
from compensator.lab.diagnosis.confirmation import LEAST_GAIN
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.model.fit import with_columns, with_effect
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import held_out_gain, predicts_better
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.validation import held_out
from compensator.lab.model.weights import determination
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import VERY_STRONG, Evidence, among_all, screen_against_noise


@dataclass(frozen=True)
class Bending:
    """A free hysteresis that is missing for sure: its evidence, and the held-out error with it, and its gain."""

    evidence: Evidence
    after: HeldOut
    gain: float

    def predicts_best(self, fit: Fit, candidates: Sequence[Candidate]) -> bool:
        """Whether it has a lower held-out error, for sure, than the model with any of the effects that can be it."""
        known = determination(fit)
        others = [
            held_out(with_effect(fit, one.effect.name, one.shape), None, known) for one in candidates if one.physical
        ]
        return all(predicts_better(self.after, other) for other in others)


def bending(fit: Fit, gathered: Candidates) -> Bending | None:
    """The free hysteresis, if its evidence is no luck and it lowers the held-out error for sure.

    The error need only fall where the evidence is very strong: few trials may turn back where it shows.

    Args:
        fit: of the model.
        gathered: what it may be missing in steady sliding, against noise that is known.
    """
    if gathered.noise is None or not _turns_back(gathered):
        return None
    found = screen_against_noise(gathered.bases, [gathered.curves.hysteresis], gathered.noise).evidence
    if not found or found[0].score <= 0.0 or among_all(found[0].p_value) > SIGNIFICANT:
        return None
    bent = with_columns(fit, found[0].block.name, gathered.curves.hysteresis_columns)
    before, after = (held_out(model, None, determination(fit)) for model in (fit, bent))
    gain = held_out_gain(before, after)
    sure = gain.low > 0.0 or found[0].score >= VERY_STRONG
    return Bending(found[0], after, gain.value) if sure and gain.value >= LEAST_GAIN else None


def _turns_back(gathered: Candidates) -> bool:
    """Whether any trial moves both ways: nothing bends back and forth along with a shaft that turns on."""
    dataset = gathered.fit.dataset
    ways = np.sign(dataset.rows_of([trial.motion.velocity for trial in dataset.trials]))
    trials = [set(dataset.trial_index[gathered.rows & (ways == way)].tolist()) for way in (1.0, -1.0)]
    return bool(trials[0] & trials[1])
