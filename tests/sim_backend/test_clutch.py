import pytest

from sim_backend.mechanisms.motor.motor import OPEN
from tests.sim_backend.plants import ARM, RATIO, RESISTANCE, SUPPLY, G, K, duty_for_torque, plant, run

HELD = {"coulomb_n_m": 9.0, "static_n_m": 9.0}


@pytest.mark.parametrize("backlash_rad", [0.0, 0.01])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_clutch_carries_its_limit_and_no_more(sign: float, backlash_rad: float) -> None:
    held = plant(
        gear={"backlash_rad": backlash_rad}, arm_friction=HELD, clutch={"limit_n_m": 0.2},
        friction={"viscous_n_m_s_rad": 1e-3},
    )  # fmt: skip
    for share in range(1, 101):  # gently, or rotor and teeth swing
        run(held, sign * duty_for_torque(0.19 * share / 100.0), 0.03)
    assert held.truth().clutch_rad == 0.0
    run(held, sign * duty_for_torque(0.5), 3.0)
    truth = held.truth()
    assert truth.contact_n_m == pytest.approx(sign * 0.2, rel=1e-12)
    # the motor turns on against the clutch's torque
    wanted = (K * duty_for_torque(0.5) * SUPPLY / RESISTANCE - 0.2 / RATIO) / (1e-3 + K**2 / RESISTANCE)
    assert sign * truth.rotor_rad_s * RATIO == pytest.approx(wanted, rel=1e-9)
    assert truth.rotor_rad - truth.clutch_rad == pytest.approx(sign * (0.2 / 1000.0 + 0.5 * backlash_rad), rel=1e-9)
    assert truth.arm_rad == 0.0


def test_load_that_is_too_heavy_swings_down_through_the_clutch_while_the_motor_stands() -> None:
    dropped = plant(
        load={"mass_kg": 0.2}, clutch={"limit_n_m": 0.1}, friction=HELD, arm_friction={"viscous_n_m_s_rad": 0.02}
    )
    dropped.place(1.5, 1.5)
    dropped.advance(OPEN, 0.0, 100_000)
    truth = dropped.truth()
    assert truth.rotor_rad == 1.5
    # it comes to rest where gravity is no more than the clutch holds
    assert abs(0.2 * G * 0.3 * truth.arm_rad) < 0.1 * 1.02
    assert truth.clutch_rad > 1.0


def test_slip_conserves_momentum_and_its_loss_closes_the_energy_balance() -> None:
    slipping = plant(clutch={"limit_n_m": 0.05}, gear={"damping_n_m_s_rad": 0.0})
    slipping.place(0.0, 0.0, rotor_rad_s=3.0)
    began = slipping.energy().stored_j
    slipping.advance(OPEN, 0.0, 1000)
    truth, energy = slipping.truth(), slipping.energy()
    rotor = RATIO**2 * 2e-5
    assert rotor * truth.rotor_rad_s + ARM * truth.arm_rad_s == pytest.approx(rotor * 3.0, rel=1e-12)
    assert energy.stored_j + energy.lost_j == pytest.approx(began, rel=1e-9)
    # what slips at the limit is lost
    assert energy.lost_j == pytest.approx(0.05 * truth.clutch_rad, rel=0.01)
