"""What one family of effects has to say: its best effect, confirmed or not, or a curve that none of them follows."""

from dataclasses import dataclass, replace

from compensator.lab.chance import SIGNIFICANT
from compensator.lab.diagnosis.answer import EXAMINED, Answer
from compensator.lab.diagnosis.confirmation import LUCK_AMONG_ALL, is_confirmed, is_sure
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.examination import FORMULA_SHARE, as_in_the_ladder, best_shapes, examine, explains
from compensator.lab.diagnosis.physical import (
    is_before_scan,
    is_past_scan,
    is_too_small,
    is_within_bounds,
    why_impossible,
    why_not_physical,
)
from compensator.lab.diagnosis.remaining import large_bursts, what_remains, without_a_name
from compensator.lab.diagnosis.unfollowed import unfollowed
from compensator.lab.diagnosis.wording import (
    bending_in_words,
    missing_in_words,
    nothing_in_words,
    partly_in_words,
    unknown_in_words,
)
from compensator.lab.model.fit import fit_effects
from compensator.lab.model.fitted import Fit
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence, Screening, among_all, kept_evidence

FEWEST_SHOWN = 2
NEARLY_ALL = 0.9  # of the evidence of what explains most


def answer_of(fit: Fit, gathered: Candidates, named: Screening, generic: Screening | None) -> Answer:
    """Judge a family.

    Args:
        fit: the model, fitted to the rows where the family shows.
        gathered: what it may be missing.
        named: evidence for the family's effects.
        generic: evidence for free curves; None where a formula need not be held against one.
    """
    shapes = best_shapes(named.evidence, lambda item: not why_not_physical(gathered, item))
    if not shapes:
        return Answer("nothing", nothing_in_words(1.0), 1.0, [], None, [])
    shown = [item for item in shapes if item.score > 0.0][:EXAMINED]
    examined = examine(fit, gathered, shown if len(shown) >= FEWEST_SHOWN else shapes[:FEWEST_SHOWN])
    family = _Family(fit, gathered, named, shapes, examined)
    return family.curve(generic) or family.name() or family.unlike_any() or family.nothing(generic)


