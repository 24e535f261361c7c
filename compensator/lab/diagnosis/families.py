"""What one family of effects has to say: its best effect, confirmed or not, or a curve that none of them follows."""

from dataclasses import dataclass, replace

import numpy as np

from compensator.lab.diagnosis.bending import still_bending
from compensator.lab.diagnosis.diagnosis import Candidate, Verdict
from compensator.lab.diagnosis.examination import (
    SIGNIFICANT,
    as_in_the_ladder,
    examine,
    is_confirmed,
    is_sure,
)
from compensator.lab.diagnosis.physical import is_past_scan, is_possible, is_too_small, is_within_bounds
from compensator.lab.diagnosis.session_constancy import change_in_session
from compensator.lab.diagnosis.unfollowed import FORMULA_SHARE, unfollowed
from compensator.lab.diagnosis.wording import (
    answer_in_words,
    bending_in_words,
    bursts_in_words,
    changed_in_session_in_words,
    changing_in_words,
    still_bending_in_words,
    still_left_in_words,
    swinging_in_words,
    unexplained_in_words,
    wandering_in_words,
)
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.effects.effect import MotionRows
from compensator.lab.left_over.bursts import Bursts, bursts_of, is_rattle
from compensator.lab.left_over.left_over import LeftOver, left_beside, left_over
from compensator.lab.left_over.remainder import LEAST_SHARE
from compensator.lab.model.fit import fit_effects
from compensator.lab.model.fitted import Fit
from compensator.lab.model.weights import row_weights
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.screening.candidates import Candidates, gather_curves
from compensator.lab.screening.evidence import Evidence, Screening, among_all, screen

EXAMINED = 6  # candidates that are refitted and drawn, of those whose evidence pays for their parameters
FEWEST_SHOWN = 2
TIE = 2.0  # of scores: barely worth a mention (Kass, Raftery 1995)
ALIKE = 0.95  # correlation of what two effects explain
SHARE_NEAR_REVERSALS = 0.9  # the same there, where every effect has a little of what any other explains
LARGE_GAIN = 0.25  # near reversals: five times what is asked for there, since every chain leaves a little


@dataclass(frozen=True)
class Answer:
    """What one family of effects has to say.

    Attributes:
        strength: noncentrality of what decided: the best effect, or the free curve that no effect follows.
        remains: more than noise is left that nothing named here explains.
        explained: the model with the effect that is named, where one of the joint or the chain is.
        named: evidence for that effect.
        Others as in `Diagnosis`.
    """

    verdict: Verdict
    sentence: str
    p_value: float
    candidates: list[Candidate]
    driver: str | None
    notes: list[str]
    strength: float = 0.0
    remains: bool = False
    explained: Fit | None = None
    named: Evidence | None = None


