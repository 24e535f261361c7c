"""A free curve, or a free hysteresis, that no formula of the catalogue follows."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.diagnosis.confirmation import helpful_curve, is_confirmed, is_helpful
from compensator.lab.diagnosis.diagnosis import Candidate, Diagnosis, Picture
from compensator.lab.diagnosis.examination import FORMULA_SHARE
from compensator.lab.effects.effect import Effect
from compensator.lab.effects.free_curve import FORCE, name_of, way_of
from compensator.lab.errors import NotApplicableError, UnusableDataError
from compensator.lab.model.fit import fit_effects, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain, held_out_gain
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.validation import held_out
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.rows.picture import binned_mean
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence, Screening


def unfollowed(gathered: Candidates, generic: Screening, examined: list[Candidate]) -> Evidence | None:
    """The helpful curve that no formula follows; None where there is none.

    A formula that is confirmed follows it where it has most of the evidence, or the curve does not help beside it.

    Args:
        gathered: the model, and what it may be missing.
        generic: evidence for free curves.
        examined: candidates.
    """
    found = helpful_curve(gathered, generic)
    if found is None:
        return None
    curve, errors = found
    return None if any(_follows(one, curve, errors) for one in examined) else curve


def _follows(one: Candidate, curve: Evidence, errors: HeldOut) -> bool:
    if not is_confirmed(one) or one.evidence is None or one.explained is None:
        return False
    most = one.evidence.noncentrality >= FORMULA_SHARE * curve.noncentrality
    return most or not is_helpful(held_out(one.explained), errors)


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
    before, after = (held_out(widened(one, rows), rows) for one in (fit, filled))
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
