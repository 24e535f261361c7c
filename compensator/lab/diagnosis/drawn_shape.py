"""An effect that a shape of the model has been drawn to imitate.

Shapes are found without the effect that is missing. Where its form is like that of one of them, as drag and a Stribeck
curve of a high speed and no Coulomb friction have much in common, the shape goes where it imitates the effect best, and
its tangents there explain the rest: nothing is left to be evidence, though a model with the effect, its shapes found
anew, leaves much less. So the model is judged at the shapes that it would have beside the effect, too, if the
likelihood of both together speaks very strongly against that of the shapes drawn (profile likelihood).
"""

from dataclasses import replace

import numpy as np

from compensator.lab.diagnosis.examination import SIGNIFICANT, as_in_the_ladder, is_confirmed
from compensator.lab.diagnosis.families import Answer, answer_of
from compensator.lab.diagnosis.wording import answer_in_words
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fit import fit_effects, fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.model.weights import row_weights
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import Candidates, gather
from compensator.lab.screening.clearing import with_noise
from compensator.lab.screening.evidence import (
    VERY_STRONG,
    Base,
    Block,
    inflation_of,
    screen,
    screen_against_noise,
)

TINY = float(np.finfo(float).tiny)


def answer_beside(fit: Fit, gathered: Candidates) -> tuple[Answer, Candidates] | None:
    """What steady sliding says of the model at such shapes, if that names the effect; and what it is judged on.

    The error must fall from that of the model as it is, not from that at shapes which no fit would have. Since that is
    a second look, chances count twice (Bonferroni).
    """
    found = _beside_drawn_shapes(fit, gathered)
    if found is None:
        return None
    name, at_these = found
    anew = with_noise(gather(at_these))
    assert anew.noise is not None
    physical = [block for block in anew.named if not effect_named(block.name).pipeline]
    stretch = fit.dataset.block_index[anew.rows]
    generic = screen(anew.bases, anew.curves.blocks, stretch, noise=anew.noise)
    answer = answer_of(at_these, anew, screen_against_noise(anew.bases, physical, anew.noise), generic)
    if answer.explained is None or answer.candidates[0].effect.name != name:
        return None
    best = as_in_the_ladder(answer.candidates[0], fit, answer.explained, "sliding")
    p_value, ranked = min(1.0, 2.0 * answer.p_value), [best, *answer.candidates[1:]]
    if p_value > SIGNIFICANT or not is_confirmed(best):
        return None
    sentence = answer_in_words("missing", p_value, ranked, None)
    return replace(answer, sentence=sentence, p_value=p_value, candidates=ranked), anew


def _beside_drawn_shapes(fit: Fit, gathered: Candidates) -> tuple[str, Fit] | None:
    """An effect that shapes of the model imitate, and the model at those that it has beside it; None where none does.

    Args:
        fit: the model, its shapes found without the effect.
        gathered: what it may be missing in steady sliding.
    """
    shaped = {name for name, shape in fit.shapes.items() if shape}
    judged = dict.fromkeys(block.name for block in gathered.named)
    found = [name for name in judged if shaped & set(effect_named(name).confused_with)]
    scores = {name: one for name in found if (one := _beside(fit, gathered, name)) is not None}
    if not scores:
        return None
    best = max(scores, key=lambda name: scores[name][0])
    return best, scores[best][1]


def _beside(fit: Fit, gathered: Candidates, name: str) -> tuple[float, Fit] | None:
    """How much speaks for shapes beside an effect against those drawn, and the model at these; None: not very much."""
    try:
        grown = fit_effects(fit.dataset, [*fit.names, name], fit.training)
        beside = {known: shape for known, shape in grown.shapes.items() if known != name}
        at_these = fit_model(fit.dataset, fit.names, fit.training, beside)
    except UnusableDataError:
        return None
    if at_these.shapes == fit.shapes:
        return None
    other = gather(at_these)
    rows = gathered.rows
    # as each row scatters beside the effect: what imitates it leaves most where it is largest
    weights = row_weights(fit.dataset, grown.residual, rows) * gathered.fit.dataset.steadiness[rows]
    blocks = [block for block in other.named if block.name == name]
    score = max((_score(gathered, other, block, weights) for block in blocks), default=0.0)
    return (score, at_these) if score >= VERY_STRONG else None


def _score(gathered: Candidates, other: Candidates, block: Block, weights: FloatArray) -> float:
    """2 ln L of the effect with the shapes beside it over the shapes drawn, less the price of what it has more."""
    drawn = _weighted(gathered, gathered.as_measured(block.base), weights)
    beside = _weighted(other, other.bases[block.base].extended(block.columns), weights)
    inflation = max(inflation_of(drawn.residual), inflation_of(beside.residual))
    independent = len(drawn.residual) / inflation
    more = max(beside.basis.shape[1] - drawn.basis.shape[1], 1)
    left = [max(float(base.residual @ base.residual), TINY) for base in (drawn, beside)]
    return float(independent * np.log(left[0] / left[1]) - more * np.log(independent))


def _weighted(gathered: Candidates, base: Base, weights: FloatArray) -> Base:
    """The base with other weights (n,) of its rows."""
    again = weights / gathered.weights
    return Base.of(base.basis * again[:, None], weights * gathered.fit.target[gathered.rows])
