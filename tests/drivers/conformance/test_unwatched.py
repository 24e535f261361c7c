"""Drives without a watchdog: nothing stops the motor when the line fails. What the bench does instead, and says."""

import time

import pytest

from bench.runs.watchdog_proof import prove_watchdog
from drivers.contract import Command, Mode, Status, Watchdog
from drivers.errors import DriveConnectionError
from tests.drivers.conformance.benches import PERIOD_S
from tests.drivers.conformance.test_contract import PUSHES, cycles, push_mode
from tests.drivers.conformance.test_faults import Swinging, opens_again

GENTLE_A = 0.15
SILENT_S = 3.0  # closing gives up in a quarter of a second; a busy machine may take several times that


def opened_at_last(drive):
    """Open it anew; a port that is plugged in takes a moment."""
    drive.close()
    end_s = time.monotonic() + 10.0
    while True:
        try:
            return drive.open(PERIOD_S)
        except DriveConnectionError:
            assert time.monotonic() < end_s
            time.sleep(0.1)


@pytest.mark.parametrize(
    "name", ["silent", pytest.param("disconnect", marks=pytest.mark.real_wire("feetech")), "drop", "corrupt"]
)
def test_a_line_that_fails_ends_the_run_with_the_true_reason_and_off_when_it_is_back(unwatched, name):
    with unwatched.opened() as drive:
        swinging = Swinging(unwatched, drive, GENTLE_A)
        unwatched.device.side.ask("link", name=name)
        outcome = swinging.join()
        assert outcome.outcome == "failed"
        assert any(word in outcome.reason for word in ("gone", "found", "answer"))
        unwatched.device.side.ask("repair")
        assert name == "corrupt" or unwatched.device.truth()["powered"]  # a flipped bit may spoil another part
        opened_at_last(drive)  # the next word that gets through is power-off
        unwatched.device.wait_for_power(False)


def test_where_answers_alone_are_lost_power_off_gets_through(unwatched):
    with unwatched.opened() as drive:
        swinging = Swinging(unwatched, drive, GENTLE_A)
        unwatched.device.side.ask("link", name="drop", direction="from-device")
        assert swinging.join().outcome == "failed"
        unwatched.device.wait_for_power(False)
        opens_again(unwatched, drive)


def test_a_silent_host_is_not_noticed_and_the_record_says_so(unwatched):
    with unwatched.opened() as drive:
        mode = push_mode(drive)
        drive.enable(mode)
        cycles(drive, Command(mode, 0.3 * PUSHES[mode]), 3)
        time.sleep(1.0)
        assert unwatched.device.truth()["powered"], "it has a watchdog after all"
        assert drive.inspect().status is Status.ENABLED
        drive.disable()
        unwatched.device.wait_for_power(False)
        found = drive.describe()
    assert found.watchdog is Watchdog.NONE
    assert found.watchdog_s is None


def test_doctor_says_so_and_tries_nothing(unwatched):
    with unwatched.opened() as drive:
        found = prove_watchdog(drive, unwatched.configuration)
    assert found.watchdog is Watchdog.NONE
    assert found.is_admitted
    assert "has none" in found.sentence
    assert not unwatched.device.truth()["powered"]


def test_the_next_start_switches_off_what_a_killed_host_left_running(unwatched):
    with unwatched.opened() as drive:
        mode = push_mode(drive)
        drive.enable(mode)
        drive.exchange(Command(mode, 0.3 * PUSHES[mode]))
        unwatched.device.wait_for_power(True)
        unwatched.device.side.ask("link", name="silent", duration_s=SILENT_S)
        drive.close()  # as after SIGKILL: what it says is not heard
        assert unwatched.device.truth()["powered"]
        time.sleep(SILENT_S)
    with unwatched.opened() as again:
        unwatched.device.wait_for_power(False)
        assert again.exchange(Command(Mode.OFF)).status is Status.DISABLED
