"""The compiled loop: steps, what the drive sees of them, and the energy in the plant."""

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sim_backend.environment.obstacles import obstacles_energy
from sim_backend.mechanisms.friction.bristle import bristle_energy
from sim_backend.mechanisms.friction.hose import Bend, hose_energy
from sim_backend.mechanisms.joint.contact import contact_energy
from sim_backend.mechanisms.joint.gravity import gravity_energy
from sim_backend.mechanisms.joint.sensing import counts, radians_per_count
from sim_backend.mechanisms.joint.spring import spring_energy
from sim_backend.mechanisms.motor.cogging import cogging_energy
from sim_backend.mechanisms.motor.current_sensor import measured_current
from sim_backend.plant.jit import Records, jitted, jitted_and_cached
from sim_backend.plant.parameters import Constants, PlantParameters
from sim_backend.plant.state import State
from sim_backend.plant.step import step

Floats = NDArray[np.float64]
Measured = tuple[float, float, float, float, float]
"""Position [rad], velocity [rad/s], current [A], temperature [degC], supply [V]."""


@dataclass(frozen=True)
class Whole:
    """A plant as one record: numba takes 0.6 us to look at each record that it is handed."""

    parameters: PlantParameters
    constants: Constants
    state: State


@jitted
def _cycle(
    whole: Whole, history: Floats, stage: int, demand: float, steps: int, step_s: float, window: int, delay: int,
) -> Measured:  # fmt: skip
    """Advance by some steps at one demand, then measure; arguments as of `advance`."""
    plant, constants, state = whole.parameters, whole.constants, whole.state
    ratio, length = plant.gear.ratio, len(history)
    place = int(state.steps % length)
    for _ in range(steps):
        step(plant, constants, state, stage, demand, step_s)
        place = place + 1 if place + 1 < length else 0
        history[place, 0] = state.rotor_rad
        history[place, 1] = state.current_a
    seen, before = (place - delay) % length, (place - delay - window) % length
    unit_rad = radians_per_count(plant.encoder, ratio)
    now_counts = counts(plant.encoder, plant.eccentricity, ratio, history[seen, 0])
    gained = now_counts - counts(plant.encoder, plant.eccentricity, ratio, history[before, 0])
    return (
        now_counts * unit_rad,
        gained * unit_rad / (window * step_s),
        measured_current(state, plant.current_sensor, history[seen, 1]),
        state.housing_c if plant.heat.present else np.nan,
        state.supply_v,
    )


def _advance_of(mechanisms: int) -> Callable[..., Measured]:
    def advance(
        plants: Records, history: Floats, stage: int, demand: float, steps: int,
        step_s: float, window: int, delay: int,
    ) -> Measured:  # fmt: skip
        """Advance the plant at one demand, and measure.

        Args:
            plants: `record.pack(Whole)`, shape (1,); its state is advanced in place.
            history: last rotor angles and currents, shape (n, 2), n > window + delay; a ring, advanced in place.
            stage: state of the power stage, see motor.py.
            demand: duty or current [A], after the stage.
            steps: number of steps.
            step_s: length of a step [s].
            window: steps over which the drive measures speed.
            delay: steps by which all measurement is late.
        """
        mechanisms  # noqa: B018  (part of the cache's key, see below)
        return _cycle(plants[0], history, stage, demand, steps, step_s, window, delay)

    return jitted_and_cached(advance)


def _fingerprint() -> int:
    """Return a number that changes with any source file of the simulation."""
    digest = 0
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        digest = zlib.crc32(path.read_bytes(), digest)
    return digest


# numba's cache knows when this file changes, not when a mechanism that it calls does;
# the value of a closure variable is part of the cache's key
_MECHANISMS = _fingerprint()
advance = _advance_of(_MECHANISMS)


def _stored_energy_of(mechanisms: int) -> Callable[[Records], float]:
    def stored_energy(plants: Records) -> float:
        """Return kinetic, height, spring, tooth, wall, magnet, bristle and inductor energy [J]."""
        mechanisms  # noqa: B018
        plant, constants, state = plants[0].parameters, plants[0].constants, plants[0].state
        twist_rad: float = state.rotor_rad - state.arm_rad - state.clutch_rad
        energy_j: float = (
            0.5 * constants.rotor_kg_m2 * state.rotor_rad_s**2
            + 0.5 * constants.arm_kg_m2 * state.arm_rad_s**2
            + gravity_energy(constants.moment_kg_m, plant.centre_of_mass, state.arm_rad)
            + spring_energy(plant.spring, state.arm_rad)
            + contact_energy(plant.gear, constants.teeth_n_m_rad, twist_rad)
            + obstacles_energy(plant, state.arm_rad)
            + cogging_energy(plant.cogging, plant.gear.ratio * state.rotor_rad)
            + bristle_energy(plant.bristle, state.bristle_rad)
            + bristle_energy(plant.arm_bristle, state.arm_bristle_rad)
            + hose_energy(plant.hose, Bend(state.hose_first_rad, state.hose_second_rad, state.hose_third_rad))
            + 0.5 * plant.motor.inductance_h * state.current_a**2
        )
        return energy_j

    return jitted_and_cached(stored_energy)


stored_energy = _stored_energy_of(_MECHANISMS)
