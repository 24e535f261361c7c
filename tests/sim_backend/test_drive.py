from math import isnan, nan
from typing import Any

import pytest

from drivers.contract import Command, Drive, Mode, Status
from drivers.errors import DriveConfigurationError, DriveFault, DriveStateError
from sim_backend.drive.simulated_drive import SimulatedDrive
from sim_backend.plant import presets
from sim_backend.plant.parameters import PlantParameters

OFF = Command(Mode.OFF)
PERIOD_S = 0.005


def _drive(seed: int = 1, **tables: dict[str, Any]) -> SimulatedDrive:
    drive = SimulatedDrive(PlantParameters.from_dict(tables, presets.paper()), seed)
    drive.open(PERIOD_S)
    return drive


def _duty(drive: Drive, duty: float, cycles: int = 1) -> Any:
    for _ in range(cycles):
        sample = drive.exchange(Command(Mode.DUTY, duty))
    return sample


WITH_CURRENT = {"current_sensor": {"present": True}, "current_loop": {"present": True}}


def test_each_exchange_takes_one_period() -> None:
    drive = _drive()
    drive.enable(Mode.DUTY)
    times = [_duty(drive, 0.1).time_s for _ in range(5)]
    assert times == pytest.approx([0.005, 0.010, 0.015, 0.020, 0.025], abs=1e-12)


@pytest.mark.parametrize("period_s", [1e-4, 0.00023, 1e-3, 0.0333])
def test_any_period_is_met_exactly(period_s: float) -> None:
    drive = SimulatedDrive(presets.paper())
    drive.open(period_s)
    assert [drive.exchange(OFF).time_s for _ in range(3)] == pytest.approx([period_s, 2 * period_s, 3 * period_s])


@pytest.mark.parametrize("period_s", [5e-5, 0.1, nan])
def test_period_that_cannot_be_kept_is_refused(period_s: float) -> None:
    with pytest.raises(DriveConfigurationError, match=r"drive 'sim': period .* s: at least 0.0001 s .* 0.1 s"):
        SimulatedDrive(presets.paper()).open(period_s)


def test_sample_holds_what_is_measured_and_nan_for_the_rest() -> None:
    drive = _drive()
    drive.enable(Mode.DUTY)
    sample = _duty(drive, 0.20049, 200)
    assert sample.duty == 0.2  # whole counts of 1000
    assert sample.supply_v == 24.0
    assert sample.velocity_rad_s > 0.0
    assert isnan(sample.current_a)
    assert isnan(sample.temperature_c)
    assert sample.status is Status.ENABLED


def test_description_names_what_a_sample_measures() -> None:
    for tables in ({}, WITH_CURRENT, {"heat": {"present": True}}):
        drive = _drive(**tables)
        description = drive.describe()
        sample = drive.exchange(OFF)
        for name in ("position_rad", "velocity_rad_s", "duty", "current_a", "supply_v", "temperature_c"):
            assert (name in description.measured) is not isnan(getattr(sample, name))
    assert description.simulated
    assert description.resolution["position_rad"] == pytest.approx(2 * 3.141592653589793 / 4096 / 20)


def test_current_mode_is_offered_only_with_a_current_loop() -> None:
    with pytest.raises(DriveConfigurationError, match=r"mode 'current' is not one of its modes \(duty\)"):
        _drive().enable(Mode.CURRENT)
    drive = _drive(**WITH_CURRENT)
    drive.enable(Mode.CURRENT)
    for _ in range(10):
        sample = drive.exchange(Command(Mode.CURRENT, 0.07))
    assert sample.current_a == pytest.approx(0.07, rel=1e-6)
    assert isnan(sample.duty)


def test_without_power_the_load_falls_and_no_current_flows() -> None:
    drive = _drive(load={"mass_kg": 0.1})
    drive.plant.place(1.5708, 1.5708)
    for _ in range(400):
        sample = drive.exchange(OFF)
    assert sample.position_rad < 0.8
    assert drive.plant.truth().current_a == 0.0
    assert sample.status is Status.DISABLED


def test_off_command_takes_the_power_away() -> None:
    drive = _drive()
    drive.enable(Mode.DUTY)
    _duty(drive, 0.3, 100)
    assert drive.exchange(OFF).status is Status.DISABLED
    with pytest.raises(DriveStateError, match=r"a duty command in state 'disabled'; enable duty mode first"):
        _duty(drive, 0.3)


