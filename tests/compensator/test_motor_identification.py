"""What duty, supply, speed and current tell of a motor that is known, and what they do not."""

import numpy as np
import pytest

from compensator.errors import CalibrationError
from compensator.motion.kinetic_friction import KineticFriction
from compensator.motor.identification import MotorSample, identify

R_OHM, KE_V_S_RAD, SUPPLY_V = 8.0, 0.05, 24.0
FRICTION = KineticFriction(0.16, 0.27, 5.0, viscous_a_s_rad=2.1e-3)
SPEEDS = np.array([2.0, 6.0, 20.0, 60.0, 80.0, 100.0, 120.0])
RUNNING = np.concatenate([SPEEDS, -SPEEDS])
LOCKED_A = np.array([0.05, 0.1, 0.15, -0.05, -0.1, -0.15])


def samples(
    speeds=RUNNING, locked_a=LOCKED_A, r_ohm=R_OHM, ke=KE_V_S_RAD, friction=FRICTION, noise_a=0.0, seed=0, **sensor
):
    """Samples of a balanced joint; the current as a sensor with gain and offset gives it, or NaN."""
    scatter = np.random.default_rng(seed)
    found = []
    for speed, current in [*((w, float(friction.sliding_a(w))) for w in speeds), *((0.0, i) for i in locked_a)]:
        duty = (r_ohm * current + ke * speed) / SUPPLY_V
        shown = current * sensor.get("gain", 1.0) + sensor.get("offset_a", 0.0) + scatter.normal(0.0, noise_a or 1e-12)
        found.append(MotorSample(duty, SUPPLY_V, speed, shown if sensor.get("present", True) else float("nan")))
    return found


def test_without_noise_both_are_recovered():
    found = identify(samples())
    assert found.resistance_ohm.value == pytest.approx(R_OHM)
    assert found.back_emf_v_s_rad.value == pytest.approx(KE_V_S_RAD)
    assert found.unidentified == {}


def test_intervals_hold_the_truth_and_are_of_theorys_width():
    # least squares of I on (V, w, 1), and R = 1/g, Ke = -h/g to first order
    current_a = np.concatenate([FRICTION.sliding_a(RUNNING), LOCKED_A])
    speed = np.concatenate([RUNNING, 0.0 * LOCKED_A])
    columns = np.column_stack([R_OHM * current_a + KE_V_S_RAD * speed, speed, np.ones(20)])
    gradients = np.array([[-(R_OHM**2), 0.0, 0.0], [-KE_V_S_RAD * R_OHM, -R_OHM, 0.0]])
    covariance = gradients @ np.linalg.inv(columns.T @ columns) @ gradients.T
    deviations = 0.002 * np.sqrt(np.diag(covariance))
    fits = [identify(samples(noise_a=0.002, seed=seed)) for seed in range(200)]
    for pick, true, deviation in (
        (lambda one: one.resistance_ohm, R_OHM, deviations[0]),
        (lambda one: one.back_emf_v_s_rad, KE_V_S_RAD, deviations[1]),
    ):
        held = sum(pick(one).low <= true <= pick(one).high for one in fits)
        assert 180 <= held <= 199  # of 200 at 95 %, three deviations of the count either way
        width = np.median([pick(one).high - pick(one).low for one in fits])
        assert width == pytest.approx(2 * 2.11 * deviation, rel=0.1)  # Student's t of 17 degrees


def test_a_zero_error_of_the_current_sensor_goes_into_the_offset_and_not_into_r():
    found = identify(samples(offset_a=0.02))
    assert found.resistance_ohm.value == pytest.approx(R_OHM)
    assert found.offset_v.value == pytest.approx(-R_OHM * 0.02)


def test_a_wrong_gain_goes_into_r_as_documented():
    assert identify(samples(gain=1.25)).resistance_ohm.value == pytest.approx(R_OHM / 1.25)


def test_locked_samples_tell_r_and_say_that_ke_is_not_told():
    found = identify(samples(speeds=()))
    assert found.resistance_ohm.value == pytest.approx(R_OHM)
    assert found.back_emf_v_s_rad is None
    assert "Ke shows only in motion" in found.unidentified["back_emf_v_s_rad"]


def test_running_at_one_speed_does_not_tell_r():
    # one current, one speed, a little noise: any R will do with a Ke to match
    found = identify(samples(speeds=[100.0, -100.0] * 4, locked_a=(), noise_a=0.002))
    assert found.resistance_ohm is None
    assert "no locked sample" in found.unidentified["resistance_ohm"]
    assert "Ke" in found.unidentified["back_emf_v_s_rad"]


def test_locked_without_any_voltage_tells_nothing_and_does_not_break():
    found = identify([MotorSample(0.0, 24.0, 0.0, 1e-3 * number) for number in range(-3, 4)])
    assert found.resistance_ohm is None
    assert found.back_emf_v_s_rad is None


def test_without_a_measured_current_neither_is_told_and_the_way_out_is_named():
    found = identify(samples(present=False))
    assert found.resistance_ohm is None
    assert found.back_emf_v_s_rad is None
    for reason in found.unidentified.values():
        assert "ohmmeter" in reason
    # what shows: Ke + R b = 0.05 + 8 * 2.1e-3 V s/rad, and R Fc = 8 * 0.16 V
    assert found.back_emf_bound_v_s_rad.value == pytest.approx(0.0668, rel=1e-6)
    assert found.friction_v.value == pytest.approx(1.28, rel=1e-6)
    assert found.back_emf_bound_v_s_rad.value > KE_V_S_RAD


def test_another_motor_with_another_friction_gives_the_same_duties():
    # the reason behind the refusal: twice the resistance, half the friction, and a Ke that makes up for the rest
    other = KineticFriction(0.08, 0.135, 5.0, viscous_a_s_rad=1e-4)
    ke = KE_V_S_RAD + R_OHM * 2.1e-3 - 2 * R_OHM * 1e-4
    one = samples(present=False, locked_a=())
    two = samples(present=False, locked_a=(), r_ohm=2 * R_OHM, ke=ke, friction=other)
    np.testing.assert_allclose([s.duty for s in one], [s.duty for s in two], rtol=1e-12)
    assert identify(one).back_emf_bound_v_s_rad.value == pytest.approx(identify(two).back_emf_bound_v_s_rad.value)


def test_one_direction_shows_no_lumps():
    found = identify(samples(speeds=SPEEDS, present=False))
    assert found.back_emf_bound_v_s_rad is None
    assert found.friction_v is None


GOOD = MotorSample(0.1, 24.0, 0.0, 0.3)
WRONG = [
    ([], "there are 0 samples"),
    ([GOOD] * 3, "there are 3 samples with a measured current; allowed is at least 5"),
    ([GOOD, GOOD._replace(duty=1.5)], "duty of sample 1 is 1.5; allowed is -1 .. 1"),
    ([GOOD._replace(supply_v=0.0)], "supply_v of sample 0 is 0 V; allowed is above 0 V"),
    ([GOOD._replace(speed_rad_s=float("nan"))], "speed_rad_s of sample 0 is nan rad/s; allowed is finite"),
    ([GOOD._replace(current_a=float("inf"))], "current_a of sample 0 is inf A; allowed is finite, or NaN"),
]


@pytest.mark.parametrize(("wrong", "message"), WRONG)
def test_samples_that_tell_nothing_are_refused(wrong, message):
    with pytest.raises(CalibrationError) as caught:
        identify(wrong)
    assert str(caught.value).startswith(message)
