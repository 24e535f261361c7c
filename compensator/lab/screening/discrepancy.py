"""What the formulas of a model's effects leave open, so that none of it is mistaken for one more effect.

A formula that is in the model is nearly right. What it misses is small beside the effect itself, but it can be large
beside noise, and then whatever effect of the catalogue is most like it would be named (Kennedy, O'Hagan 2001: model
discrepancy). So candidates are judged on top of

- the tangent of every fitted shape,
- columns that an effect itself says its truth may differ by (`Effect.discrepancy`),
- what all other effects make of an angle that one of them says is misread (`Effect.misreads`),
- what friction of the load makes of gravity, springs and offset that are a little otherwise, and
- the product of every two shares of dry friction, and of one with the other's tangents: what changes friction changes
  all of it, be it the weight, the angle or the grease, and an interaction of effects that are there is likelier than
  one more effect (Hamada, Wu 1992: effect heredity).
"""

from collections.abc import Collection
from dataclasses import replace
from functools import partial
from itertools import chain, combinations

import numpy as np

from compensator.lab.effects.effect import Motion, Shape
from compensator.lab.model.fitted import Fit
from compensator.lab.model.linear import Term
from compensator.lab.model.prediction import at_position
from compensator.lab.model.tangents import TANGENT_STEP, moved_shapes, tangents
from compensator.lab.recordings.recording import FloatArray

OFFSET = "offset"


def model_columns(fit: Fit, apart: Collection[str] = ()) -> FloatArray:
    """The model's columns that no bound holds, and what its formulas leave open; shape (N, k).

    Args:
        fit: the model.
        apart: effects whose product is left out: an effect that is judged stands for it.
    """
    free = np.concatenate([term.kept & ~term.at_bound for term in fit.terms])
    return np.column_stack([fit.columns[:, free], tangents(fit), discrepancy_columns(fit, apart)])


def discrepancy_columns(fit: Fit, apart: Collection[str] = ()) -> FloatArray:
    """What formulas leave open beside their shapes, over all rows, shape (N, k). Arguments as `model_columns`."""
    dataset = fit.dataset
    terms = [term for term in fit.terms if np.any(term.coefficients)]
    motions = [trial.motion for trial in dataset.trials]
    kinds = (_own, _misread, _carried, partial(_products, apart=apart))
    full_rate = (np.array([column for kind in kinds for column in kind(terms, m)]) for m in motions)
    first = next(full_rate)  # the others one by one: all of them at the full rate would need much memory
    return dataset.stack(chain([first], full_rate)) if len(first) else np.empty((len(dataset.effort), 0))


def _own(terms: list[Term], motion: Motion) -> list[FloatArray]:
    """What effects say of themselves, (n,) each."""
    found = [term.effect.discrepancy(motion, term.shape) for term in terms if term.effect.discrepancy is not None]
    return [column for columns in found for column in columns]


def _misread(terms: list[Term], motion: Motion) -> list[FloatArray]:
    """What all other terms make of an angle that is misread a little otherwise than was found, in any phase; (n,) each.

    What was found is corrected (`reading`); its size here is but that of a small step.
    """
    found = []
    for term in terms:
        if term.effect.misreads is None:
            continue
        others = [other for other in terms if other is not term and other.effect.builds_on is None]
        angles = term.effect.misreads(motion, term.shape)
        size = float(np.linalg.norm(term.coefficients[: len(angles)]))
        for angle in size * angles:
            moved = at_position(motion, motion.position + angle)
            changes = [_share(one, moved, one.shape) - _share(one, motion, one.shape) for one in others]
            found.append(np.sum(changes, axis=0))
    return found


def _carried(terms: list[Term], motion: Motion) -> list[FloatArray]:
    """What friction of the load makes of a load whose parts are each a little otherwise, (n,) each.

    The parts that a load is made of are fitted for what they are themselves, not for what the teeth make of them. All
    of the offset may be one of them, as what a spring pulls at angle 0, or none of it.
    """
    friction = [term for term in terms if term.effect.builds_on == "load" and term.effect.dry_friction]
    found = []
    for more in [more for term in terms for more in _more_load(term, motion)] if friction else []:
        moved = replace(motion, load_effort=motion.load_effort + more)
        changes = [_share(term, moved, term.shape) - _share(term, motion, term.shape) for term in friction]
        found.append(np.sum(changes, axis=0))
    return found


def _more_load(term: Term, motion: Motion) -> list[FloatArray]:
    """What a term's parts may add to the load beside what the model has of them there, (n,) each."""
    share = 1.0 if term.effect.name == OFFSET else TANGENT_STEP if term.effect.carried else 0.0
    parts = zip(term.coefficients, term.effect.columns(motion, term.shape), strict=True) if share else ()
    return [share * coefficient * column for coefficient, column in parts if coefficient]


def _products(terms: list[Term], motion: Motion, apart: Collection[str]) -> list[FloatArray]:
    """Of shares of dry friction, each of which may be a factor of all the others but for those apart; (n,) each."""
    shares = [(_share(term, motion, term.shape), term) for term in terms if term.effect.dry_friction]
    found = []
    for (one, first), (other, second) in combinations(shares, 2):
        if {first.effect.name, second.effect.name} <= set(apart):
            continue
        found.append(one * other)
        found += [one * (_share(second, motion, moved) - other) for moved in moved_shapes(second)]
        found += [other * (_share(first, motion, moved) - one) for moved in moved_shapes(first)]
    return [product * motion.direction for product in found]


def _share(term: Term, motion: Motion, shape: Shape) -> FloatArray:
    """What the term adds to the effort of a trial, at a shape."""
    share: FloatArray = term.coefficients @ term.effect.columns(motion, shape)
    return share
