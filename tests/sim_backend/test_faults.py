"""Scripted faults, as a host sees them through the drive contract."""

from collections.abc import Callable
from math import isnan
from typing import Any

import pytest

from drivers.contract import Command, Mode, Sample, Status
from drivers.errors import DriveConnectionError, DriveFault, DriveStateError
from sim_backend.drive.simulated_drive import SimulatedDrive
from sim_backend.errors import ParameterError
from sim_backend.faults.script import (
    ClutchSlips,
    DriveFailed,
    EncoderJump,
    EncoderStuck,
    Fault,
    LoadFalls,
    OverCurrent,
    OverTemperature,
    SamplesLate,
    SamplesLost,
    SupplyLost,
    TorqueDisabled,
)
from sim_backend.plant import presets
from sim_backend.plant.parameters import PlantParameters

OFF = Command(Mode.OFF)
PERIOD_S = 0.005


def _drive(*faults: Fault, **tables: dict[str, Any]) -> SimulatedDrive:
    drive = SimulatedDrive(PlantParameters.from_dict(tables, presets.paper()), seed=1, faults=faults)
    drive.open(PERIOD_S)
    drive.enable(Mode.DUTY)
    return drive


def _run(drive: SimulatedDrive, until_s: float, duty: float = 0.3) -> list[Sample]:
    samples = []
    while drive.plant.time_s < until_s - 1e-9:
        samples.append(drive.exchange(Command(Mode.DUTY, duty)))
    return samples


def test_script_that_is_still_to_come_changes_nothing() -> None:
    assert str(_run(_drive(EncoderStuck(start_s=9.0)), 0.5)) == str(_run(_drive(), 0.5))


def test_stuck_encoder_shows_the_position_of_the_start_until_it_is_free() -> None:
    drive = _drive(EncoderStuck(start_s=0.5, duration_s=0.25))
    samples = _run(drive, 1.0)
    stuck = [sample for sample in samples if 0.5 - 1e-9 <= sample.time_s < 0.75 - 1e-9]
    honest = {sample.time_s: sample for sample in _run(_drive(), 1.0)}
    assert len(stuck) == 50
    assert {sample.position_rad for sample in stuck} == {honest[stuck[0].time_s].position_rad}
    assert {sample.velocity_rad_s for sample in stuck} == {0.0}
    assert drive.plant.truth().rotor_rad_s > 1.0
    assert str(samples[-1]) == str(honest[samples[-1].time_s])


def test_encoder_jump_stays_in_the_position_and_passes_through_the_speed() -> None:
    samples = _run(_drive(EncoderJump(start_s=0.5, jump_rad=0.2)), 1.0)
    for seen, honest in zip(samples, _run(_drive(), 1.0), strict=True):
        jumped = 0.2 if seen.time_s >= 0.5 - 1e-9 else 0.0
        assert seen.position_rad - honest.position_rad == pytest.approx(jumped, abs=1e-12)
        news = jumped / 0.005 if seen.time_s < 0.505 - 1e-9 else 0.0
        assert seen.velocity_rad_s - honest.velocity_rad_s == pytest.approx(news, abs=1e-9)


def test_lost_samples_are_a_lost_connection_that_the_watchdog_ends() -> None:
    drive = _drive(SamplesLost(start_s=0.5, duration_s=0.4))
    _run(drive, 0.5)
    for cycle in range(80):
        powered = drive.plant.truth().current_a != 0.0
        assert powered is (cycle <= 20)  # the watchdog waits 0.1 s
        with pytest.raises(DriveConnectionError, match=r"no answer to the command of 0\.\d{4} s; check the cable"):
            drive.exchange(Command(Mode.DUTY, 0.3))
    assert drive.plant.time_s == pytest.approx(0.9)
    with pytest.raises(DriveFault, match="watchdog: no command in time"):
        drive.exchange(Command(Mode.DUTY, 0.3))


def test_one_lost_sample_is_survived() -> None:
    drive = _drive(SamplesLost(start_s=0.5, duration_s=PERIOD_S))
    _run(drive, 0.5)
    with pytest.raises(DriveConnectionError):
        drive.exchange(Command(Mode.DUTY, 0.3))
    sample = drive.exchange(Command(Mode.DUTY, 0.3))
    assert sample.status is Status.ENABLED
    assert sample.time_s == pytest.approx(0.51)