def answer_of(fit: Fit, gathered: Candidates, named: Screening, generic: Screening | None) -> Answer:
    """Judge a family.

    Args:
        fit: the model, fitted to the rows where the family shows.
        gathered: what it may be missing.
        named: evidence for the family's effects.
        generic: evidence for free curves; None where a formula need not be held against one.
    """
    best_of_each = _best_shapes(gathered, named)
    if not best_of_each:
        return Answer("nothing", answer_in_words("nothing", 1.0, [], None), 1.0, [], None, [])
    shown = [item for item in best_of_each if item.score > 0.0][:EXAMINED]
    examined = examine(fit, gathered, shown if len(shown) >= FEWEST_SHOWN else best_of_each[:FEWEST_SHOWN])
    best = next(item for item in best_of_each if item.block.name == examined[0].effect.name)
    found_free = None if generic is None else unfollowed(fit, gathered, generic, examined, best)
    if found_free is not None:
        curve, p_value = found_free
        driver, sentence = curve.block.name, answer_in_words("unknown-effect", p_value, examined, curve.block.name)
        return Answer("unknown-effect", sentence, p_value, examined, driver, [], curve.noncentrality, remains=True)
    p_value = among_all(named.p_value)
    # what explains much less than an effect that cannot be it is the shadow of something else
    share = FORMULA_SHARE if gathered.show_in == "sliding" else SHARE_NEAR_REVERSALS
    enough = best.noncentrality >= share * max(item.noncentrality for item in best_of_each)
    name = best.block.name
    own_p = _own_chance(named, examined[0], gathered.show_in)
    explained = None
    if own_p <= SIGNIFICANT and enough and is_confirmed(examined[0]):
        explained = fit_effects(fit.dataset, [*fit.names, name], fit.training)
        examined = [as_in_the_ladder(examined[0], fit, explained, gathered.show_in), *examined[1:]]
    if explained is not None and (gathered.show_in == "sliding" or _holds(explained, examined[0])):
        sentence, notes = answer_in_words("missing", own_p, examined, None), _left(explained, gathered, best, name)
        remains, strength = bool(notes), best.noncentrality
        return Answer("missing", sentence, own_p, examined, None, notes, strength, remains, explained, best)
    found = _bends(gathered, examined, best_of_each)
    if p_value <= SIGNIFICANT and found is not None:
        bends, too_far = found
        others = [one for one in examined if one is not bends]
        sentence = bending_in_words(bends, too_far, fit.dataset.facts, p_value)
        driver, strength = bends.effect.driver, max(item.noncentrality for item in best_of_each)
        return Answer("unknown-effect", sentence, p_value, [bends, *others], driver, [], strength, remains=True)
    stretches = len(np.unique(fit.dataset.block_index[gathered.rows]))
    sentence, remains = answer_in_words("nothing", p_value, examined, None, stretches), False
    if generic is not None:
        left, bursts = left_over(gathered), _bursts(gathered)
        if bursts is not None and bursts.of_effort > LEAST_SHARE:
            names = [_trial_names(fit)[index] for index in bursts.trials]
            sentence, remains = bursts_in_words(bursts, names, p_value), True
        elif left.is_more_than_noise:
            wanders = _wanders(fit, left)
            nearest, facts = _nearest_driver(generic), fit.dataset.facts
            sentence = unexplained_in_words(left, nearest, p_value, stretches, facts, wanders)
            remains = True
    return Answer("nothing", sentence, p_value, examined, None, [], best.noncentrality, remains)


def _holds(explained: Fit, candidate: Candidate) -> bool:
    """Whether a name near reversals is one in the model that would be had, too, with all shapes found anew."""
    effect = candidate.effect
    return is_confirmed(candidate) and (effect.holds is None or effect.holds(explained.shapes[effect.name]))


def beside(first: Answer, other: Answer, fit: Fit, gathered: Candidates) -> Answer:
    """The answer with what it leaves once the effect of another family is in the model, too.

    What the one leaves may be the other's: a delay leaves what seems to wander.
    """
    if first.named is None or other.named is None or not first.remains:
        return first
    names = (first.named.block.name, other.named.block.name)
    explained = fit_effects(fit.dataset, [*fit.names, *names], fit.training)
    notes = _left(explained, gathered, first.named, " and ".join(names))
    return replace(first, notes=notes, remains=bool(notes))


def _left(explained: Fit, gathered: Candidates, best: Evidence, called: str) -> list[str]:
    """What is left of an effect that is named: beside its formula, or of another that it only imitates."""
    return what_remains(explained, gathered, called) or _imitated(explained, gathered, best)


def _own_chance(named: Screening, best: Candidate, show_in: MotionRows) -> float:
    """The chance of the effect that is to be named, if any of its family is no luck.

    Near reversals few stretches may hold most of the evidence, of which flips of signs can be no surer than of so many
    signs. What takes much of the held-out error in whole trials drawn again, for sure, is no luck of a few stretches.
    """
    p_value = among_all(named.p_value)
    own = _chance_of(named, best) if p_value <= SIGNIFICANT else p_value
    large = show_in == "moving" and best.gain.low >= LARGE_GAIN
    return min(own, among_all(best.gain.chance)) if large else own


def _chance_of(named: Screening, best: Candidate) -> float:
    """The chance that luck alone brings any effect to what this one reaches; twice that where it was looked at twice.

    Bonferroni: of two looks at its gain, either would have done.
    """
    return min(1.0, (1.0 if best.beside_open is None else 2.0) * among_all(named.chance_of(best.effect.name)))


def _bends(
    gathered: Candidates, examined: list[Candidate], best_of_each: list[Evidence]
) -> tuple[Candidate, bool] | None:
    """What explains most, for sure, but cannot be the friction it stands in the place of: a part of it, or too far."""
    most = max(best_of_each, key=lambda item: item.noncentrality)
    candidate = next((one for one in examined if one.effect.name == most.block.name), None)
    if candidate is None or not is_sure(candidate) or not is_within_bounds(gathered, most):
        return None
    too_far = candidate.effect.least_of_friction > 0.0 and is_past_scan(gathered, most)
    return (candidate, too_far) if too_far or is_too_small(gathered, most) else None


