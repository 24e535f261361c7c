"""What comes again in repeated trials, and what does not, of all that a model leaves."""

import numpy as np
import pytest

from compensator.lab.left_over.repeated import recurring_share_in_words, share_that_recurs
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, plans, recordings


@pytest.fixture(scope="module")
def dataset():
    return make_dataset(recordings(Joint(), trials=plans(repeats=2), seed=4), FACTS, Processing())


def residuals(dataset, joint, own, seed=5):
    """Of the joint, the same whenever a motion comes again, and of the trial alone; root mean squares as told."""
    random, position = np.random.default_rng(seed), dataset.rows_of([trial.motion.position for trial in dataset.trials])
    wave = np.sin(9.0 * position)
    return joint * wave / np.sqrt(np.mean(wave**2)) + own * random.standard_normal(len(position))


@pytest.mark.parametrize(("joint", "own", "share"), [(1, 0, 1.0), (1, 1, 0.5), (1, 2, 0.2), (0, 1, 0.0)])
def test_it_is_the_share_of_the_power_that_is_the_joints(dataset, joint, own, share):
    rows = np.ones(len(dataset.effort), dtype=bool)
    found = share_that_recurs(dataset, residuals(dataset, joint, own), rows)
    assert found == pytest.approx(share, abs=0.08)  # three standard errors


def test_rows_of_one_alone_do_not_count(dataset):
    rows = np.random.default_rng(1).random(len(dataset.effort)) < 0.7
    residual = residuals(dataset, 1.0, 1.0)[rows]
    assert share_that_recurs(dataset, residual, rows) == pytest.approx(0.5, abs=0.08)


def test_without_repeats_one_is_asked_for():
    alone = make_dataset(recordings(Joint(), trials=plans(repeats=1), seed=4), FACTS, Processing())
    rows = np.ones(len(alone.effort), dtype=bool)
    assert share_that_recurs(alone, residuals(alone, 1.0, 0.0), rows) is None
    assert recurring_share_in_words(None).startswith("Repeat a trial")
    assert recurring_share_in_words(0.999) == "In repeated trials all of it comes again: it is the joint's."
    assert recurring_share_in_words(0.194).startswith("In repeated trials 19% of it comes again")
