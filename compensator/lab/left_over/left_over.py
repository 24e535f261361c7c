"""What a model leaves of the effort: whether it is more than noise, and in what way, whatever the catalogue says."""

from dataclasses import dataclass

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over.constants import Constants
from compensator.lab.left_over.error_budget import PLAIN, WANDERING_BESIDE_A_NAME
from compensator.lab.left_over.orders import Line, line_of, recurring_in_words
from compensator.lab.left_over.remainder import LEAST_SHARE, Remainder, remainder_of, ringing_in_words
from compensator.lab.left_over.repeated import recurring_share_in_words, share_that_recurs
from compensator.lab.left_over.swinging import Swing, ripple_of, swing_of, swinging_in_words
from compensator.lab.left_over.wandering import Wandering, wandering_of
from compensator.lab.model.fit import widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.weights import RowWeights
from compensator.lab.recordings.facts import Facts
from compensator.lab.rows.dataset import BLOCK_S
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import too_few_stretches
from compensator.lab.screening.gathering import gather_curves


@dataclass(frozen=True, slots=True)
class LeftOver:
    """What is left beside all that the formulas of a model, and the measuring chain, leave open.

    Attributes:
        remainder: how much it is, and whether it follows the motion.
        swing: that it swings at one frequency; None where it does not for sure.
        wandering: that something constant is another one for seconds, however little; None where it is not for sure.
        line: that it comes back with the position; None where it does not for sure, and near reversals.
        recurs: how much of it comes again in repeated trials; None where there are none.
    """

    remainder: Remainder
    swing: Swing | None
    wandering: Wandering | None = None
    line: Line | None = None
    recurs: float | None = None

    @property
    def is_more_than_noise(self) -> bool:
        """Whether something is left to be explained."""
        found = (self.swing, self.wandering, self.line)
        return self.remainder.is_more_than_noise or any(one is not None for one in found)


def left_over(gathered: Candidates) -> LeftOver:
    """Judge what a model leaves on the rows where a family shows.

    Near reversals a formula of memory that is nearly right leaves some in every stretch, so that nothing is asked to be
    constant there.
    """
    dataset, rows, base = gathered.fit.dataset, gathered.rows, gathered.as_measured(WITH_CHAIN)
    determined = RowWeights.learnt(dataset, gathered.fit.residual, rows).determined(dataset, rows)
    residual = determined * base.residual / gathered.weights
    remainder, recurs = remainder_of(dataset, residual, rows), share_that_recurs(dataset, residual, rows)
    # so little may be of the motion, whose own frequencies most trials can share
    swing = swing_of(gathered) if remainder.share > LEAST_SHARE else None
    if gathered.show_in != "sliding":
        return LeftOver(remainder, swing, recurs=recurs)
    line = line_of(gathered)
    if not _is_plain(gathered.fit):
        # where the formula was found
        wandering = wandering_of(gather_constants(gathered), WANDERING_BESIDE_A_NAME)
        return LeftOver(remainder, swing, wandering, line, recurs)
    in_motion = gather_in_motion(gathered.fit)
    wandering = wandering_of(gather_constants(in_motion), PLAIN.wandering)
    return LeftOver(remainder, swing or ripple_of(in_motion), wandering, line, recurs)


def gather_constants(gathered: Candidates) -> Constants:
    """What a model takes for constant on the tested rows."""
    fit, rows = gathered.fit, gathered.rows
    base = gathered.as_measured(WITH_CHAIN)
    return Constants(fit.dataset, rows, base, gathered.weights, fit.dry_friction, fit.static_friction[rows])


def gather_in_motion(fit: Fit) -> Candidates:
    """What a model leaves of all rows in motion, those near reversals too, where it is fitted to them."""
    return gather_curves(widened(fit, "moving"), "moving")


def _is_plain(fit: Fit) -> bool:
    """Whether a model is what every joint has: a further formula that is nearly right leaves some of friction."""
    plain = default_effects(fit.dataset.facts)
    return all(effect.name in plain or effect.pipeline for effect in fit.effects)


def unexplained_in_words(left: LeftOver, driver: str | None, stretches: int, facts: Facts, wanders: str) -> str:
    """The answer where something is left that no effect and no curve explains.

    The chance of a diagnosis is that of its effects, which did not tell of it, and is left out.

    Args:
        left: what it is.
        driver: that it varies with most; None where it varies with none.
        stretches: independent stretches of BLOCK_S that it rests on.
        facts: of the joint.
        wanders: what is another one for seconds, in words; empty where nothing is.
    """
    none = "No effect of the catalogue is confirmed"
    if too_few_stretches(stretches):
        none = f"{stretches} stretches of {BLOCK_S:g} s are too few to name an effect"
    if left.line is not None:
        how = f"it {recurring_in_words(left.line, facts)}"
    elif left.swing is not None:
        how = f"it {swinging_in_words(left.swing)}"
    elif wanders:
        how = wanders
    elif left.remainder.resonance is not None:
        how = f"it {ringing_in_words(left.remainder.resonance)}"
    elif driver is not None:
        how = f"it varies with {driver}, most of all that is measured"
    else:
        how = "it varies with nothing that is measured"
    return (
        f"{none}, yet what is left, {left.remainder.share:.1%} of the effort, is more than noise; {how}. "
        f"{recurring_share_in_words(left.recurs)}"
    )
