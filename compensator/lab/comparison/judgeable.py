"""Which effects trials can show beside a model, and which look alike in them: told by the columns, before any evidence.

What the model can make of an effect's columns is taken out first. An effect of which hardly anything is left hides in
the model; two of which one makes up for the other are confounded. Neither needs the measured effort. What a diagnosis
would not judge, for want of reversals or of motion, or since a free scale hides it, is not judged here either.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import nan
from typing import Literal

import numpy as np

from compensator.lab.effects.catalogue import candidates
from compensator.lab.effects.effect import Effect
from compensator.lab.errors import NotApplicableError
from compensator.lab.model.fit import widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import relative_error
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.evidence import too_few_stretches
from compensator.lab.screening.gathering import few_reversals, hides_in_words

Standing = Literal["judgeable", "confounded", "hidden", "not measured"]
SURE = 5.0  # standard deviations: an effect of that size is found nine times in ten among all others
MOST = 0.5  # of the effort: an effect that would have to be larger to show is not shown
ALIKE = 0.9  # share of an effect's power that another makes up for, from which they are confounded
MOST_SHAPES = 4  # of an effect with shapes that are looked at
TINY = 1e-12


@dataclass(frozen=True)
class Judgeable:
    """How trials stand to one effect.

    Attributes:
        effect: which.
        standing: whether it can be judged; hidden: the model makes up for it; not measured: the data lack something.
        reason: what they lack, or where it hides; "" where nothing.
        rivals: effects that look alike in these trials.
        smallest: size, root mean square over that of the effort, from which it would show; NaN where it cannot.
        few: whether rows near reversals are what is lacking.
    """

    effect: Effect
    standing: Standing
    reason: str
    rivals: tuple[str, ...]
    smallest: float = nan
    few: bool = False


@dataclass(frozen=True)
class _Shown:
    """An effect beside a model.

    Attributes: orthonormal columns of some shapes; the most of its power that is left; size from which it would show.
    """

    effect: Effect
    blocks: list[FloatArray]
    left: float
    smallest: float = nan


def judgeable(fit: Fit) -> list[Judgeable]:
    """How the trials of a model stand to every effect that it does not have."""
    shown: list[_Shown] = []
    found: dict[str, Judgeable] = {}
    base = _orthonormal(fit.columns[fit.training])
    dataset = with_own_prediction(fit.dataset, fit.terms)
    wide = widened(fit, "moving") if fit.dataset.rows == "sliding" else fit
    too_few = few_reversals(fit) or {}
    for effect in candidates(fit.names, fit.dataset.facts):
        if effect.name in too_few:
            reason = too_few[effect.name].partition("; ")[0]
            found[effect.name] = Judgeable(effect, "not measured", reason, (), few=True)
            continue
        try:
            one = _beside(fit, dataset, effect, base)
        except NotApplicableError as error:
            found[effect.name] = Judgeable(effect, "not measured", str(error).partition("; ")[0], ())
            continue
        if hidden := hides_in_words(effect, fit.names):
            found[effect.name] = Judgeable(effect, "hidden", hidden, ())
            continue
        smallest = _smallest(wide if effect.rows == "moving" else fit, one.left)
        if not one.blocks:
            found[effect.name] = Judgeable(effect, "not measured", "nothing in these trials excites it", ())
        elif not smallest < MOST:
            reason = f"the model makes up for {1.0 - one.left:.2%} of it"
            found[effect.name] = Judgeable(effect, "hidden", reason, (), smallest)
        else:
            shown.append(replace(one, smallest=smallest))
    if too_few_stretches(stretches_of(fit)):
        short = "these trials are too short"
        found |= {one.effect.name: Judgeable(one.effect, "not measured", short, ()) for one in shown}
        shown = []
    for one in shown:
        alike = tuple(other.effect.name for other in shown if other is not one and _alike(one.blocks, other.blocks))
        standing: Standing = "confounded" if alike else "judgeable"
        found[one.effect.name] = Judgeable(one.effect, standing, "", alike, one.smallest)
    return [found[effect.name] for effect in candidates(fit.names, fit.dataset.facts)]


def stretches_of(fit: Fit) -> int:
    """How many stretches a diagnosis of steady sliding rests on."""
    return fit.dataset.stretches(fit.training & fit.dataset.in_regimes("sliding"))


def _smallest(fit: Fit, left: float) -> float:
    """Size of an effect, over that of the effort, from which it would show; rows of one stretch count as one.

    Args:
        fit: on the rows where it shows: near reversals a model leaves more than in sliding.
        left: share of its power that the model leaves.
    """
    stretches = fit.dataset.stretches(fit.training)
    noise = relative_error(fit.residual[fit.training], fit.dataset.effort[fit.training])
    return SURE * noise / float(np.sqrt(stretches * left)) if left > TINY else nan


def _beside(fit: Fit, dataset: Dataset, effect: Effect, base: FloatArray) -> _Shown:
    """Columns of some of an effect's shapes, what the model makes of them taken out."""
    shapes = effect.grid([trial.motion for trial in dataset.trials])
    some = shapes[:: -(-len(shapes) // MOST_SHAPES)]
    blocks, most = [], 0.0
    for columns in dataset.columns_of_shapes(effect, some):
        rows = columns[fit.training]
        power = float(np.sum(rows**2))
        left = rows - base @ (base.T @ rows)
        share = float(np.sum(left**2)) / power if power > 0.0 else 0.0
        most = max(most, share)
        if share > TINY:
            blocks.append(_orthonormal(left))
    return _Shown(effect, blocks, most)


def _orthonormal(columns: FloatArray) -> FloatArray:
    """An orthonormal base of what columns span, shape (n, rank)."""
    size = np.linalg.norm(columns, axis=0)
    kept = columns[:, size > TINY * size.max(initial=0.0)] / size[size > TINY * size.max(initial=0.0)]
    left, values, _ = np.linalg.svd(kept, full_matrices=False)
    base: FloatArray = left[:, values > 1e-6 * values.max(initial=0.0)]
    return base


def _alike(own: Sequence[FloatArray], others: Sequence[FloatArray]) -> bool:
    """Whether another effect, at one of its shapes, makes up for this one at one of its own."""
    shares = (float(np.sum((other.T @ one) ** 2)) / one.shape[1] for one in own for other in others if one.shape[1])
    return max(shares, default=0.0) >= ALIKE
