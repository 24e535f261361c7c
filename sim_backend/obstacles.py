"""All that the arm may lean on, added up."""

from sim_backend.end_stops import stop_depth
from sim_backend.jit import jitted
from sim_backend.obstacle import Push, both, pressed_energy, push_of
from sim_backend.parameters import PlantParameters
from sim_backend.wall import wall_depth


@jitted
def obstacles_push(parameters: PlantParameters, arm_rad: float, step_s: float) -> Push:
    """Return the push of wall and end stops on the arm over a step."""
    return both(
        push_of(parameters.wall, wall_depth(parameters.wall, arm_rad), step_s),
        push_of(parameters.end_stops, stop_depth(parameters.end_stops, arm_rad), step_s),
    )


@jitted
def obstacles_energy(parameters: PlantParameters, arm_rad: float) -> float:
    """Return the energy in pressed wall and end stops [J]."""
    return pressed_energy(parameters.wall, wall_depth(parameters.wall, arm_rad)) + pressed_energy(
        parameters.end_stops, stop_depth(parameters.end_stops, arm_rad)
    )
