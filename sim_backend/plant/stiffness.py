"""What is stiff in the plant, and how short a step it asks for."""

from collections.abc import Iterator
from math import sqrt
from typing import NamedTuple

from sim_backend.errors import ParameterError
from sim_backend.plant.parameters import PlantParameters


class Stiff(NamedTuple):
    """A spring that a body swings on.

    Attributes:
        parameter: the name of its stiffness.
        stiffness: its value [N m/rad].
        inertia: of what swings on it, reduced [kg m2].
    """

    parameter: str
    stiffness: float
    inertia: float

    def check(self, step_s: float) -> None:
        """Refuse a step that is too coarse.

        Raises:
            ParameterError: it is.
        """
        fastest_rad_s = sqrt(self.stiffness / self.inertia)
        if step_s * fastest_rad_s > 1.0:
            raise ParameterError(
                f"step = {step_s:g} [s]: too coarse for {self.parameter} = {self.stiffness:g} [N m/rad], which swings "
                f"at {fastest_rad_s:.3g} rad/s; at most {1.0 / fastest_rad_s:.3g} s, or a softer one"
            )


class Quick(NamedTuple):
    """A thermal mass that warms and cools."""

    parameter: str
    capacity_j_k: float
    conductance_w_k: float

    def check(self, step_s: float) -> None:
        """Refuse a step that is too coarse: the temperature would overshoot its surroundings'.

        Raises:
            ParameterError: it is.
        """
        time_s = self.capacity_j_k / self.conductance_w_k
        if step_s > time_s:
            raise ParameterError(
                f"step = {step_s:g} [s]: too coarse for {self.parameter} = {self.capacity_j_k:g} [J/K], which cools "
                f"within {time_s:.3g} s; give it more capacity, or more thermal resistance"
            )


def quickest(parameters: PlantParameters) -> Iterator[Quick]:
    """Yield what is warm in a plant."""
    heat = parameters.heat
    if heat.present:
        through, out = 1.0 / heat.winding_to_housing_k_w, 1.0 / heat.housing_to_ambient_k_w
        yield Quick("heat.winding_j_k", heat.winding_j_k, through)
        yield Quick("heat.housing_j_k", heat.housing_j_k, through + out)


def stiffest(parameters: PlantParameters) -> Iterator[Stiff]:
    """Yield what is stiff in a plant, with the least inertia that swings on it."""
    gear, arm_kg_m2, rotor_kg_m2 = parameters.gear, parameters.arm.inertia_kg_m2, parameters.motor.rotor_inertia_kg_m2
    reduced = 1.0 / (1.0 / (gear.ratio**2 * rotor_kg_m2) + 1.0 / arm_kg_m2)
    softened = parameters.shaft.softening(gear.stiffness_n_m_rad)
    yield Stiff("Gear.stiffness_n_m_rad", gear.stiffness_n_m_rad / softened, reduced)
    yield Stiff("bristle.stiffness_n_m_rad", parameters.bristle.stiffness_n_m_rad, rotor_kg_m2)
    yield Stiff("hose.stiffness_n_m_rad", parameters.hose.stiffness_n_m_rad, arm_kg_m2)
    yield Stiff("arm_bristle.stiffness_n_m_rad", parameters.arm_bristle.stiffness_n_m_rad, arm_kg_m2)
    yield Stiff("spring.stiffness_n_m_rad", parameters.spring.stiffness_n_m_rad, arm_kg_m2)
    cogging = parameters.cogging
    yield Stiff("cogging.amplitude_n_m * cycles_per_turn", cogging.amplitude_n_m * cogging.cycles_per_turn, rotor_kg_m2)
    operator = parameters.operator
    if operator.present:
        lever2_m2 = operator.lever_m**2
        held_kg_m2 = arm_kg_m2 + lever2_m2 * operator.mass_kg
        yield Stiff("operator.stiffness_n_m at the joint", lever2_m2 * operator.stiffness_n_m, held_kg_m2)
    for name, surface in (("wall", parameters.wall), ("end_stops", parameters.end_stops)):
        if surface.present:
            yield Stiff(f"{name}.stiffness_n_m_rad", surface.stiffness_n_m_rad, arm_kg_m2)
