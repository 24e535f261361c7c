import numpy as np
import pytest

from sim_backend.mechanisms.motor.motor import OPEN, VOLTAGE
from sim_backend.plant import presets
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.plant import Plant, Truth
from sim_backend.plant.randomness import uniform
from tests.sim_backend.compiled import callable_from_python

NOISY = {"current_sensor": {"present": True, "noise_a": 0.01}, "load": {"mass_kg": 0.1}}


def _after(seed: int, pieces: int) -> tuple[Truth, list[float]]:
    """A run of 12 000 steps, moving and stopping, in so many calls per duty."""
    plant = Plant(PlantParameters.from_dict(NOISY, presets.paper()), seed)
    measured: tuple[float, ...] = ()
    for duty in (0.3, 0.0, -0.3, 0.0):
        for _ in range(pieces):
            measured = plant.advance(VOLTAGE, duty, 3000 // pieces)
    return plant.truth(), list(measured[:3])


def test_same_seed_gives_the_same_bytes_however_steps_are_grouped() -> None:
    once = _after(seed=7, pieces=1)
    assert _after(seed=7, pieces=1) == once
    assert _after(seed=7, pieces=60) == once
    assert _after(seed=7, pieces=3000) == once


def test_another_seed_gives_another_run() -> None:
    assert _after(seed=8, pieces=1) != _after(seed=7, pieces=1)


def test_static_friction_scatters_from_stop_to_stop_as_told() -> None:
    scatter = {"static_fraction": 0.05, "coulomb_fraction": 0.0}
    plant = Plant(PlantParameters.from_dict({"scatter": scatter}, presets.paper()), seed=1)
    factors = []
    for _ in range(400):
        plant.advance(VOLTAGE, 0.1, 300)
        plant.advance(OPEN, 0.0, 5000)
        assert plant.truth().rotor_rad_s == 0.0
        factors.append(float(plant._state["static_factor"][0]))
    assert np.mean(factors) == pytest.approx(1.0, abs=4 * 0.05 / 20.0)
    assert np.std(factors) == pytest.approx(0.05, rel=0.15)
    assert len(set(factors)) > 395  # three standard deviations are the limit


def test_coulomb_friction_wanders_with_the_way_travelled() -> None:
    scatter = {"static_fraction": 0.0, "coulomb_fraction": 0.1, "coulomb_length_rad": 0.5}
    plant = Plant(PlantParameters.from_dict({"scatter": scatter}, presets.paper()), seed=1)
    plant.advance(VOLTAGE, 0.3, 20_000)
    factors, way = [], [plant.truth().rotor_rad]
    for _ in range(20_000):
        plant.advance(VOLTAGE, 0.3, 100)
        factors.append(float(plant._state["coulomb_factor"][0]))
        way.append(plant.truth().rotor_rad)
    assert np.std(factors) == pytest.approx(0.1, rel=0.1)
    # one correlation length on, 1/e of it is left
    lag = round(0.5 / ((way[-1] - way[0]) / 20_000))
    correlation = np.corrcoef(factors[lag:], factors[:-lag])[0, 1]
    assert correlation == pytest.approx(np.exp(-1.0), abs=0.08)


def test_uniform_numbers_are_uniform() -> None:
    draw = callable_from_python(uniform)
    numbers = [draw(np.uint64((key * 0x9E3779B97F4A7C15) % 2**64)) for key in range(1, 20_001)]
    counts, _ = np.histogram(numbers, bins=20, range=(0.0, 1.0))
    chi_squared = float(((counts - 1000.0) ** 2 / 1000.0).sum())
    assert chi_squared < 43.8  # 19 degrees of freedom, 0.1 %
    assert 0.0 < min(numbers) <= max(numbers) <= 1.0
