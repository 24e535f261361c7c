"""One integration step: every mechanism asked once, then both bodies moved.

An implicit midpoint rule in the speeds: positions move with the mean of old and new speed, linear torques (teeth,
viscous friction, back-EMF) act on that mean, dry friction is set-valued (`stick_slip`), torques of position (gravity,
spring) are taken half a step ahead. So every torque does exactly the work that the kinetic energy gains, stiff teeth
never blow up, and smooth motion is second order in the step.
"""

from sim_backend.environment.obstacle import Push, push_torque
from sim_backend.environment.obstacles import leant_loss, obstacles_push, obstacles_tried
from sim_backend.environment.operator import Hold, hand_torque, hold_of
from sim_backend.mechanisms.friction.bristle import bend
from sim_backend.mechanisms.friction.dwell import aged
from sim_backend.mechanisms.friction.friction_jump import flip
from sim_backend.mechanisms.friction.hose import Bend, bent, hose_energy, hose_torque
from sim_backend.mechanisms.friction.scatter import draw_static_factor, wander
from sim_backend.mechanisms.joint.gravity import gravity_torque
from sim_backend.mechanisms.joint.spring import spring_torque
from sim_backend.mechanisms.motor.cogging import cogging_torque
from sim_backend.mechanisms.motor.heat import warm
from sim_backend.mechanisms.motor.motor import CurrentLine, current_line, stage_loss, supply_voltage, winding_energy
from sim_backend.mechanisms.motor.supply_ripple import ripple_scale, turned
from sim_backend.mechanisms.motor.thermal_drift import Winding, drifted
from sim_backend.plant.crossing import MOST_TRIES
from sim_backend.plant.jit import jitted
from sim_backend.plant.parameters import Constants, PlantParameters
from sim_backend.plant.resistance import Resistance, arm_side, drive_side
from sim_backend.plant.state import State
from sim_backend.plant.stick_slip import Body
from sim_backend.plant.transmission import Motion, move, slip_clutch


