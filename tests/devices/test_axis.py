from typing import Any

import pytest

from drivers.contract import Command, Mode, Sample
from sim_backend.devices.axis import CURRENT, OFF, VOLTAGE, Axis, Demand
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.drive.simulated_drive import SimulatedDrive
from sim_backend.errors import ParameterError
from sim_backend.faults.script import OverCurrent, TorqueDisabled
from sim_backend.plant import presets


class _Held:
    """A law that demands what it was told."""

    def __init__(self) -> None:
        self.now = OFF

    def demand(self, seen: Sample) -> Demand:
        return self.now


def _axis(**tables: dict[str, Any]) -> tuple[Axis, _Held]:
    law = _Held()
    return Axis(behind_a_drive(changed=tables), law, seed=1), law


def test_time_comes_in_whole_ticks_and_does_not_drift() -> None:
    axis, _ = _axis()
    for number in range(1, 1000):
        axis.advance_to(number * 0.00137)
    assert axis.time_s == pytest.approx(1.368)


def test_joint_moves_as_behind_the_drive_in_process() -> None:
    axis, law = _axis()
    law.now = Demand(VOLTAGE, 0.2)
    axis.advance_to(0.5)
    drive = SimulatedDrive(presets.paper(), seed=1)
    drive.open(1e-3)
    drive.enable(Mode.DUTY)
    for _ in range(500):
        sample = drive.exchange(Command(Mode.DUTY, 0.2))
    assert axis.seen.position_rad == sample.position_rad
    assert axis.seen.velocity_rad_s == sample.velocity_rad_s


def test_power_is_on_while_the_stage_can_drive_the_motor_and_says_since_when() -> None:
    axis, law = _axis()
    axis.advance_to(0.1)
    assert axis.power == (False, 0.0)
    law.now = Demand(CURRENT, 0.0)
    axis.advance_to(0.2)
    assert axis.power == (True, pytest.approx(0.1))
    law.now = Demand(VOLTAGE, 0.0)  # shorted: brakes, cannot drive
    axis.advance_to(0.3)
    assert axis.power == (False, pytest.approx(0.2))


@pytest.mark.parametrize("kind", [OverCurrent, TorqueDisabled])
def test_trip_opens_the_stage_whatever_the_law_demands(kind: Any) -> None:
    axis, law = _axis()
    law.now = Demand(CURRENT, 0.5)
    axis.advance_to(0.1)
    axis.meet(kind(start_s=0.15, duration_s=0.1))
    axis.advance_to(0.2)
    assert not axis.power.on
    assert axis.stage_name == "open"
    axis.advance_to(0.3)
    assert axis.power.on


def test_overload_trips_for_a_while() -> None:
    axis, law = _axis(overload={"present": True, "continuous_a": 0.2, "peak_a": 0.8, "peak_time_s": 0.1})
    law.now = Demand(CURRENT, 2.0)
    axis.advance_to(0.5)
    assert isinstance(axis.trip(), OverCurrent)
    assert not axis.power.on


def test_duty_in_current_mode_is_what_the_motor_needs() -> None:
    axis, law = _axis()
    law.now = Demand(CURRENT, 0.3)
    axis.advance_to(0.4)
    motor, truth = axis.plant.parameters.motor, axis.plant.truth()
    needed_v = motor.resistance_ohm * truth.current_a + motor.torque_constant_n_m_a * 20.0 * truth.rotor_rad_s
    assert axis.seen.duty == pytest.approx(needed_v / 24.0)
    assert 0.1 < axis.seen.duty < 1.0


def test_load_is_hung_with_the_power_off_only() -> None:
    axis, law = _axis()
    axis.hang_load(0.05, balanced=False)
    assert axis.plant.parameters.load.mass_kg == 0.05
    law.now = Demand(VOLTAGE, 0.1)
    axis.advance_to(0.01)
    with pytest.raises(ParameterError, match="power off"):
        axis.hang_load(0.02, balanced=False)
    assert axis.plant.parameters.load.mass_kg == 0.05


def test_swapped_leads_turn_the_joint_and_the_count_the_other_way() -> None:
    axes = {}
    for motor in (False, True):
        for encoder in (False, True):
            axis, law = _axis(wiring={"motor_reversed": motor, "encoder_reversed": encoder})
            law.now = Demand(VOLTAGE, 0.2)
            axis.advance_to(0.5)
            axes[motor, encoder] = axis
    for (motor, encoder), axis in axes.items():
        turned = -1.0 if motor else 1.0
        assert axis.plant.truth().arm_rad * turned > 0.0
        assert axis.counts() * turned * (-1.0 if encoder else 1.0) > 0
        assert axis.seen.current_a > 0.0  # of the drive's own demand, whichever way the joint turns
        assert axis.seen.duty == pytest.approx(0.2)


def test_an_arm_that_is_held_stays_and_one_that_is_let_go_falls() -> None:
    axis, law = _axis(arm={"centre_of_mass_m": 0.2, "inertia_kg_m2": 0.02})
    axis.hold_arm(1.0)
    axis.advance_to(0.5)
    assert axis.seen.position_rad == pytest.approx(1.0, abs=1e-3)
    axis.release_arm()
    axis.advance_to(2.0)
    assert axis.seen.position_rad < 0.5
    law.now = Demand(VOLTAGE, 0.2)
    axis.advance_to(2.1)
    with pytest.raises(ParameterError, match="power off"):
        axis.hold_arm(1.0)


def test_the_drive_in_process_has_no_leads() -> None:
    with pytest.raises(ParameterError, match="simulate a device instead"):
        SimulatedDrive(behind_a_drive(changed={"wiring": {"motor_reversed": True}}))
