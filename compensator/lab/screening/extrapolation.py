"""How much of an effect's evidence is left without noise of the position: what smooths an effort smooths it, too.

The acceleration keeps noise where the motion itself is (`recordings/position_noise.py`), and it is in the columns and
in the residual alike. So as much again is added to the acceleration, and what this adds to the pull of the evidence is
taken off once (simulation extrapolation: Cook, Stefanski 1994).
"""

from dataclasses import replace

import numpy as np

from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.rows.dataset import Dataset, Trial
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence, new_directions
from compensator.lab.screening.gathering import gather


def kept_without_noise(gathered: Candidates, item: Evidence) -> float:
    """Share of the evidence for an effect that is left, 0..1.

    Args:
        gathered: the model, and what it may be missing, whitened.
        item: evidence for the effect.
    """
    assert gathered.noise is not None
    fit = gathered.fit
    noisier = fit_model(_noisier(fit.dataset), fit.names, fit.training, fit.shapes)
    # of the same weights: those go by acceleration and jerk, too
    again = gather(noisier, gathered.show_in, gathered.weights).whitened(gathered.noise)
    return float(np.clip(2.0 - _pull(again, item) / _pull(gathered, item), 0.0, 1.0) ** 2)


def _pull(gathered: Candidates, item: Evidence) -> float:
    """Root of what the effect explains, of the scanned shape next to its own."""
    blocks = [block for block in gathered.named if block.name == item.block.name]
    block = min(blocks, key=lambda one: float(np.abs(np.subtract(one.shape, item.block.shape)).sum()))
    base = gathered.bases[block.base]
    return float(np.linalg.norm(new_directions(base, block).T @ base.residual))


def _noisier(dataset: Dataset) -> Dataset:
    trials = tuple(_with_noise_again(trial) for trial in dataset.trials)
    return replace(dataset, trials=trials, cache={}, unfiltered={})


def _with_noise_again(trial: Trial) -> Trial:
    noise, motion = trial.signals.acceleration_noise, trial.motion
    jerk = motion.jerk + rate_of_change(noise, trial.signals.rate_hz)
    return replace(trial, motion=replace(motion, acceleration=motion.acceleration + noise, jerk=jerk))