@jitted
def step(
    parameters: PlantParameters, constants: Constants, state: State, stage: int, demand: float, step_s: float
) -> None:
    """Advance the state by one step at a constant demand (duty or current [A], after the stage)."""
    ratio = parameters.gear.ratio
    winding = _winding(parameters, state)
    supply_v = parameters.supply.voltage_v * ripple_scale(parameters.supply_ripple, state.ripple_turns)
    line = current_line(
        stage, demand, state.current_a, ratio * state.rotor_rad_s, winding, supply_v, parameters, step_s
    )
    drive_friction = drive_side(parameters, state, constants.weight_n, step_s)
    arm_friction = arm_side(parameters, state, constants.weight_n, step_s)
    rotor = _rotor(parameters, constants, state, winding, line, drive_friction, step_s)
    time_s = state.origin_s + (state.steps - state.origin_steps) * step_s
    guess_rad_s = 2.0 * state.arm_rad_s - state.arm_mean_rad_s
    hold = hold_of(parameters.operator, time_s, state.arm_rad, guess_rad_s, step_s)
    arm = _held(_arm(parameters, constants, state, arm_friction, step_s), hold, state.arm_rad_s, step_s)
    push = obstacles_push(parameters, state.arm_rad, step_s)
    leaning, way_rad = arm, 0.0
    motion = Motion(0.0, 0.0, 0.0, False, 0.0)
    for _ in range(MOST_TRIES):
        leaning = _leaning(arm, push, state.arm_rad_s, step_s)
        motion = move(parameters, constants, state, rotor, leaning, step_s)
        before_rad, way_rad = way_rad, 0.5 * step_s * (state.arm_rad_s + motion.arm_rad_s)
        settled, better = obstacles_tried(parameters, push, state.arm_rad, before_rad, way_rad, step_s)
        if settled:
            break
        push = better
    mean_r = 0.5 * (state.rotor_rad_s + motion.rotor_rad_s)
    mean_a = 0.5 * (state.arm_rad_s + motion.arm_rad_s)
    current_a = line.constant_a - line.slope_a_s_rad * ratio * mean_r

    # where the energy went
    taken_j, copper_j = winding_energy(
        stage, state.current_a, current_a, ratio * mean_r, winding, parameters.motor.inductance_h, step_s
    )
    stage_j = stage_loss(line, current_a, parameters.supply, step_s)
    state.bristle_rad, friction_j = bend(parameters.bristle, drive_friction.bristle, state.bristle_rad, mean_r, step_s)
    state.arm_bristle_rad, arm_friction_j = bend(
        parameters.arm_bristle, arm_friction.bristle, state.arm_bristle_rad, mean_a, step_s
    )
    friction_j += _friction_loss(rotor, -motion.contact_n_m, motion.rotor_rad_s, mean_r, step_s)
    arm_friction_j += _friction_loss(leaning, motion.contact_n_m, motion.arm_rad_s, mean_a, step_s)
    hand_n_m = hand_torque(hold, state.arm_rad_s, motion.arm_rad_s, step_s)
    state.supplied_j += taken_j + stage_j + step_s * hand_n_m * mean_a
    state.electrical_loss_j += copper_j + stage_j
    state.friction_loss_j += friction_j
    state.arm_friction_loss_j += arm_friction_j + _drag_hose(parameters, state, mean_a, step_s)
    if motion.clutch_slips:
        state.contact_loss_j += slip_clutch(parameters, constants, state, motion.contact_n_m, mean_r - mean_a, step_s)
    state.contact_loss_j += motion.lost_j
    state.leant_loss_j += leant_loss(parameters, state.arm_rad, push, mean_a, step_s)

    # what friction and temperature remember
    if _stops(state, motion.rotor_rad_s, mean_r):
        state.static_factor = draw_static_factor(state, parameters.scatter)
    state.rest_s = aged(parameters.dwell, state.rest_s, ratio * mean_r, step_s)
    state.arm_rest_s = aged(parameters.arm_dwell, state.arm_rest_s, mean_a, step_s)
    state.travelled_rad += step_s * ratio * abs(mean_r)
    wander(state, parameters.scatter, abs(step_s * mean_r))
    flip(parameters.friction_jump, state, step_s)
    state.ripple_turns = turned(parameters.supply_ripple, state.ripple_turns, step_s)
    if parameters.heat.present:
        warm(state, parameters.heat, copper_j, friction_j, step_s)

    state.rotor_rad += step_s * mean_r
    state.arm_rad += step_s * mean_a
    state.rotor_mean_rad_s = mean_r
    state.arm_mean_rad_s = mean_a
    state.rotor_rad_s = motion.rotor_rad_s
    state.arm_rad_s = motion.arm_rad_s
    state.contact_n_m = motion.contact_n_m
    state.leant_n_m = push_torque(push, mean_a)
    state.hand_n_m = hand_n_m
    state.current_a = current_a
    state.supply_v = supply_voltage(line, current_a, parameters.supply)
    state.steps += 1


@jitted
def _rotor(
    parameters: PlantParameters, constants: Constants, state: State, winding: Winding, line: CurrentLine,
    friction: Resistance, step_s: float,
) -> Body:  # fmt: skip
    """Return the rotor's share: motor and cogging torque, the drive side's friction, and the back-EMF as viscous."""
    ratio, speed = parameters.gear.ratio, state.rotor_rad_s
    strength = ratio * winding.torque_constant_n_m_a
    drag = friction.viscous_n_m_s_rad + strength * ratio * line.slope_a_s_rad + friction.bristle.slope_n_m_s_rad
    inertia = constants.rotor_kg_m2
    impulse = inertia * speed + step_s * (strength * line.constant_a - 0.5 * drag * speed - friction.bristle.known_n_m)
    impulse += step_s * ratio * cogging_torque(parameters.cogging, ratio * (state.rotor_rad + 0.5 * step_s * speed))
    return Body(
        inertia + 0.5 * step_s * drag, impulse,
        step_s * friction.lower_n_m, step_s * friction.upper_n_m, friction.viscous_n_m_s_rad,
    )  # fmt: skip


