"""Motion of rotor and arm over a step: through the teeth where they touch, each on its own where they do not."""

from typing import NamedTuple

from sim_backend.mechanisms.joint.clutch import carried, slipped
from sim_backend.mechanisms.joint.contact import contact_energy, flank, is_pull, penetration
from sim_backend.plant.crossing import MOST_TRIES, Crossing, closing_line, is_close, one_after_the_other, opening_line
from sim_backend.plant.jit import jitted
from sim_backend.plant.parameters import Constants, PlantParameters
from sim_backend.plant.state import State
from sim_backend.plant.stick_slip import Body, coupled_speeds, free_speeds

_APART, _TOUCHING, _CLOSING, _OPENING = range(4)


class Motion(NamedTuple):
    """What comes of a step.

    Attributes:
        rotor_rad_s: speed at the end.
        arm_rad_s: speed at the end.
        contact_n_m: torque of the teeth on the arm, mean.
        clutch_slips: whether the clutch carries its limit.
        lost_j: what the teeth took; not reckoned where the clutch slips.
    """

    rotor_rad_s: float
    arm_rad_s: float
    contact_n_m: float
    clutch_slips: bool
    lost_j: float


class Teeth(NamedTuple):
    """How the teeth push over a step: known + rate * (rotor's - arm's new speed).

    Attributes:
        phase: apart, touching, or closing or opening within the step.
        side: the flank, as of `contact.flank`.
        known_n_m: torque at equal new speeds.
        rate_n_m_s_rad: growth with their difference.
        share: part of the step for which they touch.
    """

    phase: int
    side: float
    known_n_m: float
    rate_n_m_s_rad: float
    share: float


@jitted
def move(
    parameters: PlantParameters, constants: Constants, state: State, rotor: Body, arm: Body, step_s: float
) -> Motion:
    """Return the motion over a step. Teeth that let go or close within it are met by trying again."""
    slip_rad_s = state.rotor_rad_s - state.arm_rad_s
    teeth = _at_start(parameters, constants, state, step_s)
    rotor_rad_s, arm_rad_s, contact_n_m, way_rad = 0.0, 0.0, 0.0, 0.0
    for _ in range(MOST_TRIES):
        rotor_rad_s, arm_rad_s = _speeds(state, teeth, rotor, arm, step_s)
        contact_n_m = teeth.known_n_m + teeth.rate_n_m_s_rad * (rotor_rad_s - arm_rad_s)
        before_rad, way_rad = way_rad, 0.5 * step_s * (slip_rad_s + rotor_rad_s - arm_rad_s)
        settled, better = _tried(parameters, constants, state, teeth, contact_n_m, before_rad, way_rad, step_s)
        if settled:
            break
        teeth = better
    carried_n_m = carried(parameters.clutch, contact_n_m)
    if carried_n_m != contact_n_m:
        rotor_rad_s, arm_rad_s = free_speeds(_pushed(rotor, -step_s * carried_n_m), _pushed(arm, step_s * carried_n_m))
        return Motion(rotor_rad_s, arm_rad_s, carried_n_m, True, 0.0)
    return Motion(
        rotor_rad_s, arm_rad_s, contact_n_m, False, _lost(parameters, constants, state, teeth, way_rad, step_s)
    )


@jitted
def _at_start(parameters: PlantParameters, constants: Constants, state: State, step_s: float) -> Teeth:
    """Return how the teeth push as they stand: spring and damper at mid-step, where they touch."""
    twist_rad = _twist(state)
    side = flank(parameters.gear, twist_rad)
    if side == 0.0:
        return Teeth(_APART, 0.0, 0.0, 0.0, 0.0)
    rigidity = constants.teeth_n_m_rad
    rate = 0.25 * step_s * rigidity + 0.5 * constants.teeth_n_m_s_rad
    slip_rad_s = state.rotor_rad_s - state.arm_rad_s
    known_n_m = rigidity * penetration(parameters.gear, side, twist_rad) + rate * slip_rad_s
    return Teeth(_TOUCHING, side, known_n_m, rate, 1.0)


@jitted
def _speeds(state: State, teeth: Teeth, rotor: Body, arm: Body, step_s: float) -> tuple[float, float]:
    """Return the speeds (rotor, arm) at the end of the step, the teeth pushing so."""
    if teeth.phase == _APART:
        return free_speeds(rotor, arm)
    return coupled_speeds(
        rotor, arm, step_s * teeth.rate_n_m_s_rad, step_s * teeth.known_n_m, state.rotor_rad_s, state.arm_rad_s
    )


