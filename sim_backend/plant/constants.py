"""What follows from the parameters alone, worked out once instead of in every step."""

from dataclasses import dataclass

from sim_backend.mechanisms.joint.gravity import STANDARD_GRAVITY_M_S2
from sim_backend.plant.parameters import PlantParameters


@dataclass(frozen=True, kw_only=True)
class Constants:
    """Derived quantities of a plant, at the joint.

    Attributes:
        weight_n: hung on the axis.
        moment_kg_m: sum of mass times lever of arm and load.
        arm_kg_m2: inertia of arm and load.
        rotor_kg_m2: inertia of the rotor.
        teeth_n_m_rad: stiffness of teeth and shaft in series.
        teeth_n_m_s_rad: their damping.
    """

    weight_n: float
    moment_kg_m: float
    arm_kg_m2: float
    rotor_kg_m2: float
    teeth_n_m_rad: float
    teeth_n_m_s_rad: float


def constants_of(parameters: PlantParameters) -> Constants:
    """Return what follows from a plant's parameters."""
    arm, load, gear = parameters.arm, parameters.load, parameters.gear
    hung_kg_m = 0.0 if load.balanced else load.mass_kg * arm.length_m
    softening = parameters.shaft.softening(gear.stiffness_n_m_rad)
    return Constants(
        weight_n=STANDARD_GRAVITY_M_S2 * load.mass_kg,
        moment_kg_m=hung_kg_m + arm.mass_kg * arm.centre_of_mass_m,
        arm_kg_m2=arm.inertia_kg_m2 + load.mass_kg * arm.length_m**2,
        rotor_kg_m2=gear.ratio * gear.ratio * parameters.motor.rotor_inertia_kg_m2,
        teeth_n_m_rad=gear.stiffness_n_m_rad / softening,
        teeth_n_m_s_rad=gear.damping_n_m_s_rad / softening,
    )