def test_quick_stop_brakes_faster_than_coasting_and_ends_without_power() -> None:
    cycles = {}
    for how in ("quick_stop", "disable"):
        drive = _drive(load={"mass_kg": 0.1, "balanced": True})
        drive.enable(Mode.DUTY)
        _duty(drive, 0.4, 1000)
        getattr(drive, how)()
        statuses = []
        while drive.plant.truth().rotor_rad_s != 0.0:
            statuses.append(drive.exchange(OFF).status)
        cycles[how] = len(statuses)
        assert statuses[0] is (Status.QUICK_STOP if how == "quick_stop" else Status.DISABLED)
        assert [drive.exchange(OFF).status for _ in range(3)][-1] is Status.DISABLED
    assert cycles["quick_stop"] < 0.6 * cycles["disable"]


def test_drive_that_is_stopping_cannot_be_enabled() -> None:
    drive = _drive()
    drive.enable(Mode.DUTY)
    _duty(drive, 0.4, 200)
    drive.quick_stop()
    for call in (lambda: drive.enable(Mode.DUTY), lambda: _duty(drive, 0.4)):
        with pytest.raises(DriveStateError, match="in state 'quick stop'; exchange OFF commands until it stands"):
            call()


def test_watchdog_switches_off_a_drive_that_nobody_talks_to() -> None:
    drive = _drive()
    drive.enable(Mode.DUTY)
    _duty(drive, 0.3, 200)
    drive.idle(0.095)
    assert drive.plant.truth().current_a > 0.0
    assert drive.exchange(Command(Mode.DUTY, 0.3)).status is Status.ENABLED
    drive.idle(0.3)
    assert drive.plant.truth().current_a == 0.0
    with pytest.raises(DriveFault, match=r"switched itself off: watchdog: no command in time; .*clear the fault"):
        _duty(drive, 0.3)
    assert drive.exchange(OFF).status is Status.FAULT
    with pytest.raises(DriveStateError, match="clear the fault"):
        drive.enable(Mode.DUTY)
    drive.disable()
    assert drive.exchange(OFF).status is Status.FAULT
    drive.clear_fault()
    assert drive.exchange(OFF).status is Status.DISABLED


def test_unpowered_drive_has_nothing_for_the_watchdog_to_stop() -> None:
    drive = _drive()
    drive.idle(1.0)
    assert drive.exchange(OFF).status is Status.DISABLED


@pytest.mark.parametrize("duty", [1.001, -2.0, nan, float("inf")])
def test_impossible_demand_is_refused_before_time_passes(duty: float) -> None:
    drive = _drive()
    drive.enable(Mode.DUTY)
    with pytest.raises(DriveConfigurationError, match=r"duty"):
        _duty(drive, duty)
    assert drive.plant.time_s == 0.0


def test_nothing_works_before_open_or_after_close() -> None:
    drive = SimulatedDrive(presets.paper(), device="joint 1")
    for call in (drive.disable, drive.quick_stop, drive.clear_fault, lambda: drive.exchange(OFF)):
        with pytest.raises(DriveStateError, match=r"drive 'joint 1': .* before open; call open\(period_s\) first"):
            call()
    drive.open(PERIOD_S)
    drive.enable(Mode.DUTY)
    drive.close()
    drive.close()
    with pytest.raises(DriveStateError):
        _duty(drive, 0.1)


def test_technician_hangs_loads_only_without_power() -> None:
    drive = _drive()
    drive.enable(Mode.DUTY)
    _duty(drive, 0.3, 100)
    with pytest.raises(DriveStateError, match=r"only with power off, not 'enabled' \(duty\); disable it"):
        drive.hang_load(0.05, balanced=False)
    drive.disable()
    drive.hang_load(0.05, balanced=False)
    truth = drive.plant.truth()
    assert (truth.rotor_rad, truth.arm_rad, truth.rotor_rad_s) == (0.0, 0.0, 0.0)
    assert drive.plant.parameters.load.mass_kg == 0.05
    assert drive.exchange(OFF).position_rad == 0.0
    with pytest.raises(DriveConfigurationError, match=r"Load.mass_kg = -0.1 \[kg\]: must be at least 0"):
        drive.hang_load(-0.1, balanced=False)


def test_same_seed_and_commands_give_the_same_samples() -> None:
    def samples(seed: int) -> list[str]:
        drive = _drive(seed, current_sensor={"present": True, "noise_a": 0.01})
        drive.hang_load(0.1, balanced=False)
        drive.enable(Mode.DUTY)
        return [str(_duty(drive, duty)) for duty in (0.3, 0.0, 0.35, -0.1) for _ in range(100)]

    assert samples(5) == samples(5)
    assert samples(5) != samples(6)