@jitted
def _arm(parameters: PlantParameters, constants: Constants, state: State, friction: Resistance, step_s: float) -> Body:
    """Return the arm's share: gravity and spring, half a step ahead, and the arm side's friction."""
    speed = state.arm_rad_s
    middle_rad = state.arm_rad + 0.5 * step_s * speed
    pull = gravity_torque(constants.moment_kg_m, parameters.centre_of_mass, middle_rad)
    pull += spring_torque(parameters.spring, middle_rad)
    pull += hose_torque(parameters.hose, bent(parameters.hose, _bend(state), 0.5 * step_s * speed))
    pull -= friction.bristle.known_n_m
    drag = friction.viscous_n_m_s_rad + friction.bristle.slope_n_m_s_rad
    inertia = constants.arm_kg_m2
    impulse = inertia * speed + step_s * (pull - 0.5 * drag * speed)
    return Body(
        inertia + 0.5 * step_s * drag, impulse,
        step_s * friction.lower_n_m, step_s * friction.upper_n_m, friction.viscous_n_m_s_rad,
    )  # fmt: skip


@jitted
def _held(arm: Body, hold: Hold, speed_rad_s: float, step_s: float) -> Body:
    """Return the arm's share in the operator's hand."""
    impulse = arm.impulse + hold.inertia_kg_m2 * speed_rad_s
    impulse += step_s * (hold.known_n_m - 0.5 * hold.slope_n_m_s_rad * speed_rad_s)
    diagonal = arm.diagonal + hold.inertia_kg_m2 + 0.5 * step_s * hold.slope_n_m_s_rad
    return Body(diagonal, impulse, arm.lower, arm.upper, arm.viscous)


@jitted
def _leaning(arm: Body, push: Push, speed_rad_s: float, step_s: float) -> Body:
    """Return the arm's share while wall or end stop pushes it."""
    impulse = arm.impulse + step_s * (push.known_n_m - 0.5 * push.slope_n_m_s_rad * speed_rad_s)
    return Body(arm.diagonal + 0.5 * step_s * push.slope_n_m_s_rad, impulse, arm.lower, arm.upper, arm.viscous)


@jitted
def _bend(state: State) -> Bend:
    """Return how far the hose is bent."""
    return Bend(state.hose_first_rad, state.hose_second_rad, state.hose_third_rad)


@jitted
def _drag_hose(parameters: PlantParameters, state: State, mean_rad_s: float, step_s: float) -> float:
    """Bend the hose on by a step at a mean speed; return what it took for good [J]."""
    hose, before = parameters.hose, _bend(state)
    if hose.stiffness_n_m_rad == 0.0:
        return 0.0
    after = bent(hose, before, step_s * mean_rad_s)
    pulled_n_m = hose_torque(hose, bent(hose, before, 0.5 * step_s * state.arm_rad_s))
    state.hose_first_rad, state.hose_second_rad, state.hose_third_rad = after
    return -pulled_n_m * step_s * mean_rad_s + hose_energy(hose, before) - hose_energy(hose, after)


@jitted
def _winding(parameters: PlantParameters, state: State) -> Winding:
    """Return the motor as its temperature has made it."""
    motor = parameters.motor
    return drifted(
        parameters.thermal_drift, motor.resistance_ohm, motor.torque_constant_n_m_a, state.winding_c, state.housing_c
    )


@jitted
def _friction_loss(body: Body, contact_n_m: float, new_rad_s: float, mean_rad_s: float, step_s: float) -> float:
    """Return what friction took from a body [J]: dry (the impulse that is missing) and viscous."""
    dry_impulse = body.impulse + step_s * contact_n_m - body.diagonal * new_rad_s
    return dry_impulse * mean_rad_s + step_s * body.viscous * mean_rad_s * mean_rad_s


@jitted
def _stops(state: State, new_rad_s: float, mean_rad_s: float) -> bool:
    """Tell whether the rotor comes to rest: sticks, or turns back on bristles after it has slipped."""
    if state.slid and mean_rad_s * state.bristle_rad <= 0.0:
        state.slid = False
        return True
    return new_rad_s == 0.0 and state.rotor_rad_s != 0.0
