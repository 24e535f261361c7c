"""Arm and tip load in a vertical plane; angle 0 is vertically down."""

from dataclasses import dataclass
from math import cos, sin

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted

STANDARD_GRAVITY_M_S2 = 9.80665


@dataclass(frozen=True, kw_only=True)
class Arm(Component):
    """The arm without load. A centre of mass at 0 is a counter-balanced arm."""

    length_m: float = quantity("m, axis to load", above=0)
    inertia_kg_m2: float = quantity("kg m2 about the axis", above=0)
    mass_kg: float = quantity("kg", at_least=0, default=0.0)
    centre_of_mass_m: float = quantity("m from the axis", default=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        least_kg_m2 = self.mass_kg * self.centre_of_mass_m**2
        if self.inertia_kg_m2 < least_kg_m2:
            self.refuse(
                "inertia_kg_m2",
                f"a mass of {self.mass_kg:g} kg at {self.centre_of_mass_m:g} m has at least {least_kg_m2:.3g} kg m2 "
                "about the axis (Steiner)",
            )


@dataclass(frozen=True, kw_only=True)
class Load(Component):
    """What is hung on the arm. Balanced: half of it at the tip, half opposite; same weight and inertia, no moment."""

    mass_kg: float = quantity("kg", at_least=0, default=0.0)
    balanced: bool = False


@dataclass(frozen=True, kw_only=True)
class CentreOfMass(Component):
    """The mass does not hang on the line that the joint angle is measured from, but at an angle to it.

    T = -(sum m r) g sin(q + p)
    """

    angle_rad: float = quantity("rad", default=0.0)


@jitted
def gravity_torque(moment_kg_m: float, centre_of_mass: CentreOfMass, angle_rad: float) -> float:
    """Return the torque of gravity on the arm [N m]."""
    return -STANDARD_GRAVITY_M_S2 * moment_kg_m * sin(angle_rad + centre_of_mass.angle_rad)


@jitted
def gravity_energy(moment_kg_m: float, centre_of_mass: CentreOfMass, angle_rad: float) -> float:
    """Return the energy of height [J]; 0 where the centre of mass is lowest."""
    return STANDARD_GRAVITY_M_S2 * moment_kg_m * (1.0 - cos(angle_rad + centre_of_mass.angle_rad))
