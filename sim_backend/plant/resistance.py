"""What resists motion on either side of the gear: every friction mechanism, added up."""

from typing import NamedTuple

from sim_backend.mechanisms.friction.bristle import BristleLine, bristle_line, is_slipping
from sim_backend.mechanisms.friction.coulomb_asymmetry import dry_scale
from sim_backend.mechanisms.friction.drag import drag_slope
from sim_backend.mechanisms.friction.dwell import rest_scale
from sim_backend.mechanisms.friction.friction import dry_friction
from sim_backend.mechanisms.friction.friction_jump import jump_scale
from sim_backend.mechanisms.friction.load_friction import mesh_loss
from sim_backend.mechanisms.friction.lubricant import viscosity_scale
from sim_backend.mechanisms.friction.periodic_friction import periodic_scale
from sim_backend.mechanisms.friction.run_in import run_in_scale
from sim_backend.mechanisms.friction.viscous_asymmetry import viscous_scale
from sim_backend.plant.jit import jitted
from sim_backend.plant.parameters import PlantParameters
from sim_backend.plant.state import State


class Resistance(NamedTuple):
    """Friction of one side over a step, at the joint.

    Attributes:
        lower_n_m: dry friction may take any value from -lower to upper, whichever keeps the side at rest; moving
            backwards it is -lower. 0 where bristles carry it.
        upper_n_m: moving forwards it is upper.
        viscous_n_m_s_rad: torque over speed.
        bristle: what bristles do in place of the dry friction, where they are present.
    """

    lower_n_m: float
    upper_n_m: float
    viscous_n_m_s_rad: float
    bristle: BristleLine


@jitted
def drive_side(parameters: PlantParameters, state: State, weight_n: float, step_s: float) -> Resistance:
    """Return the resistance of rotor and gear train."""
    ratio, bristle, friction = parameters.gear.ratio, parameters.bristle, parameters.friction
    speed_rad_s = ratio * _speed(bristle.stiffness_n_m_rad, state.rotor_rad_s, state.rotor_mean_rad_s)
    static_factor = state.static_factor * rest_scale(parameters.dwell, state.rest_s)
    dry_n_m = dry_friction(friction, speed_rad_s, weight_n, static_factor, state.coulomb_factor)
    dry_n_m *= ratio * periodic_scale(parameters.periodic_friction, state.rotor_rad)
    dry_n_m *= run_in_scale(parameters.run_in, state.travelled_rad)
    dry_n_m *= jump_scale(parameters.friction_jump, state)
    lower_n_m = dry_n_m * dry_scale(parameters.coulomb_asymmetry, -1.0)
    upper_n_m = dry_n_m * dry_scale(parameters.coulomb_asymmetry, 1.0)
    lower_n_m += mesh_loss(parameters.load_friction, state.contact_n_m, -1.0)
    upper_n_m += mesh_loss(parameters.load_friction, state.contact_n_m, 1.0)
    viscous = friction.viscous_n_m_s_rad
    viscous *= viscous_scale(parameters.viscous_asymmetry, speed_rad_s)
    viscous *= viscosity_scale(parameters.lubricant, state.housing_c)
    viscous += drag_slope(parameters.drag, speed_rad_s)
    viscous *= ratio * ratio
    limit_n_m = (upper_n_m if speed_rad_s > 0.0 else lower_n_m) / ratio
    line = bristle_line(bristle, friction, ratio, state.bristle_rad, speed_rad_s, limit_n_m, step_s)
    if bristle.stiffness_n_m_rad == 0.0:
        return Resistance(lower_n_m, upper_n_m, viscous, line)
    if is_slipping(bristle, state.bristle_rad, speed_rad_s, limit_n_m):
        state.slid = True
    return Resistance(0.0, 0.0, viscous, line)


@jitted
def arm_side(parameters: PlantParameters, state: State, weight_n: float, step_s: float) -> Resistance:
    """Return the resistance of the arm's bearings: the same either way."""
    friction, bristle = parameters.arm_friction, parameters.arm_bristle
    speed_rad_s = _speed(bristle.stiffness_n_m_rad, state.arm_rad_s, state.arm_mean_rad_s)
    static_factor = rest_scale(parameters.arm_dwell, state.arm_rest_s)
    dry_n_m = dry_friction(friction, speed_rad_s, weight_n, static_factor, 1.0)
    line = bristle_line(bristle, friction, 1.0, state.arm_bristle_rad, speed_rad_s, dry_n_m, step_s)
    if bristle.stiffness_n_m_rad > 0.0:
        dry_n_m = 0.0
    return Resistance(dry_n_m, dry_n_m, friction.viscous_n_m_s_rad, line)


@jitted
def _speed(stiffness: float, now_rad_s: float, mean_rad_s: float) -> float:
    """Return the speed to ask friction at: now for rigid stick, which has to see rest; else the guess for mid-step."""
    return now_rad_s if stiffness == 0.0 else 2.0 * now_rad_s - mean_rad_s
