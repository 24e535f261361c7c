"""A free curve, or a free hysteresis, that no formula of the catalogue follows.

A formula is held against a curve that has more freedom. One that builds on what the rest of the model says, as friction
of the load does, is the worse for everything that is still missing there: without the spring that the teeth carry, too,
the load is another one, and a curve over it makes up for that while the formula cannot. So what the formula itself
would leave open counts for it: where it leaves the curve nothing, it is followed.
"""

from compensator.lab.diagnosis.bending import bending
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.examination import FORMULA_SHARE, SIGNIFICANT, is_confirmed
from compensator.lab.model.fit import fit_effects, with_columns
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import held_out_gain
from compensator.lab.model.validation import held_out
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.discrepancy import open_columns
from compensator.lab.screening.evidence import Evidence, Screening, among_all, score_of, screen_against_noise


def unfollowed(
    fit: Fit, gathered: Candidates, generic: Screening, examined: list[Candidate], best: Evidence
) -> tuple[Evidence, float] | None:
    """The free curve, or the free hysteresis, that no formula follows, and its chance; None where all are followed.

    Args:
        fit: the model.
        gathered: what it may be missing.
        generic: evidence for free curves.
        examined: candidates, best first.
        best: the evidence for the first of them.
    """
    found = []
    spline, bent = _curve(fit, gathered, generic), bending(fit, gathered)
    if spline is not None and not (
        _follows(best, examined[0], spline) or _leaves_nothing(gathered, examined[0], best, spline)
    ):
        found.append((spline, among_all(generic.p_value)))
    if bent is not None and (not _follows(best, examined[0], bent.evidence) or bent.predicts_best(fit, examined)):
        found.append((bent.evidence, among_all(bent.evidence.p_value)))
    return max(found, key=lambda one: one[0].noncentrality, default=None)


def _follows(best: Evidence, examined: Candidate, curve: Evidence) -> bool:
    """Whether a formula that can be it explains about as much as a free curve, which has more freedom."""
    return examined.physical and best.noncentrality >= FORMULA_SHARE * curve.noncentrality


def _leaves_nothing(gathered: Candidates, candidate: Candidate, best: Evidence, curve: Evidence) -> bool:
    """Whether a confirmed formula that builds on the rest leaves a curve nothing beside what that leaves open."""
    if candidate.effect.builds_on is None or not is_confirmed(candidate):
        return False
    fit = gathered.fit
    grown = fit_effects(fit.dataset, [*fit.names, candidate.effect.name], fit.training)
    given, left_open = gathered.with_block(best.block), open_columns(grown)
    if left_open.shape[1]:
        given = given.with_columns(left_open)
    return score_of(given.bases, curve.block, given.noise) <= 0.0


def _curve(fit: Fit, gathered: Candidates, generic: Screening) -> Evidence | None:
    """The free curve with the best evidence, if the evidence is no luck and the curve lowers the held-out error.

    Its flips are of few stretches, and their own scatter is known no better: the noise of all rows must say the same.
    """
    if among_all(generic.p_value) > SIGNIFICANT or not generic.evidence:
        return None
    best = generic.evidence[0]
    if best.score <= 0.0 or best.p_value > SIGNIFICANT or _noise_draws_curves(gathered):
        return None
    with_curve = with_columns(fit, best.block.name, gathered.curves.splines[best.block.name].columns)
    known = fit.determination
    return best if held_out_gain(held_out(fit, None, known), held_out(with_curve, None, known)).low > 0.0 else None


def _noise_draws_curves(gathered: Candidates) -> bool:
    """Whether noise alone, where it is known, would bring free curves as sure as these."""
    if gathered.noise is None:
        return False
    against = screen_against_noise(gathered.bases, gathered.curves.blocks, gathered.noise)
    return among_all(against.p_value) > SIGNIFICANT
