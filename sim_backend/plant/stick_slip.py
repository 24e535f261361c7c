"""Two bodies that may stick: the one-step problem of set-valued friction, solved exactly.

At the end of a step the speeds v = (rotor, arm) satisfy

    [ d_r + k   -k      ] [v_r]   [p_r - c]   [s_r]
    [ -k        d_a + k ] [v_a] = [p_a + c] - [s_a]

where a friction impulse s is the upper limit when its body moves forwards, minus the lower limit when it moves
backwards, and whatever lies between when it rests. This is the optimality condition of a strictly convex function
(Moreau's time stepping), so there is one solution. A resting body rests exactly: its speed is 0.0, not small.
"""

from typing import NamedTuple

from sim_backend.plant.jit import jitted

# a sweep of Gauss-Seidel leaves k^2 / ((d_r + k) (d_a + k)) of the error: 1e-4 for metal teeth at 0.1 ms
_SWEEPS = 4


class Body(NamedTuple):
    """One body's share of the problem, at the joint.

    Attributes:
        diagonal: d, inertia and damping [kg m2].
        impulse: p, momentum at the start and all that acts but friction and teeth [N m s].
        lower: friction impulse against backward motion [N m s].
        upper: friction impulse against forward motion [N m s].
        viscous: torque over speed [N m s/rad]; already in d and p, kept for the energy balance.
    """

    diagonal: float
    impulse: float
    lower: float
    upper: float
    viscous: float


@jitted
def left_by_friction(impulse: float, body: Body) -> float:
    """Return what is left of an impulse after friction: 0.0 where friction can hold it."""
    if impulse > body.upper:
        return impulse - body.upper
    if impulse < -body.lower:
        return impulse + body.lower
    return 0.0


@jitted
def _sign(value: float) -> float:
    if value > 0.0:
        return 1.0
    return -1.0 if value < 0.0 else 0.0


@jitted
def free_speeds(rotor: Body, arm: Body) -> tuple[float, float]:
    """Return the speeds (rotor, arm) at the end of the step, where the teeth do not touch."""
    return left_by_friction(rotor.impulse, rotor) / rotor.diagonal, left_by_friction(arm.impulse, arm) / arm.diagonal


@jitted
def coupled_speeds(rotor: Body, arm: Body, k: float, c: float, v_r: float, v_a: float) -> tuple[float, float]:
    """Return the speeds (rotor, arm) at the end of the step, where the teeth touch.

    Args:
        rotor: the rotor's share.
        arm: the arm's share.
        k: impulse of the teeth per new speed difference [kg m2].
        c: impulse of the teeth that is known already [N m s].
        v_r: first guess of the rotor's speed.
        v_a: first guess of the arm's speed.
    """
    d_r, d_a = rotor.diagonal + k, arm.diagonal + k
    p_r, p_a = rotor.impulse - c, arm.impulse + c
    # most steps go on as the last: who slips goes on slipping, who sticks goes on sticking
    way_r, way_a = _sign(v_r), _sign(v_a)
    exact_r, exact_a = _settled(rotor, arm, p_r, p_a, k, way_r, way_a)
    if _agrees(rotor, p_r + k * exact_a, exact_r, way_r) and _agrees(arm, p_a + k * exact_r, exact_a, way_a):
        return exact_r, exact_a
    for _ in range(_SWEEPS):
        # one sweep shows who sticks and who slips which way; with that settled the rest is linear
        v_r = left_by_friction(p_r + k * v_a, rotor) / d_r
        v_a = left_by_friction(p_a + k * v_r, arm) / d_a
        way_r, way_a = _sign(v_r), _sign(v_a)
        exact_r, exact_a = _settled(rotor, arm, p_r, p_a, k, way_r, way_a)
        if _agrees(rotor, p_r + k * exact_a, exact_r, way_r) and _agrees(arm, p_a + k * exact_r, exact_a, way_a):
            return exact_r, exact_a
    # a coupling that dwarfs the inertias leads the sweeps astray: try all ways
    for way_r in (-1.0, 0.0, 1.0):
        for way_a in (-1.0, 0.0, 1.0):
            exact_r, exact_a = _settled(rotor, arm, p_r, p_a, k, way_r, way_a)
            if _agrees(rotor, p_r + k * exact_a, exact_r, way_r) and _agrees(arm, p_a + k * exact_r, exact_a, way_a):
                return exact_r, exact_a
    # one of them fits but for rounding, at the brink of slip, where the sweeps have come close
    return v_r, v_a


@jitted
def _agrees(body: Body, pushed: float, speed: float, way: float) -> bool:
    """Tell whether a solution does what it assumed: slip that way, or stay within what friction can hold."""
    if way == 0.0:
        return left_by_friction(pushed, body) == 0.0
    return speed * way >= 0.0


@jitted
def _settled(
    rotor: Body, arm: Body, p_r: float, p_a: float, k: float, way_r: float, way_a: float
) -> tuple[float, float]:
    """Return the speeds for given directions of slip; 0 is stick."""
    d_r, d_a = rotor.diagonal + k, arm.diagonal + k
    free_r = p_r - (rotor.upper if way_r > 0.0 else -rotor.lower)
    free_a = p_a - (arm.upper if way_a > 0.0 else -arm.lower)
    if way_r != 0.0 and way_a != 0.0:
        determinant = d_r * d_a - k * k
        return (free_r * d_a + k * free_a) / determinant, (free_a * d_r + k * free_r) / determinant
    if way_r != 0.0:
        return free_r / d_r, 0.0
    if way_a != 0.0:
        return 0.0, free_a / d_a
    return 0.0, 0.0
