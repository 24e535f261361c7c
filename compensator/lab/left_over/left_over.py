"""What a model leaves of the effort: whether it is more than noise, and in what way, whatever the catalogue says."""

from dataclasses import dataclass

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over.constancy import Change, change_of
from compensator.lab.left_over.constants import Constants
from compensator.lab.left_over.error_budget import NAMED, PLAIN
from compensator.lab.left_over.following import Following, following_of
from compensator.lab.left_over.orders import Line, growing_line_of, line_of
from compensator.lab.left_over.remainder import LEAST_SHARE, Remainder, remainder_of
from compensator.lab.left_over.ripple import ripple_of
from compensator.lab.left_over.swinging import Swing, swing_of
from compensator.lab.left_over.varying import Varying, varying_of
from compensator.lab.left_over.wandering import Wandering, wandering_of
from compensator.lab.left_over.white_rows import WhiteRows
from compensator.lab.model.fit import widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.weights import RowWeights
from compensator.lab.recordings.regimes import Regime
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates, gather_curves


@dataclass(frozen=True, slots=True)
class LeftOver:
    """What is left beside all that the formulas of a model, and the measuring chain, leave open.

    Attributes:
        remainder: how much it is, and whether it follows the motion.
        change: that something constant is another one in each stretch; None where nothing is for sure.
        swing: that it swings at one frequency; None where it does not for sure.
        wandering: that dry friction is another one for seconds, however little; None where it is not for sure.
        line: that it comes back with the position; None where it does not for sure, or where it is not asked for.
        following: the variable that it follows; None likewise.
        varying: the coefficient of friction that is another one at another load or temperature; None likewise.
    """

    remainder: Remainder
    change: Change | None
    swing: Swing | None
    wandering: Wandering | None = None
    line: Line | None = None
    following: Following | None = None
    varying: Varying | None = None

    @property
    def is_more_than_noise(self) -> bool:
        """Whether something is left to be explained."""
        found = (self.change, self.swing, self.wandering, self.line, self.following, self.varying)
        return self.remainder.is_more_than_noise or any(one is not None for one in found)


def left_over(gathered: Candidates) -> LeftOver:
    """Judge what a model leaves on the rows where a family shows.

    Near reversals a formula of memory that is nearly right leaves some in every stretch, so that nothing is asked to be
    constant there; nor is it asked not to swing: teeth and shafts do, each reversal anew, at a frequency of their own.
    """
    dataset, rows, base = gathered.fit.dataset, gathered.rows, gathered.as_measured(WITH_CHAIN)
    steady = gathered.show_in == "sliding"
    determined = RowWeights.learnt(dataset, gathered.fit.residual, rows).determined(dataset, rows)
    remainder = remainder_of(dataset, determined * base.residual / gathered.weights, rows)
    sliding = dataset.regime[rows] == Regime.SLIDING
    swing = swing_of(dataset, base.residual[sliding], rows & (dataset.regime == Regime.SLIDING))
    if swing is not None and not swing.of_voltage and remainder.share <= LEAST_SHARE:
        swing = None  # so little may be of the motion, whose own frequencies most trials can share
    if not steady:
        return LeftOver(remainder, None, swing)
    constants = gather_constants(gathered)
    change = change_of(constants)
    if not _is_plain(gathered.fit):
        # where the formula was found
        return LeftOver(remainder, change, swing, wandering_of(constants, NAMED.wandering) if change is None else None)
    in_motion = gather_in_motion(gathered.fit)
    wandering = wandering_of(gather_constants(in_motion), PLAIN.wandering) if change is None else None
    white = WhiteRows.of(gathered)
    if white is None:
        return LeftOver(remainder, change, swing, wandering)
    swing = swing or ripple_of(in_motion)
    line = line_of(gathered, white) or growing_line_of(gathered, white, PLAIN.growing)
    varying = varying_of(gathered, white, PLAIN.varying)
    return LeftOver(remainder, change, swing, wandering, line, following_of(gathered, white), varying)


def gather_constants(gathered: Candidates) -> Constants:
    """What a model takes for constant on the tested rows."""
    fit, rows = gathered.fit, gathered.rows
    base = gathered.as_measured(WITH_CHAIN)
    return Constants(fit.dataset, rows, base, gathered.weights, fit.dry_friction, fit.static_friction[rows])


def gather_in_motion(fit: Fit) -> Candidates:
    """What a model leaves of all rows in motion, those near reversals too, where it is fitted to them."""
    return gather_curves(widened(fit, "moving"), "moving")


def _is_plain(fit: Fit) -> bool:
    """Whether a model is what every joint has: a further formula that is nearly right leaves lines and curves, too."""
    plain = default_effects(fit.dataset.facts)
    return all(effect.name in plain or effect.pipeline for effect in fit.effects)
