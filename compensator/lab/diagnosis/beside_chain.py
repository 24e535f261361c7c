"""The held-out gain of an effect near reversals beside the measuring chain's columns that it stands in for.

Evidence for such an effect is judged without these columns, and so is its gain: what a sign leaves that is smoothed,
early or late counts for both. A joint with dry friction stands for some hundredths of a second wherever it turns, and
its friction follows the effort there, not the speed: friction has another sign before the filtered speed has. That
looks like frictional lag, in any joint, and no more noise makes it go. What columns that nobody would name predict as
well is no reason for a name; so the error has to fall beside them, too.
"""

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