def _best_shapes(gathered: Candidates, screening: Screening) -> list[Evidence]:
    """The best shape of every effect, best effect first; of those that tie, the one that the catalogue has first."""
    of_each: dict[str, list[Evidence]] = {}
    for evidence in screening.evidence:
        of_each.setdefault(evidence.block.name, []).append(evidence)
    found = [_best_shape(gathered, shapes) for shapes in of_each.values()]
    ranked = sorted(found, key=lambda item: -item.score)
    order = list(catalogue())
    tied = [item for item in ranked if _ties(item, ranked[0])]
    plainest = min(tied, key=lambda item: order.index(item.block.name), default=None)
    return ranked if plainest is None else [plainest, *(item for item in ranked if item is not plainest)]


def _best_shape(gathered: Candidates, shapes: list[Evidence]) -> Evidence:
    """The best one; near reversals, of those whose size can be: what swings too little, or too much, makes up by it."""
    if gathered.show_in != "moving":
        return shapes[0]
    return next((item for item in shapes if item.score > 0.0 and is_possible(gathered, item)), shapes[0])


def _ties(item: Evidence, best: Evidence) -> bool:
    """Whether two effects explain the same, and about as well: then the rows cannot choose between them."""
    alike = abs(float(item.direction @ best.direction)) >= ALIKE
    return alike and item.score >= best.score - TIE


def _bursts(gathered: Candidates) -> Bursts | None:
    """Stretches that leave far more than others of like motion; None without any, or where teeth bounce there."""
    dataset, rows, residual = gathered.fit.dataset, gathered.rows, gathered.fit.residual
    weights = row_weights(dataset, residual, rows) * dataset.steadiness[rows]
    found = bursts_of(dataset, residual[rows], weights, rows)
    return found if found.are_there and not is_rattle(found, dataset, residual[rows], rows) else None


def _wanders(fit: Fit, left: LeftOver) -> str:
    """What is another one for seconds, in words; empty where nothing is."""
    if left.wandering is None:
        return ""
    return wandering_in_words(left.wandering, _trial_names(fit), fit.dataset.effort_definition.unit)


def _trial_names(fit: Fit) -> list[str]:
    return [trial.signals.recording.name for trial in fit.dataset.trials]


def _nearest_driver(generic: Screening) -> str | None:
    """The variable whose free curve the evidence pays for, though it may not hold on other rows; None without one."""
    best = generic.evidence[0] if generic.evidence else None
    return best.block.name if best is not None and best.score > 0.0 else None


def _imitated(explained: Fit, gathered: Candidates, best: Evidence) -> list[str]:
    """What an effect that is named only imitates, as far as it is more than what its formula leaves open."""
    name = best.block.name
    if still_bending(explained, gathered, best):
        return [still_bending_in_words(name)]
    change = change_in_session(explained, gathered, best.block)
    if change is not None:
        return [changed_in_session_in_words(name, change)]
    left = left_beside(explained, gathered, best)
    return [] if left is None else [still_left_in_words(name, left, explained.dataset.facts)]


def what_remains(fit: Fit, gathered: Candidates, name: str) -> list[str]:
    """What remains with the effect in the model, beside what its formula leaves open, as the next step sees it."""
    grown = gather_curves(fit, gathered.show_in)
    left = left_over(grown)
    if not left.is_more_than_noise:
        return []
    rest = screen(grown.bases, grown.curves.blocks, grown.fit.dataset.block_index[grown.rows])
    if rest.evidence and rest.p_value <= SIGNIFICANT and rest.evidence[0].score > 0.0:
        driver = DRIVERS[rest.evidence[0].block.name.removesuffix(" against motion")]
        how = " against the motion" if rest.evidence[0].block.name.endswith("against motion") else ""
        return [f"After {name}, structure over {driver.title}{how} remains; add it and diagnose again."]
    if left.change is not None:
        return [f"After {name}, {changing_in_words(left.change)}; repeat a trial to see whether it comes again."]
    if left.swing is not None:
        return [f"After {name}, what is left {swinging_in_words(left.swing)}."]
    if wanders := _wanders(fit, left):
        return [f"After {name}, {wanders}; repeat a trial to see whether it comes again."]
    return [
        f"After {name}, what is left is still more than noise, {left.remainder.share:.1%} of the effort, and "
        "has structure over no variable that is measured; add it and diagnose again."
    ]
