"""What is worth holding out: a condition, not the number of a run."""

from bench.study.carrying import check_trials
from tests.lab.synthetic import plans
from tests.study.conftest import imported

LOADS_KG = (0.0, 0.1, 0.2)


def test_a_load_goes_before_a_repeat_however_often_it_was_repeated(store):
    experiment_id = imported(store, plans(LOADS_KG, repeats=4))
    assert check_trials(store, [experiment_id]).hold_out == "load_kg=0.1"
