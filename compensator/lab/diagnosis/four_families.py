"""What all four families say of a model, and which of them has the answer."""

from dataclasses import dataclass

from compensator.lab import progress
from compensator.lab.at_rest.breakaway_rows import breakaway_rows
from compensator.lab.at_rest.few_rows import few_reversals
from compensator.lab.diagnosis.answer import Answer
from compensator.lab.diagnosis.breakaway_family import breakaway_answer
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.examination import explains
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
from compensator.lab.screening.base import Block
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Screening, kept_evidence
from compensator.lab.screening.gathering import gather, with_noise

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
        """Those that could be judged, in order; last a name for the little near reversals that anything leaves."""
        found = [one for one in (self.steady, self.memory, self.rest, self.chain) if one is not None]
        return sorted(found, key=lambda one: (one is self.memory) * one.is_slight)

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

        Before another name, which predicts other trials worse, near reversals too unless both are judged in steady
        sliding: where that is its shadow, or, of the joint itself, has less evidence.
        """
        rows: MotionRows = "sliding" if one is self.chain and first is self.steady else "moving"
        if first.verdict == "missing":
            if first.explained is None or not _predicts_better(named, first.explained, rows):
                return False
            more = one is not self.chain and _evidence(one) > _evidence(first)
            return first is not self.rest and (more or _is_shadow(first, one.candidates[0], named))
        curve = with_curve(self.gathered.fit, first.driver)
        return curve is None or not _predicts_better(curve, named, rows)


def _evidence(answer: Answer) -> float:
    """Noncentrality of what is named; 0 of what starts from rest alone name."""
    evidence = answer.candidates[0].evidence
    return 0.0 if evidence is None else evidence.noncentrality


def _is_shadow(first: Answer, other: Candidate, named: Fit) -> bool:
    """Whether a name loses its evidence once another effect is in the model, as fitted there; none of starts does."""
    evidence, gathered = first.candidates[0].evidence, first.gathered
    if evidence is None or gathered is None:
        return False
    shape = named.shapes.get(other.effect.name, ())
    columns = gathered.fit.dataset.unchecked_columns(other.effect, [shape])[0]
    beside = gathered.with_block(Block(other.effect.name, gathered.tested(columns), 0, 1, shape))
    return explains(kept_evidence(beside.bases, [evidence.block]), evidence)


def judged(fit: Fit) -> FourFamilies:
    """All families of a model, on its training rows.

    Raises:
        UnusableDataError: no candidate can be judged on these trials.
    """
    progress.enter(COLUMNS)
    gathered = with_noise(with_found_order(gather(fit)))
    physical = [block for block in gathered.named if not effect_named(block.name).pipeline]
    pipeline = [block for block in gathered.named if effect_named(block.name).pipeline]
    if not physical:
        raise UnusableDataError(
            "no effect of the catalogue can be judged on these trials; record " + "; ".join(gathered.left_out.values())
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
    rest, not_at_rest = breakaway_answer(fit, breakaway_rows(fit), _least_p(sliding))
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
