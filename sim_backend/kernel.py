"""The integrator: all mechanisms together, one small step after the other, compiled.

Each step is an implicit midpoint rule in the speeds: positions move with the mean of old and new speed, linear
torques (teeth, viscous friction, back-EMF) act on that mean, dry friction is set-valued (`stick_slip`), torques of
position (gravity, spring) are taken half a step ahead. So every torque does exactly the work that the kinetic energy
gains, stiff teeth never blow up, and smooth motion is second order in the step.
"""

import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sim_backend.contact import contact_energy, flank, is_pull, penetration
from sim_backend.gravity import (
    STANDARD_GRAVITY_M_S2,
    arm_inertia,
    gravity_energy,
    gravity_torque,
    moment_kg_m,
)
from sim_backend.heat import warm
from sim_backend.jit import jitted, jitted_and_cached
from sim_backend.motor import OPEN, Motor, current_line
from sim_backend.parameters import PlantParameters
from sim_backend.randomness import draw_static_factor, wander
from sim_backend.record import Records
from sim_backend.resistance import arm_side, drive_side
from sim_backend.sensing import counts, measured_current, radians_per_count
from sim_backend.spring import spring_energy, spring_torque
from sim_backend.state import State
from sim_backend.stick_slip import solve

Floats = NDArray[np.float64]
# places in the measurement that the kernel hands out
POSITION, VELOCITY, CURRENT, TEMPERATURE = range(4)


@jitted
def _step(parameters: PlantParameters, state: State, stage: int, demand: float, step_s: float) -> None:
    """Advance the state by one step."""
    gear = parameters.gear
    rotor_rad_s, arm_rad_s = state.rotor_rad_s, state.arm_rad_s
    slip_rad_s = rotor_rad_s - arm_rad_s
    rotor_kg_m2 = gear.ratio**2 * parameters.motor.rotor_inertia_kg_m2
    arm_kg_m2 = arm_inertia(parameters.arm, parameters.load)
    weight_n = STANDARD_GRAVITY_M_S2 * parameters.load.mass_kg

    # motor: constant current less what the back-EMF takes, which acts as viscous friction
    strength = gear.ratio * parameters.motor.torque_constant_n_m_a
    current_0, current_slope = current_line(
        stage,
        demand,
        state.current_a,
        gear.ratio * rotor_rad_s,
        parameters.motor,
        parameters.supply,
        parameters.current_loop,
        step_s,
    )
    emf_damping = strength * gear.ratio * current_slope

    # friction of both sides
    lower_r, upper_r, viscous_r = drive_side(parameters, state, weight_n)
    dry_a, viscous_a = arm_side(parameters, state, weight_n)
    damping_r = viscous_r + emf_damping

    # what pulls at the arm, half a step ahead
    middle_rad = state.arm_rad + 0.5 * step_s * arm_rad_s
    moment = moment_kg_m(parameters.arm, parameters.load)
    external_n_m = gravity_torque(moment, parameters.centre_of_mass, middle_rad) + spring_torque(
        parameters.spring, middle_rad
    )

    # impulses without friction and teeth
    free_r = rotor_kg_m2 * rotor_rad_s + step_s * (strength * current_0 - 0.5 * damping_r * rotor_rad_s)
    free_a = arm_kg_m2 * arm_rad_s + step_s * (external_n_m - 0.5 * viscous_a * arm_rad_s)
    diagonal_r = rotor_kg_m2 + 0.5 * step_s * damping_r
    diagonal_a = arm_kg_m2 + 0.5 * step_s * viscous_a

    # teeth: a spring and a damper at mid-step, where they touch and push
    twist_rad = state.rotor_rad - state.arm_rad
    side = flank(gear, twist_rad)
    rate, contact_0, contact_n_m = 0.0, 0.0, 0.0
    if side != 0.0:
        rate = 0.25 * step_s * gear.stiffness_n_m_rad + 0.5 * gear.damping_n_m_s_rad
        contact_0 = gear.stiffness_n_m_rad * penetration(gear, side, twist_rad) + rate * slip_rad_s
    new_r, new_a = solve(
        diagonal_r + step_s * rate, diagonal_a + step_s * rate, step_s * rate,
        free_r - step_s * contact_0, free_a + step_s * contact_0,
        step_s * lower_r, step_s * upper_r, step_s * dry_a, step_s * dry_a, arm_rad_s,
    )  # fmt: skip
    if side != 0.0:
        contact_n_m = contact_0 + rate * (new_r - new_a)
        if is_pull(gear, side, contact_n_m):
            contact_n_m = 0.0
            new_r, new_a = solve(
                diagonal_r, diagonal_a, 0.0, free_r, free_a,
                step_s * lower_r, step_s * upper_r, step_s * dry_a, step_s * dry_a, arm_rad_s,
            )  # fmt: skip

    # move
    mean_r, mean_a = 0.5 * (rotor_rad_s + new_r), 0.5 * (arm_rad_s + new_a)
    pressed_j = contact_energy(gear, twist_rad)
    state.rotor_rad += step_s * mean_r
    state.arm_rad += step_s * mean_a
    state.rotor_rad_s = new_r
    state.arm_rad_s = new_a
    state.contact_n_m = contact_n_m
    current_a = current_0 - current_slope * gear.ratio * mean_r

    # where the energy went
    supplied_j, electrical_j = _electrical_energy(
        parameters.motor, stage, state.current_a, current_a, gear.ratio * mean_r, step_s
    )
    impulse_r = free_r - step_s * contact_n_m - diagonal_r * new_r
    impulse_a = free_a + step_s * contact_n_m - diagonal_a * new_a
    friction_j = impulse_r * mean_r + step_s * viscous_r * mean_r * mean_r
    state.supplied_j += supplied_j
    state.electrical_loss_j += electrical_j
    state.friction_loss_j += friction_j
    state.arm_friction_loss_j += impulse_a * mean_a + step_s * viscous_a * mean_a * mean_a
    if contact_n_m != 0.0:
        state.contact_loss_j += step_s * gear.damping_n_m_s_rad * (mean_r - mean_a) ** 2
    elif side != 0.0:
        # teeth that let go relax by themselves
        state.contact_loss_j += pressed_j - contact_energy(gear, state.rotor_rad - state.arm_rad)
    state.current_a = current_a

    # what friction and temperature remember
    if new_r == 0.0 and rotor_rad_s != 0.0:
        state.static_factor = draw_static_factor(state, parameters.scatter)
    wander(state, parameters.scatter, abs(step_s * mean_r))
    if parameters.heat.present:
        warm(state, parameters.heat, electrical_j, friction_j, step_s)
    state.steps += 1


