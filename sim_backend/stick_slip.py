"""Two bodies that may stick: the one-step problem of set-valued friction, solved exactly.

At the end of a step the speeds v = (rotor, arm) satisfy

    [ a_r  -k  ] [v_r]   [b_r]   [s_r]
    [ -k   a_a ] [v_a] = [b_a] - [s_a]

where a friction impulse s is the upper limit when its body moves forwards, minus the lower limit when it moves
backwards, and whatever lies between when it rests. This is the optimality condition of a strictly convex function
(Moreau's time stepping), so there is one solution. A resting body rests exactly: its speed is 0.0, not small.
"""

from sim_backend.jit import jitted

# Gauss-Seidel contracts by k^2 / (a_r a_a), about 1e-4 for metal teeth at 0.1 ms
_SWEEPS = 100


@jitted
def slipped(impulse: float, lower: float, upper: float) -> float:
    """Return what is left of an impulse after friction: 0 where friction can hold it."""
    if impulse > upper:
        return impulse - upper
    if impulse < -lower:
        return impulse + lower
    return 0.0


@jitted
def _sign(value: float) -> float:
    if value > 0.0:
        return 1.0
    return -1.0 if value < 0.0 else 0.0


@jitted
def _slip_impulse(direction: float, lower: float, upper: float) -> float:
    return upper if direction > 0.0 else -lower


@jitted
def solve(
    a_r: float, a_a: float, k: float, b_r: float, b_a: float,
    lower_r: float, upper_r: float, lower_a: float, upper_a: float, v_a: float,
) -> tuple[float, float]:  # fmt: skip
    """Return the speeds (rotor, arm) at the end of the step.

    Args:
        a_r: rotor's diagonal, inertia and damping.
        a_a: arm's diagonal.
        k: coupling through the teeth, 0 where they do not touch.
        b_r: rotor's impulse without friction.
        b_a: arm's impulse without friction.
        lower_r: friction impulse against backward motion of the rotor.
        upper_r: friction impulse against forward motion of the rotor.
        lower_a: as lower_r, of the arm.
        upper_a: as upper_r, of the arm.
        v_a: first guess of the arm's speed.
    """
    if k == 0.0:
        return slipped(b_r, lower_r, upper_r) / a_r, slipped(b_a, lower_a, upper_a) / a_a
    v_r = 0.0
    for _ in range(_SWEEPS):
        # one sweep shows who sticks and who slips which way
        v_r = slipped(b_r + k * v_a, lower_r, upper_r) / a_r
        v_a = slipped(b_a + k * v_r, lower_a, upper_a) / a_a
        way_r, way_a = _sign(v_r), _sign(v_a)
        # with that settled the rest is linear
        free_r = b_r - _slip_impulse(way_r, lower_r, upper_r)
        free_a = b_a - _slip_impulse(way_a, lower_a, upper_a)
        if way_r != 0.0 and way_a != 0.0:
            determinant = a_r * a_a - k * k
            v_r = (free_r * a_a + k * free_a) / determinant
            v_a = (free_a * a_r + k * free_r) / determinant
        elif way_r != 0.0:
            v_r = free_r / a_r
        elif way_a != 0.0:
            v_a = free_a / a_a
        # and it stands if it agrees with what it assumed
        held_r = way_r != 0.0 or slipped(b_r + k * v_a, lower_r, upper_r) == 0.0
        held_a = way_a != 0.0 or slipped(b_a + k * v_r, lower_a, upper_a) == 0.0
        if _sign(v_r) == way_r and _sign(v_a) == way_a and held_r and held_a:
            break
    return v_r, v_a
