"""What resists motion on either side of the gear: every friction mechanism, added up."""

from sim_backend.coulomb_asymmetry import dry_scale
from sim_backend.drag import drag_slope
from sim_backend.friction import dry_friction
from sim_backend.jit import jitted
from sim_backend.load_friction import mesh_loss
from sim_backend.lubricant import viscosity_scale
from sim_backend.parameters import PlantParameters
from sim_backend.periodic_friction import periodic_scale
from sim_backend.state import State
from sim_backend.viscous_asymmetry import viscous_scale


@jitted
def drive_side(parameters: PlantParameters, state: State, weight_n: float) -> tuple[float, float, float]:
    """Return (lower, upper, viscous) of rotor and gear train, at the joint.

    Dry friction may take any value from -lower to upper [N m], whichever keeps the rotor at rest; moving forwards
    it is upper, moving backwards -lower. Viscous is torque over speed [N m s/rad].
    """
    ratio = parameters.gear.ratio
    motor_rad_s = ratio * state.rotor_rad_s
    dry_n_m = dry_friction(parameters.friction, motor_rad_s, weight_n, state.static_factor, state.coulomb_factor)
    dry_n_m *= ratio * periodic_scale(parameters.periodic_friction, state.rotor_rad)
    lower_n_m = dry_n_m * dry_scale(parameters.coulomb_asymmetry, -1.0)
    upper_n_m = dry_n_m * dry_scale(parameters.coulomb_asymmetry, 1.0)
    lower_n_m += mesh_loss(parameters.load_friction, state.contact_n_m, -1.0)
    upper_n_m += mesh_loss(parameters.load_friction, state.contact_n_m, 1.0)
    viscous = parameters.friction.viscous_n_m_s_rad
    viscous *= viscous_scale(parameters.viscous_asymmetry, motor_rad_s)
    viscous *= viscosity_scale(parameters.lubricant, state.housing_c)
    viscous += drag_slope(parameters.drag, motor_rad_s)
    return lower_n_m, upper_n_m, ratio * ratio * viscous


@jitted
def arm_side(parameters: PlantParameters, state: State, weight_n: float) -> tuple[float, float]:
    """Return (dry, viscous) of the arm's bearings: the same either way."""
    friction = parameters.arm_friction
    return dry_friction(friction, state.arm_rad_s, weight_n, 1.0, 1.0), friction.viscous_n_m_s_rad
