"""What is missing and has no formula, as a curve over the variable it varies with: offered as a provisional term."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.diagnosis.diagnosis import Diagnosis, Picture
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Effect
from compensator.lab.effects.free_curve import AGAINST_MOTION, name_of
from compensator.lab.errors import NotApplicableError, UnusableDataError
from compensator.lab.model.fit import fit_effects, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain, held_out_gain
from compensator.lab.model.validation import held_out
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.rows.picture import binned_mean


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


def provisional(fit: Fit, diagnosis: Diagnosis) -> Provisional | None:
    """The curve that a diagnosis of "unknown-effect" offers; None for other answers, or where it cannot be fitted."""
    name = None if diagnosis.driver is None else name_of(diagnosis.driver)
    if name is None or name in fit.names:
        return None
    effect = effect_named(name)
    rows = fit.dataset.choice_for([*fit.effects, effect])
    try:
        wide = widened(fit, rows)
        filled = fit_effects(fit.dataset, [*fit.names, name], fit.training)
    except (NotApplicableError, UnusableDataError):
        return None
    before, after = held_out(wide, rows), held_out(filled, rows)
    return Provisional(effect, before.relative, after.relative, held_out_gain(before, after), _picture(filled, effect))


def _picture(filled: Fit, effect: Effect) -> Picture:
    """Partial residual and curve over the variable, positive against the motion where the curve is."""
    dataset, rows = filled.dataset, filled.training
    values = dataset.rows_of([DRIVERS[effect.driver].of(trial) for trial in dataset.trials])[rows]
    own = len(effect.parameters)
    curve = (filled.columns[:, -own:] @ filled.coefficients[-own:])[rows]
    direction = np.sign(dataset.rows_of([trial.motion.direction for trial in dataset.trials])[rows])
    against = effect.name.endswith(AGAINST_MOTION)
    sign = direction if against else np.ones(len(values))
    stretch = dataset.block_index[rows]
    residual = binned_mean(values, (filled.residual[rows] + curve) * sign, stretch)
    return Picture(effect.driver, against, residual, binned_mean(values, curve * sign, stretch))
