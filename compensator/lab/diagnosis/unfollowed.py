"""A free curve, or a free hysteresis, that no formula of the catalogue follows.

A formula is held against a curve that has more freedom. One that builds on what the rest of the model says, as friction
of the load does, is the worse for everything that is still missing there: without the spring that the teeth carry, too,
the load is another one, and a curve over it makes up for that while the formula cannot. So what the formula itself
would leave open counts for it: where it leaves the curve nothing, it is followed.
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.chance import SIGNIFICANT
from compensator.lab.diagnosis.confirmation import LEAST_GAIN, is_confirmed
from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis, Picture
from compensator.lab.diagnosis.examination import FORMULA_SHARE
from compensator.lab.effects.effect import Effect
from compensator.lab.effects.free_curve import FORCE, name_of, way_of
from compensator.lab.errors import NotApplicableError, UnusableDataError
from compensator.lab.model.fit import fit_effects, widened, with_columns
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain, held_out_gain, predicts_better
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.validation import held_out
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.rows.picture import binned_mean
from compensator.lab.screening.base import HYSTERESIS_DRIVER
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.discrepancy import open_columns
from compensator.lab.screening.evidence import Evidence, Screening, among_all, score_of


def unfollowed(
    fit: Fit, gathered: Candidates, generic: Screening, examined: list[Candidate], best: Evidence
) -> Evidence | None:
    """The free curve, or hysteresis, that no formula follows; None where all are followed.

    Args:
        fit: the model.
        gathered: what it may be missing.
        generic: evidence for free curves.
        examined: candidates, best first.
        best: the evidence for the first of them.
    """
    found = _curve(fit, gathered, generic)
    if found is None:
        return None
    curve, errors = found
    followed = examined[0].physical and best.noncentrality >= FORMULA_SHARE * curve.noncentrality
    # a curve over a variable adds up all that is missing there; what bends along is one thing, whatever imitates it
    bends = curve.block.name == HYSTERESIS_DRIVER and _predicts_best(errors, examined)
    if (followed and not bends) or _leaves_nothing(gathered, examined[0], best, curve):
        return None
    return curve


def _predicts_best(errors: HeldOut, examined: list[Candidate]) -> bool:
    """Whether a curve predicts other trials better, for sure, than the model with any of the effects that can be it."""
    return all(predicts_better(errors, one.errors) for one in examined if one.physical and one.errors is not None)


def _leaves_nothing(gathered: Candidates, candidate: Candidate, best: Evidence, curve: Evidence) -> bool:
    """Whether a confirmed formula that builds on the rest leaves a curve nothing beside what that leaves open."""
    if candidate.effect.builds_on is None or not is_confirmed(candidate):
        return False
    fit = gathered.fit
    grown = fit_effects(fit, [*fit.names, candidate.effect.name])
    bases, left_open = gathered.with_block(best.block).bases, open_columns(grown)
    if left_open.shape[1]:
        tested = gathered.tested(left_open)
        bases = [base.extended(tested) for base in bases]
    return score_of(bases, curve.block, gathered.noise) <= 0.0


def _curve(fit: Fit, gathered: Candidates, generic: Screening) -> tuple[Evidence, HeldOut] | None:
    """The free curve with the best evidence, and its held-out errors, if it is no luck, and helps for sure.

    A curve has more coefficients than a formula: every chain bends a little of what it measures.
    """
    if among_all(generic.p_value) > SIGNIFICANT:
        return None
    best = generic.evidence[0]
    if best.score <= 0.0 or best.p_value > SIGNIFICANT:
        return None
    grown = with_columns(fit, best.block.name, gathered.curves.columns[best.block.name])
    before, after = (held_out(model) for model in (fit, grown))
    return (best, after) if held_out_gain(before, after).low >= LEAST_GAIN else None


@dataclass(frozen=True)
class Provisional:
    """A curve that could stand in the model until its physics is known.

    Attributes:
        effect: the curve.
        before, after: relative held-out error without and with it, on the rows where it shows; gain: of it.
        picture: the residual that it has to explain, and the curve.
    """

    effect: Effect
    before: float
    after: float
    gain: Gain
    picture: Picture


def with_curve(fit: Fit, driver: str | None) -> Fit | None:
    """The model and the curve over what an answer says that the residual varies with; None where it cannot be had."""
    name = None if driver is None else name_of(driver)
    if name is None or name in fit.names:
        return None
    try:
        return fit_effects(fit, [*fit.names, name])
    except (NotApplicableError, UnusableDataError):
        return None


def provisional(fit: Fit, diagnosis: Diagnosis) -> Provisional | None:
    """The curve that a diagnosis of "unknown-effect" offers; None for other answers, or where it cannot be fitted."""
    filled = with_curve(fit, diagnosis.driver)
    if filled is None:
        return None
    effect = filled.effects[-1]
    rows = filled.dataset.choice_for(filled.effects)
    before, after = held_out(widened(fit, rows), rows), held_out(filled, rows)
    return Provisional(effect, before.relative, after.relative, held_out_gain(before, after), _picture(filled, effect))


def _picture(filled: Fit, effect: Effect) -> Picture:
    """Partial residual and curve over the variable, positive against the motion where the curve is."""
    dataset, rows = filled.dataset, filled.training
    values = dataset.rows_of([DRIVERS[effect.driver].of(trial) for trial in dataset.trials])[rows]
    own = len(effect.parameters)
    curve = (filled.columns[:, -own:] @ filled.coefficients[-own:])[rows]
    direction = np.sign(dataset.rows_of([trial.motion.direction for trial in dataset.trials])[rows])
    against = way_of(effect.name)[1] != FORCE
    sign = direction if against else np.ones(len(values))
    stretch = dataset.block_index[rows]
    residual = binned_mean(values, (filled.residual[rows] + curve) * sign, stretch)
    return Picture(effect.driver, against, residual, binned_mean(values, curve * sign, stretch))
