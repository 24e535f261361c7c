"""What lives near reversals is held against the effort of its own moment, beside all that a chain makes of that."""

import numpy as np
import pytest
from scipy.signal import lfilter

from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model, widened
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.gathering import gather
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings

LATE_S, SMOOTH_S = 0.02, 0.004


@pytest.fixture(scope="module")
def gathered() -> Candidates:
    """A joint whose position is old."""
    made = recordings(Joint(), Bench(delay_s=LATE_S, noise=1e-4), plans(loads_kg=(0.0, 0.2)), seed=5)
    names = [*default_effects(FACTS), "measurement_delay"]
    return gather(widened(fit_model(make_dataset(made, FACTS, Processing()), names), "moving"), "moving")


def test_the_effort_is_that_of_the_motion_that_it_makes(gathered):
    fit, dataset = gathered.fit, gathered.fit.dataset
    at_once = dataset.columns_of_model(fit.effects[:-1], fit.shapes) @ fit.coefficients[:-1]
    as_recorded = (dataset.effort - at_once)[gathered.rows]
    in_step = as_recorded + dataset.effort_gained_in_step[gathered.rows]
    assert dataset.trials[0].motion.late_s == pytest.approx(LATE_S, rel=0.05)
    assert float(np.std(in_step)) < 0.3 * float(np.std(as_recorded))


def test_candidates_are_held_against_that_effort(gathered):
    dataset = gathered.fit.dataset
    weighted = (dataset.effort + dataset.effort_gained_in_step)[gathered.rows] * gathered.weights
    base = gathered.bases[WITH_CHAIN]
    assert base.residual == pytest.approx(weighted - base.basis @ (base.basis.T @ weighted), abs=1e-9)


def test_what_lives_near_reversals_is_judged_on_top_of_one_model(gathered):
    bases = {block.base for block in gathered.named if block.name != "pre_sliding"}
    assert bases == {WITH_CHAIN}  # but for what stands for the contacts that give, as all do


def test_what_a_low_pass_makes_of_the_effort_is_no_evidence(gathered):
    dataset, base = gathered.fit.dataset, gathered.bases[WITH_CHAIN]
    parts = []
    for trial in dataset.trials:
        kept = np.exp(-trial.motion.step_s / SMOOTH_S)
        effort = trial.motion.predicted
        parts.append((lfilter([1.0 - kept], [1.0, -kept], effort, zi=kept * effort[:1])[0] - effort)[None])
    column = gathered.tested(dataset.stack(parts))[:, 0]
    left = column - base.basis @ (base.basis.T @ column)
    assert float(np.linalg.norm(left)) < 0.03 * float(np.linalg.norm(column))
