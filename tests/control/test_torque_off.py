"""Safe torque off is told as what it is: no power, and no fault of the joint."""

import pytest

from bench.control.drive_factory import make_equipment
from bench.control.ending import StopRequest
from bench.control.power.torque_off import torque_off
from bench.runs.connection import connect
from drivers.contract import Inspection, Mode, Status
from drivers.errors import DriveFault, DriveStateError
from tests.control.fake_drive import FakeDrive
from tests.control.loops import on_each, push, run
from tests.control.test_sim_faults import configured
from tests.experiments.bench_run import Ran

SAID = "safe torque off is active at drive 'sim' (its circuit is open); the joint is not at fault"


def test_a_run_is_refused_before_motion():
    outcome = Ran(configured({"kind": "torque-disabled", "at_s": 0.0}), "steps", repeats=1).outcomes[0]
    assert outcome.outcome == "refused"
    assert outcome.reason.startswith(SAID)
    assert "release the emergency stop" in outcome.reason
    assert "clear the fault" not in outcome.reason


def test_a_run_that_it_ends_says_so_even_where_another_error_was_met_first():
    outcome = Ran(configured({"kind": "torque-disabled", "at_s": 0.4}), "steps", repeats=1).outcomes[0]
    assert outcome.outcome == "failed"
    assert outcome.reason.startswith(SAID)
    assert "status is DISABLED during motion" in outcome.reason


@pytest.mark.parametrize("kind", ["over-current", "supply-lost", "over-temperature"])
def test_no_other_fault_is_taken_for_it(kind):
    outcome = Ran(configured({"kind": kind, "at_s": 0.4}), "steps", repeats=1).outcomes[0]
    assert "safe torque off" not in outcome.reason


def test_doctor_names_it():
    assert connect(configured({"kind": "torque-disabled", "at_s": 0.0})).torque_off.startswith(SAID)
    assert connect(configured()).torque_off == ""


NAMES = ["E-stop", "e-stop requested", "emergency stop", "0x5441, enable input (safe torque off)"]


@pytest.mark.parametrize("fault", NAMES)
def test_a_drive_that_keeps_it_as_a_fault_is_understood(fault):
    assert torque_off(Inspection(Status.FAULT, fault)) == fault
    assert torque_off(Inspection(Status.FAULT, "over-current")) == ""


class Open(FakeDrive):
    """A drive whose circuit is open; it notes with which state it was asked."""

    asked_after: tuple = ()

    def inspect(self):
        self.asked_after = tuple(self.calls)
        return Inspection(Status.FAULT, "E-stop")


@on_each
def test_the_drive_is_asked_when_the_power_is_off_and_not_before(setup):
    drive = Open(before=_fail_at_5)
    ran = run(setup, drive, push(setup, 1000), StopRequest())
    assert ran.outcome.outcome == "failed"
    assert f"{setup.prefix}safe torque off is active at drive 'fake' (E-stop)" in ran.outcome.reason
    assert "drive clear-fault" in ran.outcome.reason
    assert drive.asked_after[-1] == "disable"


def _fail_at_5(cycle):
    if cycle == 5:
        raise DriveFault("fake", "E-stop")


@on_each
def test_an_error_that_is_none_of_the_drive_asks_nothing(setup):
    drive = Open(before=lambda cycle: (_ for _ in ()).throw(ZeroDivisionError) if cycle == 5 else None)
    ran = run(setup, drive, push(setup, 1000), StopRequest())
    assert "safe torque off" not in ran.outcome.reason
    assert drive.asked_after == ()


def test_a_refused_start_in_process_names_its_circuit():
    drive = make_equipment(configured({"kind": "torque-disabled", "at_s": 0.0})).drive
    drive.open(0.005)
    with pytest.raises(DriveStateError, match="safe torque off is active"):
        drive.enable(Mode.DUTY)
