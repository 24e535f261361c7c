"""Collects every effect and driver spline that could be missing from a fitted model, as blocks to be screened."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from compensator.lab.effects import catalogue
from compensator.lab.effects.catalogue import chain_effects
from compensator.lab.effects.effect import Effect, MotionRows, Shape
from compensator.lab.errors import NotApplicableError
from compensator.lab.model.fitted import Fit
from compensator.lab.model.order_search import Path
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.model.weights import weights_of
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.recordings.regimes import Regime
from compensator.lab.screening.base import Base, Block
from compensator.lab.screening.candidates import Candidates, Curves
from compensator.lab.screening.discrepancy import model_columns
from compensator.lab.screening.evidence import most_likely
from compensator.lab.screening.generic import free_curves
from compensator.lab.screening.noise import Noise
from compensator.lab.screening.nuisance import nuisance_columns
from compensator.lab.screening.random_effects import RandomEffect

FEWEST_REVERSAL_ROWS = 40


def few_reversals(fit: Fit) -> dict[str, str] | None:
    """Effect with memory that a model does not have -> how few rows near reversals it has; None where there are enough.

    One count for all who ask.
    """
    dataset = fit.dataset
    trained = np.isin(dataset.trial_index, np.unique(dataset.trial_index[fit.training]))
    count = int((trained & (dataset.regime == Regime.TRANSIENT)).sum())
    if count >= FEWEST_REVERSAL_ROWS:
        return None
    why = f"needs reversals and starts: {count} rows lie near one, wanted {FEWEST_REVERSAL_ROWS}; record "
    wanted = [effect for effect in catalogue.candidates(fit.names, dataset.facts) if effect.rows == "moving"]
    return {effect.name: f"{effect.name} {why}{effect.excited_by}" for effect in wanted}


def hides_in_words(effect: Effect, names: Collection[str]) -> str:
    """Where an effect hides in a model of such effects, so that it cannot be judged; empty where it does not."""
    if not (hiding := [name for name in effect.hidden_by if name in names]):
        return ""
    rivals = " or ".join(effect.confused_with)
    return f"{effect.name} hides in the free scale of {' and '.join(hiding)}: nothing can tell it from {rivals}"


def gather(fit: Fit, show_in: MotionRows = "sliding", weights: FloatArray | None = None) -> Candidates:
    """Collect candidates for a fitted model: training rows, weighted, on top of model and nuisance columns.

    Args:
        fit: of the model.
        show_in: the rows that are tested, and the effects that show in them.
        weights: of these rows, shape (n,); None: as its residual tells.
    """
    ground, builder = _ground(fit, show_in, weights)
    named, left_out = builder.named()
    return replace(ground, bases=builder.bases, named=named, left_out=left_out)


def gather_curves(fit: Fit, show_in: MotionRows = "sliding") -> Candidates:
    """The same without the effects of the catalogue: what the model leaves, and free curves. Arguments as `gather`."""
    return _ground(fit, show_in, None)[0]


def _ground(fit: Fit, show_in: MotionRows, weights: FloatArray | None) -> "tuple[Candidates, _Builder]":
    dataset = with_own_prediction(fit.dataset, fit.terms)
    fit = replace(fit, dataset=dataset)
    rows = fit.training & dataset.in_regimes(show_in)
    weights = weights_of(fit, rows, fit.residual[rows]) if weights is None else weights
    builder = _Builder(fit, show_in, rows, weights)
    curves = Curves(partial(free_curves, dataset), builder.weighted)
    return Candidates(fit, show_in, rows, weights, builder.bases, [], curves, {}), builder


class _Builder:
    def __init__(self, fit: Fit, show_in: MotionRows, rows: BoolArray, weights: FloatArray) -> None:
        self._fit, self._show_in, self._rows, self._weights = fit, show_in, rows, weights
        self._nuisance = nuisance_columns(fit.dataset, show_in)
        # near reversals all changes within a delay; what a chain makes of the effort shows in it as it was recorded
        self._target = fit.target + (fit.dataset.effort_gained_in_step if show_in == "moving" else 0.0)
        self._index: dict[tuple[frozenset[str], tuple[str, ...]], int] = {}
        self.bases: list[Base] = []
        self._model: dict[tuple[str, ...], FloatArray] = {(): model_columns(fit)}
        self._base_of(frozenset(), ())

    def weighted(self, columns: FloatArray) -> FloatArray:
        return columns[self._rows] * self._weights[:, None]

    def named(self) -> tuple[list[Block], dict[str, str]]:
        """Blocks of all effects that can be judged, and why the others cannot."""
        dataset = self._fit.dataset
        wanted, left_out = self._judged()
        made = dataset.columns_of_effects(wanted)
        blocks = [
            Block(effect.name, self.weighted(columns), self._base_for(effect), len(shapes), shape)
            for (effect, shapes), found in zip(wanted, made, strict=True)
            for shape, columns in zip(shapes, found, strict=True)
        ]
        return blocks, left_out

    def _judged(self) -> tuple[list[tuple[Effect, list[Shape]]], dict[str, str]]:
        dataset = self._fit.dataset
        wanted, left_out = [], {}
        path = Path.of(dataset, self._rows, self._weights)
        for effect in catalogue.candidates(self._fit.names, dataset.facts):
            if effect.rows != self._show_in:
                continue
            try:
                dataset.check_applicable(effect)
            except NotApplicableError as reason:
                left_out[effect.name] = str(reason)
                continue
            if hidden := hides_in_words(effect, self._fit.names):
                left_out[effect.name] = f"{hidden}; {effect.excited_by} would"
                continue
            shapes = effect.shapes(dataset.trials[0].motion)
            wanted.append((effect, path.shown(shapes) if effect.goes_round is not None else shapes))
        return wanted, left_out

    def _base_for(self, effect: Effect) -> int:
        """Without what the effect stands for: columns of the chain, or the product of two that it comes after."""
        return self._base_of(effect.standing_in, effect.after if len(effect.after) > 1 else ())

    def _base_of(self, nuisances: frozenset[str], apart: tuple[str, ...]) -> int:
        if (nuisances, apart) not in self._index:
            if apart not in self._model:
                self._model[apart] = model_columns(self._fit, apart)
            kept = [column for name, column in self._nuisance.items() if name not in nuisances]
            columns = np.column_stack([self._model[apart], *kept])
            self._index[nuisances, apart] = len(self.bases)
            effort = self._weights * self._target[self._rows]
            self.bases.append(Base.of(self.weighted(columns), effort))
        return self._index[nuisances, apart]


def with_noise(gathered: Candidates) -> Candidates:
    """The same candidates, whitened by the noise of what is left once the likeliest block is in the model.

    What is missing must not count as noise. Of the joint's blocks alone: what the measuring chain does badly is noise
    to whoever asks what the joint lacks. A block is taken off only where it pays against noise of the residual's
    colour: held against white noise, slow blocks seem to pay wherever noise is slow.
    """
    joint = [block for block in gathered.named if block.name not in chain_effects()]
    block = most_likely(gathered.bases, [*joint, *gathered.curves.blocks])
    left = gathered
    if block is not None:
        alone = replace(gathered, named=[block]).whitened(_noise_of(gathered, []))
        if any(item.score > 0.0 for item in alone.screened(alone.named).evidence):
            left = gathered.with_block(block)
    return gathered.whitened(_noise_of(left, _random_effects(gathered)))


def _noise_of(left: Candidates, random: Sequence[RandomEffect]) -> Noise:
    """What is left of the candidates' rows."""
    return Noise.learnt(left.fit.dataset, left.rows, left.bases[0], random)


def _random_effects(gathered: Candidates) -> list[RandomEffect]:
    """Each term of the model from trial to trial, and static friction from stop to stop, in the tested rows."""
    fit, rows = gathered.fit, gathered.rows
    dataset, trial = fit.dataset, fit.dataset.trial_index[rows]
    stroke = np.concatenate([trial.motion.strokes.index[trial.picked] for trial in dataset.trials])[rows]
    _, stroke = np.unique(np.stack([trial, stroke]), axis=1, return_inverse=True)
    trial = np.unique(trial, return_inverse=True)[1]
    ends = np.cumsum([0, *(len(term.coefficients) for term in fit.terms)])
    shares = [fit.columns[rows, a:b] @ fit.coefficients[a:b] for a, b in pairwise(ends)]
    shares = [share for share in shares if np.ptp(share) > 0.0] + [fit.dry_friction * dataset.constant[rows]]
    return [
        *(RandomEffect(gathered.weights * share, trial) for share in shares),
        RandomEffect(gathered.weights * fit.static_friction[rows], np.asarray(stroke, dtype=np.int64).ravel()),
    ]
