"""What one family of effects has to say: its best effect, confirmed or not, or a curve that none of them follows."""

from dataclasses import dataclass, replace

from compensator.lab.diagnosis.answer import EXAMINED, Answer
from compensator.lab.diagnosis.confirmation import helps_unproved, is_confirmed
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.examination import EXPLAINED_BY_RIVAL, FORMULA_SHARE, best_shapes, examine
from compensator.lab.diagnosis.remaining import what_remains, without_a_name
from compensator.lab.diagnosis.unfollowed import unfollowed
from compensator.lab.diagnosis.wording import (
    driver_in_words,
    helps_in_words,
    missing_in_words,
    nothing_in_words,
    partly_in_words,
    unknown_in_words,
)
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import predicts_better
from compensator.lab.model.validation import held_out
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import Evidence, Screening, among_all, kept_evidence
from compensator.lab.screening.extrapolation import kept_without_noise

FEWEST_SHOWN = 2


def answer_of(fit: Fit, gathered: Candidates, named: Screening, generic: Screening | None) -> Answer:
    """Judge a family.

    Args:
        fit: the model, fitted to the rows where the family shows.
        gathered: what it may be missing.
        named: evidence for the family's effects.
        generic: evidence for free curves; None where a formula need not be held against one.
    """
    shapes = best_shapes(named.evidence)
    if not shapes:
        return Answer("nothing", nothing_in_words(1.0), 1.0, [], None, [])
    shown = [item for item in shapes if item.score > 0.0][:EXAMINED]
    examined = examine(fit, gathered, named, shown if len(shown) >= FEWEST_SHOWN else shapes[:FEWEST_SHOWN])
    family = _Family(gathered, named, shapes, examined)
    return family.curve(generic) or family.name() or family.nothing(generic)


@dataclass(frozen=True)
class _Family:
    """Effects of one family, ranked, and what can be said of them.

    Attributes:
        gathered, named: as in `answer_of`.
        shapes: the best one of every effect, best effect first.
        examined: the first effects with their held-out errors; confirmed ones first.
    """

    gathered: Candidates
    named: Screening
    shapes: list[Evidence]
    examined: list[Candidate]

    def curve(self, generic: Screening | None) -> Answer | None:
        """A free curve that no formula follows; None where there is none, or none is asked for."""
        if generic is None:
            return None
        first = self.examined[0]
        curve = unfollowed(self.gathered, generic, self.examined)
        if curve is None:
            return None
        driver, p_value = curve.block.name, among_all(generic.p_value)
        for index, one in enumerate(self.examined):
            self.examined[index] = replace(one, refused=f"does not follow the curve over {driver_in_words(driver)}")
        sentence = unknown_in_words(first, driver, p_value)
        return Answer("unknown-effect", sentence, p_value, self.examined, driver, [], remains=True)

    def name(self) -> Answer | None:
        """The effect that is missing: the first that holds; None where none does."""
        for index, one in enumerate(self.examined):
            found = self._named(one)
            if isinstance(found, Answer):
                return found
            self.examined[index] = replace(one, refused=found)
        return None

    def _named(self, candidate: Candidate) -> Answer | str:
        """The answer that a candidate is; else what speaks against it beside its own numbers."""
        if not is_confirmed(candidate):
            return ""
        assert candidate.explained is not None
        if why := self._shadow_of(candidate) or self._by_noise(candidate):
            return why
        others = [one for one in self.examined if one is not candidate]
        notes = what_remains(candidate.explained, self.gathered, candidate.effect.name)
        sentence, p_value = missing_in_words(candidate), candidate.p_value
        sentence += partly_in_words(candidate) if notes else ""
        return Answer("missing", sentence, p_value, [candidate, *others], None, notes, bool(notes))

    def _shadow_of(self, candidate: Candidate) -> str:
        """Beside which effect it explains little near reversals, though that cannot be it; empty where there is none.

        Every joint leaves something there that many effects follow. In steady sliding the held-out error is enough; and
        here, too, what predicts other trials better than that effect is not its shadow.
        """
        assert candidate.evidence is not None
        assert candidate.explained is not None
        if self.gathered.show_in == "sliding":
            return ""
        others = {one.block.name: self._beside_chain(one) for one in self.shapes}
        others.pop(candidate.effect.name, None)
        most = max(others, key=lambda name: others[name], default="")
        if not most or candidate.evidence.noncentrality >= FORMULA_SHARE * others[most]:
            return ""
        larger = next((one.explained for one in self.examined if one.effect.name == most), None)
        rows = self.gathered.show_in
        if larger is not None and predicts_better(*(held_out(one, rows) for one in (candidate.explained, larger))):
            return ""
        return f"explains little beside {most}, which cannot be it"

    def _by_noise(self, candidate: Candidate) -> str:
        """That noise of the position makes most of what smooths an effort; empty where it does not."""
        assert candidate.evidence is not None
        if candidate.effect.driver != "effort_rate":
            return ""
        kept = kept_without_noise(self.gathered, candidate.evidence)
        if kept >= EXPLAINED_BY_RIVAL:
            return ""
        return f"is what noise of the position makes: without it {kept:.0%} of the evidence is left"

    def _beside_chain(self, item: Evidence) -> float:
        """Noncentrality of an effect beside all that the measuring chain, and every contact, makes."""
        block = replace(item.block, base=WITH_CHAIN)
        return kept_evidence(self.gathered.bases, [block])[block.name]

    def nothing(self, generic: Screening | None) -> Answer:
        """That no effect is confirmed, and what is left all the same, where free curves are asked for."""
        p_value = self.named.p_value
        left = None if generic is None else without_a_name(self.gathered, generic)
        sentence = left or nothing_in_words(p_value, self.gathered.stretches)
        notes = [helps_in_words(one) for one in self.examined if generic is not None and helps_unproved(one)]
        return Answer("nothing", sentence, p_value, self.examined, None, notes, remains=left is not None)