@jitted
def _tried(
    parameters: PlantParameters, constants: Constants, state: State, teeth: Teeth, contact_n_m: float,
    before_rad: float, way_rad: float, step_s: float,
) -> tuple[bool, Teeth]:  # fmt: skip
    """Tell whether a motion is what the teeth allow, and if not, how they push instead."""
    gear, rigidity, damping = parameters.gear, constants.teeth_n_m_rad, constants.teeth_n_m_s_rad
    start_rad, end_rad = _twist(state), _twist(state) + way_rad
    touched = flank(gear, end_rad)
    if teeth.side != 0.0 and teeth.phase == _APART:
        # let go; on their way they may meet the other flank, and close on that
        if touched != -teeth.side:
            return True, teeth
    elif teeth.side != 0.0:
        if carried(parameters.clutch, contact_n_m) != contact_n_m:
            return True, teeth
        opens = gear.backlash_rad > 0.0 and penetration(gear, teeth.side, end_rad) * teeth.side < 0.0
        through = opens and touched != 0.0  # all the free play in one step
        if not opens or (teeth.phase == _OPENING and is_close(way_rad, before_rad)):
            # where they would pull they part for this step; the side stays, so that they do not close again
            return through or not is_pull(gear, teeth.side, contact_n_m), Teeth(_APART, teeth.side, 0.0, 0.0, 0.0)
        pressed_rad = penetration(gear, teeth.side, start_rad)
        line = opening_line(rigidity, damping, pressed_rad, way_rad, step_s)
        if through:
            met_rad = penetration(gear, -teeth.side, end_rad)
            line = one_after_the_other(line, closing_line(rigidity, damping, met_rad, way_rad, step_s))
        return False, _crossing(state, _OPENING, teeth.side, line, step_s)
    if touched == 0.0 or (teeth.phase == _CLOSING and is_close(way_rad, before_rad)):
        return True, teeth
    line = closing_line(rigidity, damping, penetration(gear, touched, end_rad), way_rad, step_s)
    return False, _crossing(state, _CLOSING, 0.0, line, step_s)


@jitted
def _crossing(state: State, phase: int, side: float, line: Crossing, step_s: float) -> Teeth:
    """Return how teeth push that close or open within the step: from the way to the new speeds."""
    rate = 0.5 * step_s * line.slope_n_m_rad
    known_n_m = line.known_n_m + rate * (state.rotor_rad_s - state.arm_rad_s)
    return Teeth(phase, side, known_n_m, rate, line.share)


@jitted
def _lost(
    parameters: PlantParameters, constants: Constants, state: State, teeth: Teeth, way_rad: float, step_s: float
) -> float:
    """Return what the teeth took [J]: damping while they push; what is left in the spring when they let go."""
    gear, rigidity, twist_rad = parameters.gear, constants.teeth_n_m_rad, _twist(state)
    if teeth.phase != _APART:
        damped_j = teeth.share * constants.teeth_n_m_s_rad * way_rad * way_rad / step_s
        return damped_j + contact_energy(gear, rigidity, twist_rad) if teeth.phase == _CLOSING else damped_j
    if teeth.side == 0.0:
        return 0.0
    return contact_energy(gear, rigidity, twist_rad) - contact_energy(gear, rigidity, twist_rad + way_rad)


@jitted
def slip_clutch(
    parameters: PlantParameters, constants: Constants, state: State, contact_n_m: float, slip_rad_s: float,
    step_s: float,
) -> float:  # fmt: skip
    """Move the clutch on to where the teeth carry its limit; return what teeth and clutch took [J]."""
    gear, rigidity = parameters.gear, constants.teeth_n_m_rad
    apart_rad = state.rotor_rad - state.arm_rad
    before_j = contact_energy(gear, rigidity, apart_rad - state.clutch_rad)
    apart_rad += step_s * slip_rad_s
    state.clutch_rad = slipped(gear, rigidity, contact_n_m, apart_rad)
    return step_s * contact_n_m * slip_rad_s + before_j - contact_energy(gear, rigidity, apart_rad - state.clutch_rad)


@jitted
def _twist(state: State) -> float:
    return state.rotor_rad - state.arm_rad - state.clutch_rad


@jitted
def _pushed(body: Body, impulse: float) -> Body:
    return Body(body.diagonal, body.impulse + impulse, body.lower, body.upper, body.viscous)
