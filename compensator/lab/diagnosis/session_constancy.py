"""Whether an effect that is named is as large in all of a session: what slips or shifts imitates what was always there.

A clutch that slips under the heaviest load turns the arm against the encoder, and from then on the joint seems to have
another centre of mass. Of all trials that the effect could have changed at, the likeliest is taken, and their number is
part of the price (Quandt 1960; Andrews 1993).
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.effects.effect import SESSION_START
from compensator.lab.model.fit import with_columns
from compensator.lab.model.fitted import Fit
from compensator.lab.model.validation import held_out
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.regimes import BoolArray
from compensator.lab.rows.dataset import IntArray
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates, gather_curves
from compensator.lab.screening.clearing import with_noise
from compensator.lab.screening.evidence import VERY_STRONG, Block, score_of

NAME = "later in the session"
LEAST_PART = 0.1  # of what tells of the effect, before the change and after it
LEAST_CHANGE = 0.1  # of its size: by less, a formula that is nearly right seems to change between loads
MOST_CHANGES = 24  # that are tried


@dataclass(frozen=True, slots=True)
class InSession:
    """An effect that is another one from some trial on: its size before and since, over that in all trials."""

    trial: str
    before: float
    since: float


def change_in_session(explained: Fit, gathered: Candidates, named: Block) -> InSession | None:
    """Where the effect is another one from then on; None where it is the same in all of the session, for all one knows.

    Args:
        explained: the model with the effect, the last of its terms.
        gathered: what the model without it may be missing, against noise that is known.
        named: the effect's block.
    """
    if gathered.noise is None:
        return None
    share, place = _share(explained), _order(explained)
    likeliest, score = _likeliest(gathered.with_block(named), share, place)
    if likeliest is None or score < VERY_STRONG:
        return None
    # beside what the formula leaves open, too
    grown = with_noise(gather_curves(explained, gathered.show_in))
    later = place >= likeliest
    if score_of(grown.bases, _block(grown, share, later), grown.noise) < VERY_STRONG:
        return None
    changed = with_columns(explained, NAME, (share * later)[:, None])
    before, after = (held_out(one, None, explained.determination) for one in (explained, changed))
    if after.rms >= before.rms:
        return None
    own = changed.coefficients[-1 - len(explained.terms[-1].coefficients) : -1]
    fitted = explained.terms[-1].coefficients
    size = float(own @ fitted / (fitted @ fitted))
    change = float(changed.coefficients[-1])
    if abs(change) < LEAST_CHANGE:
        return None
    first = int(explained.dataset.trial_index[np.flatnonzero(place == likeliest)[0]])
    trial = explained.dataset.trials[first].signals.recording.name
    return InSession(trial, size, size + change)


def _share(explained: Fit) -> FloatArray:
    """What the last term adds to the effort, shape (N,)."""
    own = explained.terms[-1].coefficients
    share: FloatArray = explained.columns[:, -len(own) :] @ own
    return share


def _order(explained: Fit) -> IntArray:
    """The place in the session of each row's trial, shape (N,)."""
    trials = explained.dataset.trials
    starts = [trial.motion.condition(SESSION_START, float(index)) for index, trial in enumerate(trials)]
    places: IntArray = np.argsort(np.argsort(starts, kind="stable"))[explained.dataset.trial_index]
    return places


def _likeliest(given: Candidates, share: FloatArray, place: IntArray) -> tuple[int | None, float]:
    """The place from which the effect is another one, and its score; None where no place has enough on both sides."""
    told = np.bincount(place[given.rows], share[given.rows] ** 2)
    if told.sum() == 0.0:
        return None, 0.0
    before = np.cumsum(told) / told.sum()
    tried = np.unique(np.searchsorted(before, np.linspace(LEAST_PART, 1.0 - LEAST_PART, MOST_CHANGES)) + 1)
    scores = {
        int(at): score_of(given.bases, _block(given, share, place >= at, len(tried)), given.noise)
        for at in tried
        if LEAST_PART <= before[at - 1] <= 1.0 - LEAST_PART
    }
    best = max(scores, key=lambda at: scores[at], default=None)
    return best, 0.0 if best is None else scores[best]


def _block(given: Candidates, share: FloatArray, later: BoolArray, tried: int = 1) -> Block:
    return Block(NAME, given.tested((share * later)[:, None]), WITH_CHAIN, tried)