@dataclass(frozen=True)
class _Family:
    """Effects of one family, ranked, and what can be said of them.

    Attributes:
        fit, gathered, named: as in `answer_of`.
        shapes: the best one of every effect, best effect first.
        examined: the first effects with their held-out errors; confirmed ones first.
    """

    fit: Fit
    gathered: Candidates
    named: Screening
    shapes: list[Evidence]
    examined: list[Candidate]

    def evidence_of(self, candidate: Candidate) -> Evidence:
        """Of one that is examined."""
        return next(item for item in self.shapes if item.block.name == candidate.effect.name)

    @property
    def most(self) -> Evidence:
        """What explains most, whether it can be or not."""
        return max(self.shapes, key=lambda item: item.noncentrality)

    def curve(self, generic: Screening | None) -> Answer | None:
        """A free curve that no formula follows; None where there is none, or none is asked for."""
        if generic is None:
            return None
        first = self.examined[0]
        curve = unfollowed(self.fit, self.gathered, generic, self.examined, self.evidence_of(first))
        if curve is None:
            return None
        driver, p_value = curve.block.name, among_all(generic.p_value)
        for index, one in enumerate(self.examined):
            self.examined[index] = replace(one, refused=f"explains much less than a curve over {driver}")
        sentence = unknown_in_words(first, driver, p_value)
        return Answer("unknown-effect", sentence, p_value, self.examined, driver, [], remains=True)

    def name(self) -> Answer | None:
        """The effect that is missing; None where none is confirmed.

        It is the first that holds in the model that would be had: what turns out there to be more, or less, than it can
        be leaves its place to the next.
        """
        for index, one in enumerate(self.examined):
            found = self._named(one)
            if isinstance(found, Answer):
                return found
            self.examined[index] = replace(one, refused=found)
        return None

    def _named(self, candidate: Candidate) -> Answer | str:
        """The answer that a candidate is; else what speaks against it beside its own numbers."""
        fit, show_in, best = self.fit, self.gathered.show_in, self.evidence_of(candidate)
        own_chance = self._chance_of(candidate)
        if not is_confirmed(candidate):
            return ""
        if own_chance > SIGNIFICANT:
            return LUCK_AMONG_ALL
        if self._is_shadow(best):
            return f"explains little beside {self.most.block.name}, which cannot be it"
        explained = fit_effects(fit, [*fit.names, candidate.effect.name])
        first = as_in_the_ladder(candidate, fit, explained, show_in)
        if not is_confirmed(first):
            return "not so in the model with all shapes found anew"
        if first.gain.low <= 0.0 and large_bursts(self.gathered) is not None:
            # strong evidence alone holds beside noise that is alike everywhere
            return "gain not sure, and what is left comes in bursts"
        if impossible := why_impossible(explained, candidate.effect.name):
            return impossible
        examined = [first, *(one for one in self.examined if one is not candidate)]
        notes = what_remains(explained, show_in, candidate.effect.name)
        sentence = missing_in_words(first, own_chance) + (partly_in_words(first) if notes else "")
        remains, evidence = bool(notes), best.noncentrality
        return Answer("missing", sentence, own_chance, examined, None, notes, remains, explained, evidence)

    def _is_shadow(self, one: Evidence) -> bool:
        """Whether what explains more, though it cannot be the effect, explains what this one does.

        Near reversals every effect has a little of what any other explains: with less than nearly all of the evidence
        it has to keep half of its own beside the other.
        """
        share = one.noncentrality / self.most.noncentrality if self.most.noncentrality > 0.0 else 1.0
        if share >= (FORMULA_SHARE if self.gathered.show_in == "sliding" else NEARLY_ALL):
            return False
        beside = self.gathered.with_block(self.most.block).bases
        return share < FORMULA_SHARE or explains(kept_evidence(beside, [one.block], self.gathered.noise), one)

    def _chance_of(self, candidate: Candidate) -> float:
        """The chance that luck alone brings anything as far as this effect."""
        return among_all(self.named.chance_of(candidate.effect.name))

    def unlike_any(self) -> Answer | None:
        """What acts near reversals and explains most, for sure, but cannot be the effect it looks like; None without.

        Its size is beyond what that can be; or it bends along with the joint: it is but a part of the friction in whose
        place it stands, or goes too far.
        """
        most, gathered = self.most, self.gathered
        one = next((one for one in self.examined if one.effect.name == most.block.name), None)
        if one is None or one.effect.rows == "sliding" or not is_sure(one):
            return None
        p_value = self._chance_of(one)
        if p_value > SIGNIFICANT:
            return None
        ranked = [one, *(other for other in self.examined if other is not one)]
        if is_within_bounds(gathered, most):
            too_far = one.effect.least_of_friction > 0.0 and is_past_scan(gathered, most)
            if not too_far and not self._is_part(most):
                return None
            sentence = bending_in_words(one, too_far, self.fit.dataset.facts, p_value)
        else:
            sentence = unknown_in_words(one, one.effect.driver, p_value)
        return Answer("unknown-effect", sentence, p_value, ranked, one.effect.driver, [], remains=True)

    def _is_part(self, most: Evidence) -> bool:
        """Whether what explains most is but a part of the friction: of any shape that may be it.

        A shorter distance of more friction may explain nearly as much, and then nobody knows how large a part it is.
        """
        alike = (one for one in self.named.evidence if one.block.name == most.block.name)
        likely = [one for one in alike if one.noncentrality >= FORMULA_SHARE * most.noncentrality]
        return all(is_too_small(self.gathered, one) and not is_before_scan(self.gathered, one) for one in likely)

    def nothing(self, generic: Screening | None) -> Answer:
        """That no effect is confirmed, and what is left all the same, where free curves are asked for."""
        p_value = self.named.p_value
        left = None if generic is None else without_a_name(self.gathered, generic)
        sentence = left or nothing_in_words(p_value, self.gathered.stretches)
        return Answer("nothing", sentence, p_value, self.examined, None, [], remains=left is not None)
