"""Short trials of a known joint, fitted, and what is judged of a fitted model."""

from dataclasses import replace

import numpy as np

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over.constants import Constants
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.base import Base
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.gathering import gather, gather_curves
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings


def fitted(extra=None, seed: int = 0, facts: Facts = FACTS) -> Fit:
    """The model that every joint has, fitted to trials of six seconds, with so much more effort in them."""
    made = recordings(Joint(extra=extra), Bench(duration_s=6.0), plans(), seed)
    return fit_model(make_dataset(made, facts, Processing(cutoff_hz=8.0)), default_effects(facts))


def leaving(fit: Fit, residual: FloatArray) -> Candidates:
    """As if the model explained nothing of its rows in sliding and left a residual (n,)."""
    gathered = gather_curves(fit)
    base = Base(np.empty((len(residual), 0)), gathered.weights * residual)
    return replace(gathered, bases=[base for _ in gathered.bases])


def constants_of(fit: Fit) -> Constants:
    """On the rows where steady effects show."""
    gathered = gather(fit)
    rows = gathered.rows
    static = fit.static_friction[rows]
    return Constants(fit.dataset, rows, gathered.bases[0], gathered.weights, fit.dry_friction, static)
