"""All that the arm may lean on, added up."""

from sim_backend.environment.end_stops import stop_depth, wall_depth
from sim_backend.environment.obstacle import (
    APART,
    CROSSING,
    RELEASED,
    Push,
    both,
    crossing_push,
    no_push,
    pressed_energy,
    push_of,
    push_torque,
)
from sim_backend.plant.crossing import is_close
from sim_backend.plant.jit import jitted
from sim_backend.plant.parameters import PlantParameters


@jitted
def obstacles_push(parameters: PlantParameters, arm_rad: float, step_s: float) -> Push:
    """Return the push of wall and end stops on the arm over a step, as it stands."""
    if not (parameters.wall.present or parameters.end_stops.present):
        return no_push(APART)
    return both(
        push_of(parameters.wall, wall_depth(parameters.wall, arm_rad), step_s),
        push_of(parameters.end_stops, stop_depth(parameters.end_stops, arm_rad), step_s),
    )


@jitted
def obstacles_tried(
    parameters: PlantParameters, push: Push, arm_rad: float, before_rad: float, way_rad: float, step_s: float
) -> tuple[bool, Push]:
    """Tell whether a motion is what the obstacles allow, and if not, how they push instead.

    Args:
        parameters: of the plant.
        push: with which the motion was found.
        arm_rad: at the start of the step.
        before_rad: way of the motion tried before.
        way_rad: way of the arm over the step.
        step_s: length of the step.
    """
    wall, stops = parameters.wall, parameters.end_stops
    if push.phase == RELEASED or not (wall.present or stops.present):
        return True, push
    end_rad = arm_rad + way_rad
    in_wall, in_stop = wall_depth(wall, arm_rad), stop_depth(stops, arm_rad)
    to_wall, to_stop = wall_depth(wall, end_rad), stop_depth(stops, end_rad)
    crosses = (in_wall == 0.0) != (to_wall == 0.0) or (in_stop == 0.0) != (to_stop == 0.0)
    if crosses and not (push.phase == CROSSING and is_close(way_rad, before_rad)):
        return False, both(
            crossing_push(wall, in_wall, to_wall, way_rad, step_s),
            crossing_push(stops, in_stop, to_stop, way_rad, step_s),
        )
    return push.side == 0.0 or push_torque(push, way_rad / step_s) != 0.0, no_push(RELEASED)


@jitted
def leant_loss(parameters: PlantParameters, arm_rad: float, push: Push, mean_rad_s: float, step_s: float) -> float:
    """Return what wall and stops took [J]: damping while they push; what is left in them when they let go."""
    if push.phase == RELEASED:
        return obstacles_energy(parameters, arm_rad) - obstacles_energy(parameters, arm_rad + step_s * mean_rad_s)
    return step_s * push.damping_n_m_s_rad * mean_rad_s * mean_rad_s


@jitted
def obstacles_energy(parameters: PlantParameters, arm_rad: float) -> float:
    """Return the energy in pressed wall and end stops [J]."""
    return pressed_energy(parameters.wall, wall_depth(parameters.wall, arm_rad)) + pressed_energy(
        parameters.end_stops, stop_depth(parameters.end_stops, arm_rad)
    )