def test_late_samples_tell_their_age_and_show_the_past() -> None:
    samples = _run(_drive(SamplesLate(start_s=0.5, duration_s=0.2, age_s=0.03)), 1.0)
    honest = _run(_drive(), 1.0)
    for place, seen in enumerate(samples):
        late = 0.5 - 1e-9 <= seen.time_s < 0.7 - 1e-9
        assert seen.age_s == pytest.approx(0.03 if late else 0.0, abs=1e-9)
        assert seen.position_rad == honest[place - 6 if late else place].position_rad
        assert seen.time_s == honest[place].time_s


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        (OverTemperature(start_s=0.5, duration_s=0.3), "over-temperature, 95 degC"),
        (OverCurrent(start_s=0.5, duration_s=0.3, current_a=12.5), r"over-current, 12\.5 A"),
        (SupplyLost(start_s=0.5, duration_s=0.3), "under-voltage, 0 V"),
        (DriveFailed(start_s=0.5, duration_s=0.3, text="hall sensor"), "hall sensor"),
    ],
)
def test_drive_that_trips_takes_the_power_away_and_is_cleared_only_without_the_cause(
    fault: Fault, message: str
) -> None:
    drive = _drive(fault)
    _run(drive, 0.5)
    sample = drive.exchange(Command(Mode.DUTY, 0.3))
    assert sample.status is Status.FAULT
    assert sample.duty == 0.0
    assert drive.plant.truth().current_a == 0.0
    with pytest.raises(DriveFault, match=f"switched itself off: {message}.*; find the cause, then clear"):
        drive.exchange(Command(Mode.DUTY, 0.3))
    with pytest.raises(DriveFault, match=f"cannot be cleared: {message}"):
        drive.clear_fault()
    with pytest.raises(DriveStateError, match="clear the fault"):
        drive.enable(Mode.DUTY)
    while drive.plant.time_s < 0.8 - 1e-9:
        assert drive.exchange(OFF).status is Status.FAULT
    drive.clear_fault()
    assert drive.exchange(OFF).status is Status.DISABLED
    drive.enable(Mode.DUTY)
    assert _run(drive, 1.2)[-1].velocity_rad_s > 1.0


def test_lost_supply_and_heat_show_in_the_samples() -> None:
    drive = _drive(SupplyLost(start_s=0.1, duration_s=0.2), heat={"present": True})
    assert [drive.exchange(OFF).supply_v for _ in range(80)] == [24.0] * 19 + [0.0] * 40 + [24.0] * 21
    hot = _drive(OverTemperature(start_s=0.0, temperature_c=101.0), heat={"present": True})
    assert hot.exchange(OFF).temperature_c == 101.0
    assert isnan(_drive(OverTemperature(start_s=0.0)).exchange(OFF).temperature_c)


def test_torque_disable_is_no_fault_and_lasts_until_its_circuit_is_closed() -> None:
    drive = _drive(TorqueDisabled(start_s=0.5, duration_s=0.2))
    _run(drive, 0.5)
    sample = drive.exchange(Command(Mode.DUTY, 0.3))
    assert (sample.status, sample.duty) == (Status.DISABLED, 0.0)
    assert drive.plant.truth().current_a == 0.0
    calls: list[Callable[[], object]] = [
        lambda: drive.exchange(Command(Mode.DUTY, 0.3)),
        lambda: drive.enable(Mode.DUTY),
    ]
    for call in calls:
        with pytest.raises(DriveStateError, match="safe torque off is active; close its circuit, then enable"):
            call()
    while drive.plant.time_s < 0.7 - 1e-9:
        drive.exchange(OFF)
    drive.enable(Mode.DUTY)
    assert _run(drive, 1.0)[-1].status is Status.ENABLED


def test_fault_ends_a_quick_stop() -> None:
    # the stuck encoder makes the drive believe in the same cycle that it stands
    drive = _drive(DriveFailed(start_s=0.5, duration_s=PERIOD_S), EncoderStuck(start_s=0.502))
    _run(drive, 0.49)
    drive.quick_stop()
    statuses = [drive.exchange(OFF).status for _ in range(200)]
    assert statuses[0] is Status.QUICK_STOP
    assert statuses[-1] is Status.FAULT


def test_clutch_slips_while_the_script_says_so() -> None:
    drive = _drive(ClutchSlips(start_s=0.5, duration_s=0.5, limit_n_m=0.05), load={"mass_kg": 0.1})
    drive.plant.place(0.0, 0.0)
    _run(drive, 0.5, duty=0.1)
    before = drive.plant.truth().clutch_rad
    _run(drive, 1.0, duty=0.6)
    after = drive.plant.truth().clutch_rad
    assert before == 0.0
    assert after > 1.0
    drive.disable()
    while drive.plant.time_s < 3.0:
        drive.exchange(OFF)
    # rigid again: motor and arm are apart by what has slipped, within the free play
    assert drive.plant.truth().clutch_rad == pytest.approx(after, abs=0.05)
    assert drive.plant.parameters.clutch.limit_n_m == 0.0


def test_load_that_falls_off_is_gone_until_it_is_hung_on_again() -> None:
    drive = _drive(LoadFalls(start_s=0.5))
    drive.disable()
    drive.hang_load(0.1, balanced=False)
    drive.enable(Mode.DUTY)
    _run(drive, 0.5, duty=0.15)
    assert drive.plant.parameters.load.mass_kg == 0.1
    speed = drive.plant.truth().arm_rad_s
    drive.exchange(Command(Mode.DUTY, 0.15))
    assert drive.plant.parameters.load.mass_kg == 0.0
    assert drive.plant.truth().arm_rad_s == pytest.approx(speed, abs=0.5)
    drive.disable()
    drive.hang_load(0.1, balanced=False)
    drive.exchange(OFF)
    assert drive.plant.parameters.load.mass_kg == 0.1


def test_two_of_a_kind_at_a_time_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"EncoderStuck.start_s = 1 \[s\]: the one of 0.5 s is not over before 2"):
        _drive(EncoderStuck(start_s=1.0), EncoderStuck(start_s=0.5, duration_s=1.5))
    with pytest.raises(ParameterError, match=r"SamplesLate.age_s = 0.0 \[s\]: must be greater than 0"):
        SamplesLate(start_s=0.0, age_s=0.0)