@jitted
def _electrical_energy(
    motor: Motor, stage: int, before_a: float, current_a: float, motor_rad_s: float, step_s: float
) -> tuple[float, float]:
    """Return (drawn from the supply, lost in the winding) over a step [J]."""
    if stage == OPEN:
        return 0.0, 0.5 * motor.inductance_h * before_a**2
    change_a = current_a - before_a
    voltage_v = (
        motor.resistance_ohm * current_a
        + motor.torque_constant_n_m_a * motor_rad_s
        + motor.inductance_h * change_a / step_s
    )
    # backward Euler in the inductance takes a little energy with it
    lost_j = motor.resistance_ohm * current_a**2 * step_s + 0.5 * motor.inductance_h * change_a**2
    return voltage_v * current_a * step_s, lost_j


def _advance_of(mechanisms: int) -> Callable[..., None]:
    def advance(
        parameters: Records, states: Records, history: Floats, measured: Floats,
        stage: int, demand: float, steps: int, step_s: float, window: int, delay: int,
    ) -> None:  # fmt: skip
        """Advance the plant at a constant demand, then measure.

        Args:
            parameters: `record.pack(PlantParameters)`, shape (1,).
            states: `record.pack(state.State)`, shape (1,); advanced in place.
            history: last counts and currents, shape (n, 2), n > window + delay; a ring, advanced in place.
            measured: filled with position [rad], velocity [rad/s], current [A], temperature [degC], shape (4,).
            stage: state of the power stage, see motor.py.
            demand: duty or current [A], after the stage.
            steps: number of steps.
            step_s: length of a step [s].
            window: steps over which the drive measures speed.
            delay: steps by which all measurement is late.
        """
        mechanisms  # noqa: B018  (part of the cache's key, see below)
        plant, state = parameters[0], states[0]
        ratio, length = plant.gear.ratio, len(history)
        for _ in range(steps):
            _step(plant, state, stage, demand, step_s)
            place = state.steps % length
            history[place, 0] = counts(plant.encoder, ratio, state.rotor_rad)
            history[place, 1] = state.current_a
        seen = (state.steps - delay) % length
        gained = history[seen, 0] - history[(state.steps - delay - window) % length, 0]
        unit_rad = radians_per_count(plant.encoder, ratio)
        measured[POSITION] = history[seen, 0] * unit_rad
        measured[VELOCITY] = gained * unit_rad / (window * step_s)
        measured[CURRENT] = measured_current(state, plant.current_sensor, history[seen, 1])
        measured[TEMPERATURE] = state.housing_c if plant.heat.present else np.nan

    return jitted_and_cached(advance)


def _fingerprint() -> int:
    """Return a number that changes with any source file of this package."""
    digest = 0
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest = zlib.crc32(path.read_bytes(), digest)
    return digest


# numba's cache knows when this file changes, not when a mechanism that it calls does;
# the value of a closure variable is part of the cache's key
advance = _advance_of(_fingerprint())


@jitted_and_cached
def stored_energy(parameters: Records, states: Records) -> float:
    """Return kinetic, height, spring, tooth and inductor energy [J]."""
    plant, state = parameters[0], states[0]
    rotor_kg_m2: float = plant.gear.ratio**2 * plant.motor.rotor_inertia_kg_m2
    energy_j: float = (
        0.5 * rotor_kg_m2 * state.rotor_rad_s**2
        + 0.5 * arm_inertia(plant.arm, plant.load) * state.arm_rad_s**2
        + gravity_energy(moment_kg_m(plant.arm, plant.load), plant.centre_of_mass, state.arm_rad)
        + spring_energy(plant.spring, state.arm_rad)
        + contact_energy(plant.gear, state.rotor_rad - state.arm_rad)
        + 0.5 * plant.motor.inductance_h * state.current_a**2
    )
    return energy_j
