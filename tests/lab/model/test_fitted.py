"""Which trials a model may be fitted to."""

from dataclasses import replace

import pytest

from compensator.lab.model.fitted import trained_trials
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Dataset, Processing
from tests.lab.synthetic import FACTS, Plan, plans, recordings

REVERSALS = Plan("reversals", [(0.05, 3.0, 0.0)])


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    made = make_dataset(recordings(trials=[*plans(), REVERSALS], seed=3), FACTS, Processing())
    assert made.counted[made.trial_rows[-1]].sum() == 0  # no row of steady sliding
    return made


def test_a_trial_of_reversals_alone_is_no_trial_that_is_held_out(dataset):
    held = replace(dataset, held_out=frozenset([0]))
    training = held.counted & (held.trial_index != 0)
    assert trained_trials(held, training).tolist() == list(range(1, len(held.trials)))
    assert trained_trials(dataset, dataset.counted).tolist() == list(range(len(dataset.trials)))


def test_where_trials_are_left_out_that_nobody_holds_out_it_stays_out(dataset):
    training = dataset.counted & (dataset.trial_index != 0)
    assert trained_trials(dataset, training).tolist() == list(range(1, len(dataset.trials) - 1))


def test_a_held_out_trial_of_reversals_alone_is_not_trained(dataset):
    held = replace(dataset, held_out=frozenset([len(dataset.trials) - 1]))
    assert trained_trials(held, held.counted).tolist() == list(range(len(held.trials) - 1))
