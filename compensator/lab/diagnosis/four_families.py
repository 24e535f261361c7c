"""What all four families say of a model, and which of them has the answer."""

from dataclasses import dataclass

from compensator.lab import progress
from compensator.lab.at_rest.breakaway_rows import enough_starts
from compensator.lab.diagnosis.answer import Answer
from compensator.lab.diagnosis.breakaway_family import breakaway_answer
from compensator.lab.diagnosis.families import answer_of
from compensator.lab.diagnosis.unfollowed import with_curve
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import MotionRows
from compensator.lab.errors import UnusableDataError
from compensator.lab.left_over.orders import with_found_order
from compensator.lab.model.fit import widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import predicts_better
from compensator.lab.model.validation import held_out
from compensator.lab.rows.dataset import FEWEST_ROWS
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Screening
from compensator.lab.screening.gathering import few_reversals, gather, with_noise

# stages of a diagnosis, as whoever waits for it is told of them
CHECKS = "Checking the data"
COLUMNS = "Computing what every effect would add"
SCREENING = "Screening the effects of steady sliding"
STEADY = "Refitting with the likeliest of them"
CHAIN = "Judging the measuring chain"
MEMORY = "Judging what acts near reversals"
REST = "Judging starts from rest"
LEFT = "Looking at what is left"
STAGES = (CHECKS, COLUMNS, SCREENING, STEADY, CHAIN, MEMORY, REST, LEFT)


@dataclass(frozen=True)
class FourFamilies:
    """What each family says of a model.

    Attributes:
        steady: effects of the joint in steady sliding.
        memory: effects with memory, near reversals; None where there are none.
        rest: effects at starts from rest; None where there are too few.
        chain: effects of the measuring chain.
        gathered: what the model may be missing in steady sliding.
        left_out: effect name -> why it cannot be judged on these trials.
    """

    steady: Answer
    memory: Answer | None
    rest: Answer | None
    chain: Answer
    gathered: Candidates
    left_out: dict[str, str]

    @property
    def in_order(self) -> list[Answer]:
        """Those that could be judged, in order."""
        return [one for one in (self.steady, self.memory, self.rest, self.chain) if one is not None]

    def first(self) -> Answer:
        """The answer: that of the first family with one, but for a name of a later family that goes before it."""
        answers = [one for one in self.in_order if one.verdict != "nothing"] or [self.steady]
        first = answers[0]
        for one in answers[1:]:
            if one.explained is not None and self._goes_before(one, one.explained, first):
                first = one
        return first

    def _goes_before(self, one: Answer, named: Fit, first: Answer) -> bool:
        """Whether a name goes before another answer: before a curve, unless that predicts other trials better for sure.

        Before another name, which predicts other trials worse for sure, near reversals too unless both are judged in
        steady sliding; a start from rest is no motion to be predicted.
        """
        rows: MotionRows = "sliding" if one is self.chain and first is self.steady else "moving"
        if first.explained is not None:
            return first is not self.rest and _predicts_better(named, first.explained, rows)
        curve = with_curve(self.gathered.fit, first.driver)
        return curve is None or not _predicts_better(curve, named, rows)


def judged(fit: Fit) -> FourFamilies:
    """All families of a model, on its training rows.

    Raises:
        UnusableDataError: no candidate can be judged on these trials.
    """
    progress.enter(COLUMNS)
    sliding_rows = int((fit.training & fit.dataset.in_regimes("sliding")).sum())
    if sliding_rows < FEWEST_ROWS:
        raise UnusableDataError(
            f"{sliding_rows} of {int(fit.training.sum())} rows that a model is fitted to are of steady sliding, and a "
            f"diagnosis needs {FEWEST_ROWS}: record longer strokes at a steady speed"
        )
    gathered = with_noise(with_found_order(gather(fit)))
    physical = [block for block in gathered.named if not effect_named(block.name).pipeline]
    pipeline = [block for block in gathered.named if effect_named(block.name).pipeline]
    if not physical:
        raise UnusableDataError(
            "no effect of the catalogue can be judged on these trials: " + "; ".join(gathered.left_out.values())
        )
    progress.enter(SCREENING)
    generic = gathered.screened(gathered.curves.blocks)
    sliding = gathered.screened(physical)
    progress.enter(STEADY)
    steady = answer_of(fit, gathered, sliding, generic)
    progress.enter(CHAIN)
    chain = answer_of(fit, gathered, gathered.screened(pipeline), None)
    progress.enter(MEMORY)
    memory, not_judged = _memory_of(fit)
    progress.enter(REST)
    starts = enough_starts(fit)
    rest, not_at_rest = (None, {}) if starts is None else breakaway_answer(fit, starts, _least_p(sliding))
    left_out = {**gathered.left_out, **not_judged, **not_at_rest}
    return FourFamilies(steady, memory, rest, chain, gathered, left_out)


def _memory_of(fit: Fit) -> tuple[Answer | None, dict[str, str]]:
    """The family of effects with memory, on all rows in motion; None, and why, where these hold no reversals."""
    dataset = fit.dataset
    too_few = few_reversals(fit)
    if too_few is not None:
        return None, too_few
    wide = widened(fit, "moving" if dataset.rows == "sliding" else dataset.rows)
    gathered = with_noise(gather(wide, "moving"))
    return answer_of(wide, gathered, gathered.screened(gathered.named), None), gathered.left_out


def _predicts_better(one: Fit, other: Fit, rows: MotionRows) -> bool:
    """Whether a model predicts rows of other trials better than another, for sure."""
    return predicts_better(*(held_out(widened(fit, rows), rows) for fit in (one, other)))


def _least_p(screening: Screening) -> dict[str, float]:
    """The least p-value of each effect's shapes, times how many there are."""
    found: dict[str, float] = {}
    for item in screening.evidence:
        p_value = min(1.0, item.block.scanned * item.p_value)
        found[item.block.name] = min(found.get(item.block.name, 1.0), p_value)
    return found
