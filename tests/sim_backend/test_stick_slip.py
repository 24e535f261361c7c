from hypothesis import given
from hypothesis import strategies as st

from sim_backend.plant import stick_slip
from sim_backend.plant.stick_slip import Body
from tests.sim_backend.compiled import callable_from_python

coupled_speeds = callable_from_python(stick_slip.coupled_speeds)
free_speeds = callable_from_python(stick_slip.free_speeds)

inertias = st.floats(1e-4, 1.0)
limits = st.floats(0.0, 1e-2)
impulses = st.floats(-1e-1, 1e-1)
speeds = st.one_of(st.just(0.0), st.floats(-10.0, 10.0))
guesses = st.tuples(speeds, speeds)
bodies = st.builds(Body, inertias, impulses, limits, limits, st.just(0.0))


def _obeys_the_law(body: Body, friction: float, speed: float) -> bool:
    """Sliding friction is at its limit, friction at rest within the limits."""
    slack = 1e-9
    if speed > 0.0:
        return abs(friction - body.upper) <= slack
    if speed < 0.0:
        return abs(friction + body.lower) <= slack
    return -body.lower - slack <= friction <= body.upper + slack


@given(bodies, bodies, st.floats(1e-6, 1e-1), impulses, guesses)
def test_solution_obeys_momentum_and_the_law_of_friction(
    rotor: Body, arm: Body, k: float, c: float, guess: tuple[float, float]
) -> None:
    v_r, v_a = coupled_speeds(rotor, arm, k, c, *guess)
    teeth = c + k * (v_r - v_a)
    assert _obeys_the_law(rotor, rotor.impulse - teeth - rotor.diagonal * v_r, v_r)
    assert _obeys_the_law(arm, arm.impulse + teeth - arm.diagonal * v_a, v_a)


@given(bodies, bodies)
def test_bodies_apart_obey_it_each_on_its_own(rotor: Body, arm: Body) -> None:
    for body, speed in zip((rotor, arm), free_speeds(rotor, arm), strict=True):
        assert _obeys_the_law(body, body.impulse - body.diagonal * speed, speed)


@given(bodies, bodies, st.floats(1e-6, 1e-1), impulses, guesses, guesses)
def test_solution_does_not_depend_on_the_guess(
    rotor: Body, arm: Body, k: float, c: float, one: tuple[float, float], other: tuple[float, float]
) -> None:
    first, second = coupled_speeds(rotor, arm, k, c, *one), coupled_speeds(rotor, arm, k, c, *other)
    assert all(abs(a - b) <= 1e-7 * (1.0 + abs(a)) for a, b in zip(first, second, strict=True))
