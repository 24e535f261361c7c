"""The held-out gain of an effect that the errors of other formulas hide.

Evidence is judged on top of what the model's formulas leave open, the held-out error is the plain model's: where a
formula that is nearly right leaves more than a smaller effect explains, and its shapes have been drawn to make up for
that, the effect's evidence is very strong and the error does not fall. Then the gain, too, is had on top of it: both
models with their own best shapes, beside the same columns (Frisch, Waugh 1933; Lovell 1963).
"""

from collections.abc import Callable

from compensator.lab.diagnosis.diagnosis import BesideOpen
from compensator.lab.effects.effect import Effect
from compensator.lab.model.fit import fit_effects, with_columns
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain, held_out_gain
from compensator.lab.model.validation import HeldOut
from compensator.lab.screening.discrepancy import open_columns
from compensator.lab.screening.nuisance import smoothed_signs

NAME = "measuring chain"


def gain_beside_chain(effect: Effect, fit: Fit, explained: Fit, held_out: Callable[[Fit], HeldOut]) -> Gain | None:
    """What an effect gains beside the columns that it stands in for; None where it stands in for none.

    Args:
        effect: that may be missing.
        fit: the model, on rows near reversals, too.
        explained: the model with the effect.
        held_out: error of a model on the rows that are judged.
    """
    if not effect.standing_in:
        return None
    columns = smoothed_signs(fit.dataset, effect.standing_in)
    before, after = (held_out(with_columns(model, NAME, columns)) for model in (fit, explained))
    return held_out_gain(before, after)


NAME = "left open"


def beside_open(fit: Fit, names: list[str], held_out: Callable[[Fit], HeldOut]) -> dict[str, BesideOpen]:
    """By name, what each of some effects gains beside what the model's formulas leave open; empty where that is none.

    Args:
        fit: the model, its own prediction in every motion.
        names: of the effects.
        held_out: error of a model on the rows that are judged.
    """
    columns = open_columns(fit) if names else None
    if columns is None or not columns.shape[1]:
        return {}
    before = held_out(with_columns(fit, NAME, columns))
    found = {}
    for name in names:
        grown = fit_effects(fit.dataset, [*fit.names, name], fit.training)
        after = held_out(with_columns(grown, NAME, columns))
        found[name] = BesideOpen(before.relative, after.relative, held_out_gain(before, after))
    return found
