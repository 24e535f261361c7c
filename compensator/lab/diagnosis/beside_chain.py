"""What an effect near reversals gains beside the columns of the measuring chain that it stands in for."""

from collections.abc import Callable

from compensator.lab.effects.effect import Effect
from compensator.lab.model.fit import with_columns
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain, held_out_gain
from compensator.lab.model.validation import HeldOut
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
