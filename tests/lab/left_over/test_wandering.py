"""Dry friction that is another one for seconds is told however little it is; what scatters in any joint is not."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over import cells
from compensator.lab.left_over.constants import DRY_FRICTION, OFFSET
from compensator.lab.left_over.left_over import gather_constants, gather_in_motion
from compensator.lab.left_over.wandering import wandering_of
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.left_over.judged import constants_of
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings

COULOMB_N_M = 0.08
FASTEST = 2  # of the trials
SMALL = 0.008  # of dry friction, half of a jump: its variance is not sure, nor are rows in steady sliding alone


def fitted(extra=None, seed=0, **bench):
    made = recordings(Joint(extra=extra), Bench(**{"duration_s": 6.0, "noise": 0.003, **bench}), plans(), seed)
    return fit_model(make_dataset(made, FACTS, Processing(cutoff_hz=6.0)), default_effects(FACTS))


def judged(fit):
    return wandering_of(gather_constants(gather_in_motion(fit)))


def jumping(share, of=lambda x: np.sign(x.v)):
    """What is larger or smaller, by a share of dry friction, from a moment on that differs from trial to trial."""
    random = np.random.default_rng(5)

    def extra(x):
        at_s, way = random.uniform(1.5, 4.5), random.choice([-1.0, 1.0])
        return share * way * COULOMB_N_M * np.where(x.time_s > at_s, 1.0, -1.0) * of(x)

    return extra


def along_the_path(share, alike_rad):
    """Dry friction that wanders along the path, alike over so much of it."""
    random = np.random.default_rng(7)

    def extra(x):
        steps = np.abs(np.diff(x.q, prepend=x.q[0]))
        value, found = random.standard_normal(), np.empty(len(x.q))
        for i, step in enumerate(steps):
            alike = np.exp(-step / alike_rad)
            value = alike * value + np.sqrt(1.0 - alike**2) * random.standard_normal()
            found[i] = value
        return share * COULOMB_N_M * found * np.sign(x.v)

    return extra


def from_stop_to_stop(share):
    """Static friction that is another one after each stop."""
    random = np.random.default_rng(11)

    def extra(x):
        stroke = np.cumsum(np.diff(np.sign(x.v), prepend=0.0) != 0.0)
        scatter = share * random.standard_normal(stroke.max() + 1)
        return scatter[stroke] * 0.12 * np.exp(-np.abs(x.v) / 0.25) * np.sign(x.v)

    return extra


@pytest.mark.parametrize(
    ("what", "of"),
    [(DRY_FRICTION, lambda x: np.sign(x.v)), (OFFSET, lambda x: np.ones_like(x.v))],
    ids=["dry", "offset"],
)
def test_a_jump_is_told_with_its_size_and_where_it_is(what, of):
    fit = fitted(jumping(0.03, of), seed=1)
    constants, found = gather_constants(gather_in_motion(fit)), judged(fit)
    assert found is not None
    assert found.what == what
    assert found.size == pytest.approx(0.03 * COULOMB_N_M, rel=0.5)
    whole = constants.friction if what == DRY_FRICTION else np.sqrt(np.mean(constants.effort**2))
    assert found.share == pytest.approx(found.size / whole, rel=1e-3)
    assert all(1.0 < at_s < 5.0 for _, at_s in found.changes)


def test_the_answer_names_what_wanders_and_where():
    fit = fitted(jumping(0.03))
    found, answer = judged(fit), diagnose(fit)
    assert answer.remains
    assert "dry friction is another one for seconds at a time" in answer.sentence
    assert fit.dataset.trials[found.changes[0][0]].signals.recording.name in answer.sentence


def from_reversal_to_reversal(share):
    """What comes up anew after each reversal, and is gone where the joint slides."""
    random = np.random.default_rng(13)

    def extra(x):
        stroke = np.cumsum(np.diff(np.sign(x.v), prepend=0.0) != 0.0)
        scatter = share * random.standard_normal(stroke.max() + 1)
        near = np.exp(-(np.abs(x.v) / 0.1))
        return COULOMB_N_M * (scatter[stroke] + share * random.standard_normal(len(x.v))) * near * np.sign(x.v)

    return extra


def test_what_comes_up_after_each_reversal_does_not_hide_a_jump():
    jumps, scatters = jumping(0.016), from_reversal_to_reversal(0.6)
    found = judged(fitted(lambda x: jumps(x) + scatters(x), seed=1))
    assert found is not None
    assert found.size == pytest.approx(0.016 * COULOMB_N_M, rel=0.5)


@pytest.mark.parametrize(
    "extra",
    [
        None,
        along_the_path(0.03, 0.05),
        along_the_path(0.1, 0.2),
        from_stop_to_stop(0.2),
        from_reversal_to_reversal(0.3),
    ],
    ids=["noise", "path", "long path", "stops", "reversals"],
)
@pytest.mark.parametrize("seed", range(2))
def test_what_any_joint_has_is_no_wandering(extra, seed):
    assert judged(fitted(extra, seed)) is None


def test_a_trial_whose_reversals_scatter_more_has_a_larger_scale_of_that():
    constants = gather_constants(gather_in_motion(fitted(from_reversal_to_reversal(0.3))))
    near = (constants.dataset.trial_index[constants.rows] == FASTEST) & ~constants.sliding
    base = replace(constants.base, residual=np.where(near, 3.0, 1.0) * constants.base.residual)
    before, after = (
        [trial.part.kernels[1:3].sum() for trial in cells.cells_of(one, constants.weights)]
        for one in (constants, replace(constants, base=base))
    )
    times = np.array(after) / before
    assert times[FASTEST] == pytest.approx(9.0 * times[0])
    assert np.delete(times, FASTEST) == pytest.approx(times[0])


def test_long_trials_have_longer_cells_and_of_many_trials_some_are_looked_at(monkeypatch):
    constants = constants_of(fitted())
    monkeypatch.setattr(cells, "MOST_CELLS", 10)
    monkeypatch.setattr(cells, "MOST_TRIALS", 3)
    trials = cells.cells_of(constants, constants.weights)
    strokes = max(len(np.unique(trial.motion.strokes.index)) for trial in constants.dataset.trials)
    assert len(trials) <= 3
    assert max(len(trial.time_s) for trial in trials) <= 11 + strokes


@pytest.mark.parametrize("of", [np.sign, np.ones_like], ids=["friction", "a force"])
def test_what_is_another_one_in_each_trial_does_not_wander(of):
    """That is scatter from trial to trial, which every term of a model has."""
    random = np.random.default_rng(11)

    def extra(x):
        return 0.03 * COULOMB_N_M * random.standard_normal() * of(x.v)

    assert judged(fitted(extra)) is None
