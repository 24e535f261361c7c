import numpy as np
import pytest

from sim_backend.errors import ParameterError
from sim_backend.mechanisms.motor.motor import VOLTAGE
from sim_backend.plant import presets
from sim_backend.plant.batch import Course, run_batch, run_course
from sim_backend.plant.kernel import advance
from sim_backend.plant.plant import Plant
from tests.sim_backend.plants import parameters

DEMANDS = 0.4 * np.sin(0.1 * np.arange(200.0))


def _course(seed: int) -> Course:
    return Course(parameters=presets.paper(), seed=seed, stage=VOLTAGE, demands=DEMANDS * (1.0 + 0.1 * seed), steps=50)


def test_course_is_what_call_after_call_would_do() -> None:
    plant = Plant(presets.paper(), seed=3)
    rows = [list(plant.advance(VOLTAGE, demand, 50)) for demand in DEMANDS * 1.3]
    outcome = run_course(_course(3))
    assert str(outcome.measured.tolist()) == str(rows)
    assert outcome.truth == plant.truth()
    assert outcome.energy == plant.energy()


def test_whole_number_for_demand_is_no_other_kernel() -> None:
    plant = Plant(presets.paper())
    plant.advance(VOLTAGE, 0.0, 1)
    compiled = len(advance.signatures)  # type: ignore[attr-defined]
    plant.advance(VOLTAGE, 0, 1)
    assert len(advance.signatures) == compiled  # type: ignore[attr-defined]


@pytest.mark.parametrize(("batch", "workers"), [(1, 1), (3, 2), (12, 2), (12, 5)])
def test_same_seed_gives_the_same_bytes_whatever_the_batch_and_the_workers(batch: int, workers: int) -> None:
    wanted = run_course(_course(0)), run_course(_course(batch - 1))
    outcomes = list(run_batch((_course(seed) for seed in range(batch)), workers))
    assert len(outcomes) == batch
    for outcome, want in zip((outcomes[0], outcomes[-1]), wanted, strict=True):
        assert outcome.measured.tobytes() == want.measured.tobytes()
        assert outcome.truth == want.truth


def test_impossible_course_is_refused() -> None:
    stiff = parameters(gear={"stiffness_n_m_rad": 1e6})
    with pytest.raises(ParameterError, match="too coarse"):
        list(run_batch([Course(parameters=stiff, stage=VOLTAGE, demands=DEMANDS, steps=1)]))
