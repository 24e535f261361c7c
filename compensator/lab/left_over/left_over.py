"""What a model leaves of the effort: whether it is more than noise, and in what way, whatever the catalogue says."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.chance import SIGNIFICANT, chance_in_words
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over.constancy import Change, change_of, changing_in_words
from compensator.lab.left_over.constants import Constants
from compensator.lab.left_over.error_budget import NAMED, PLAIN
from compensator.lab.left_over.following import Following, following_of
from compensator.lab.left_over.orders import Line, growing_line_of, line_of, recurring_in_words
from compensator.lab.left_over.remainder import LEAST_SHARE, Remainder, remainder_of
from compensator.lab.left_over.ripple import ripple_of
from compensator.lab.left_over.swinging import Swing, swing_of, swinging_in_words
from compensator.lab.left_over.varying import Varying, varying_in_words, varying_of
from compensator.lab.left_over.wandering import Wandering, wandering_of
from compensator.lab.left_over.white_rows import WhiteRows
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.weights import RowWeights
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import BoolArray
from compensator.lab.recordings.regimes import Regime, within_spread
from compensator.lab.rows.dataset import BLOCK_S, Dataset
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import least_p_value
from compensator.lab.screening.gathering import gather_curves, with_noise

LEFT_SHARE = 0.8  # of the rows, at least: at a low cut-off the spread is most of a stroke, and few rows tell little


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


def unexplained_in_words(
    left: LeftOver, driver: str | None, p_value: float, stretches: int, facts: Facts, wanders: str = ""
) -> str:
    """The answer where something is left that no effect and no curve explains.

    Args:
        left: what it is.
        driver: that it varies with most; None where it varies with none.
        p_value: as in a diagnosis.
        stretches: independent stretches of BLOCK_S that it rests on.
        facts: of the joint.
        wanders: what is another one for seconds, in words; empty where nothing is.
    """
    none = f"No effect of the catalogue is confirmed ({chance_in_words(p_value)})"
    if least_p_value(stretches) > SIGNIFICANT:
        none = f"{stretches} stretches of {BLOCK_S:g} s are too few to name an effect"
    if left.change is not None:
        how = changing_in_words(left.change)
    elif left.line is not None and (left.following is None or left.line.chance <= left.following.chance):
        how = f"it {recurring_in_words(left.line, facts)}"
    elif left.swing is not None:
        how = f"it {swinging_in_words(left.swing)}"
    elif wanders:
        how = wanders
    elif left.varying is not None and left.following is None:
        how = f"it {varying_in_words(left.varying)}"
    elif driver is not None or left.following is not None:
        named = driver if left.following is None else left.following.driver
        how = f"it varies with {named}, most of all that is measured"
    else:
        how = "it varies with nothing that is measured"
    return (
        f"{none}, yet what is left, {left.remainder.share:.1%} of the effort, is more than noise; {how}. "
        "Repeat a trial: what comes again is the joint's, what does not has changed since."
    )


def left_for_sure(fit: Fit, gathered: Candidates) -> LeftOver | None:
    """What a model leaves on the rows that are judged; None where it is no more than noise, or of reversals alone.

    The final filter spreads what happens at a reversal to both sides, in the same way in every trial of one motion.
    What reaches rows that slide so is small beside any effect, but follows speed, load or temperature, as reversals do,
    and is no noise. To name an effect these rows are worth more than they mislead; that something is left, be it so
    small, must hold without them.

    Args:
        fit: the model.
        gathered: what it may be missing.
    """
    left = left_over(gathered)
    if not left.is_more_than_noise:
        return None
    clear = fit.training & ~_reached(fit.dataset)
    if gathered.show_in != "sliding" or clear.sum() < LEFT_SHARE * fit.training.sum():
        return left
    again = with_noise(gather_curves(fit_model(fit.dataset, fit.names, clear, fit.shapes)))
    return left if left_over(again).is_more_than_noise else None


def _reached(dataset: Dataset) -> BoolArray:
    """Rows that something of a reversal reaches through the filter, shape (N,)."""
    reached = []
    for trial in dataset.trials:
        signals = trial.signals
        reached.append(within_spread(signals.velocity, dataset.scales.slow, signals.rate_hz, dataset.cutoff_hz))
    return np.concatenate([own[trial.picked] for own, trial in zip(reached, dataset.trials, strict=True)])
