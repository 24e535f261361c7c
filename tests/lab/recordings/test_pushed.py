"""A joint that is pushed and never slides: its stiffness, its loop, and how much it bore."""

import numpy as np
import pytest

from compensator.lab.errors import NeverSlidesError
from compensator.lab.recordings.effort import choose_effort
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.pushed import Pushed, pushed
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, recordings

STIFFNESS, LOOP = 150.0, 0.03  # N m/rad, N m
PUSHES_N_M = (0.2, 0.3, 0.4)


def push(largest_n_m: float, moves: bool = True, seed: int = 0) -> Recording:
    """Slow pushing to and fro of a spring with a dry slider beside it."""
    random = np.random.default_rng(seed)
    time_s = np.arange(0.0, 20.0, 0.005)
    way = largest_n_m / STIFFNESS * np.sin(2.0 * np.pi * 0.2 * time_s)
    dry = LOOP * np.sign(np.cos(2.0 * np.pi * 0.2 * time_s))
    torque = STIFFNESS * way + dry + 0.002 * random.standard_normal(len(time_s))
    position = 0.3 + (1e-6 * np.round(way / 1e-6) if moves else np.zeros(len(time_s)))
    return Recording(
        f"push {largest_n_m}", "push", {}, {"time_s": time_s, "position_rad": position, "torque_n_m": torque}
    )


def told(made: list[Recording]) -> Pushed | None:
    return pushed(made, choose_effort(made, Facts()), Facts())


@pytest.mark.parametrize("count", [1, 3])
def test_stiffness_loop_and_what_was_borne(count):
    found = told([push(size, seed=seed) for seed, size in enumerate(PUSHES_N_M[:count])])
    assert found is not None
    assert found.stiffness == pytest.approx(STIFFNESS, rel=0.05)  # the loop opens over a fiftieth of the way
    assert found.stiffness_low < found.stiffness < found.stiffness_high
    assert found.loop == pytest.approx(LOOP, rel=0.1)
    most = PUSHES_N_M[count - 1]
    assert found.highest == pytest.approx(most + LOOP, abs=0.02)
    assert found.lowest == pytest.approx(-most - LOOP, abs=0.02)


def test_a_joint_that_stands_tells_what_it_bore():
    found = told([push(0.2, moves=False)])
    assert found is not None
    assert np.isnan(found.stiffness)
    assert "does not move in any trial, under -0.23" in found.in_words()


def test_a_joint_that_slides_is_none():
    assert told(recordings(seed=1)) is None


def test_small_strokes_that_slide_are_none():
    """Coulomb friction goes by the sign of the velocity, and not by the position."""
    time_s = np.arange(0.0, 20.0, 0.005)
    way, sign = 0.004 * np.sin(2.0 * np.pi * 0.2 * time_s), np.sign(np.cos(2.0 * np.pi * 0.2 * time_s))
    channels = {"time_s": time_s, "position_rad": way, "torque_n_m": 0.08 * sign + 0.002 * np.sin(37.0 * time_s)}
    assert told([Recording("rub", "rub", {}, channels)]) is None


def test_no_model_of_sliding_is_made_of_it():
    with pytest.raises(NeverSlidesError, match=r"but does not slide in any trial, under .*; record trials with more"):
        make_dataset([push(size) for size in PUSHES_N_M], FACTS, Processing())
