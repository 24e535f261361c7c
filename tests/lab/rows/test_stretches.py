"""How many independent stretches rows are of: what a diagnosis rests on."""

import numpy as np

from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import BLOCK_S, Processing
from tests.lab.synthetic import FACTS, Bench, plans, recordings


def test_rows_of_one_stretch_count_once_and_those_of_another_trial_apart():
    dataset = make_dataset(recordings(bench=Bench(duration_s=6.0), trials=plans(), seed=1), FACTS, Processing())
    trials = len(dataset.trials)
    every = np.ones(len(dataset.effort), dtype=bool)
    assert dataset.stretches(every) == trials * round(6.0 / BLOCK_S)
    first_s = np.concatenate([dataset.time_of(trial) < BLOCK_S for trial in dataset.trials])
    assert dataset.stretches(first_s) == trials
    assert dataset.stretches(first_s & (dataset.trial_index == 0)) == 1
    assert dataset.stretches(~every) == 0
