"""What goes wrong on a bench, on each driver that has a wire. Each row ends the same way: the motor is off within the
drive's watchdog, the run is marked with the reason, nothing hangs, and the drive opens again.

The time at which the motor went off is the device's own; how quick the test's process is does not matter.
"""

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress

import pytest
import tomli_w

from bench.control.cycle import OFF, Action
from bench.control.drive_factory import make_equipment
from bench.control.ending import Outcome, StopRequest
from bench.provenance import provenance
from bench.store import Store
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConnectionError, DriveError
from tests.devices.device_process import Thread
from tests.devices.turns import no_turns
from tests.drivers.conformance.benches import (
    ADAPTER,
    ANSWER_TIMEOUT_S,
    BENCHES,
    PERIOD_S,
    PORTS,
    SERIAL,
    TCP,
    configured,
    run,
)

PUSH_A = 0.25
GENTLE_PUSH_A = 0.11  # just above static friction
HALF_SWING_S = 0.2
MARGIN_S = 0.4  # of the device: its tick, its thread on a busy machine
KILLED = ("roboclaw", "canopen", "modbus-tcp")  # that a silent host is seen by each, `test_contract` says
LAST_WORDS_S = 2.0 * ANSWER_TIMEOUT_S  # the host asks twice before it gives up; the watchdog counts from then on


def to_and_fro(push_a=PUSH_A):
    """Push the joint to and fro until something ends it; gives up after a while."""
    yield Action(OFF)
    began_s = time.monotonic()
    while time.monotonic() - began_s < 20.0:
        direction = 1.0 if int((time.monotonic() - began_s) / HALF_SWING_S) % 2 == 0 else -1.0
        yield Action(Command(Mode.CURRENT, direction * push_a), target_rad=0.0)
    return {}


class Swinging:
    """The joint of a bench in motion, in a thread; `outcome` is there when it has ended."""

    def __init__(self, bench, drive, push_a=PUSH_A):
        self.outcome: Outcome | None = None
        self.ended_s = 0.0
        self._bench, self._drive, self._push_a = bench, drive, push_a
        bench.device.side.hang_load(0.0, False)  # puts the arm back to angle 0
        self._stop = StopRequest()
        self._thread = Thread(target=self._run)
        self._thread.start()
        bench.device.wait_for_power(True, timeout_s=15.0)

    def _run(self):
        self.outcome, _ = run(self._bench, self._drive, to_and_fro(self._push_a), self._stop)
        self.ended_s = time.monotonic()

    def join(self, timeout_s=15.0):
        self._thread.join(timeout_s)
        assert not self._thread.is_alive(), "the run hangs"
        return self.outcome

    def stop(self):
        self._stop.ask("the test is over")
        self._thread.join(15.0)


def broken(bench, drive, kind, **values):
    """Break something while the joint moves. Returns the outcome, and how long the motor was on afterwards [s]."""
    swinging = Swinging(bench, drive)
    try:
        time.sleep(3.0 * PERIOD_S)
        before_s = time.monotonic()
        bench.device.side.ask(kind, **values)
        outcome = swinging.join()
        off_s = bench.device.wait_for_power(False)
        return outcome, off_s - before_s
    finally:
        swinging.stop()


def opens_again(bench, drive):
    """The drive opens and answers, after what was wrong has been put right."""
    bench.repair()
    deadline_s = time.monotonic() + 20.0
    while True:
        drive.close()
        try:
            drive.open(PERIOD_S)
            drive.clear_fault()
            drive.exchange(OFF)
            return
        except DriveError:  # a port that is plugged in takes a moment
            assert time.monotonic() < deadline_s
            time.sleep(0.1)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("disconnect", marks=pytest.mark.real_wire(*SERIAL, *ADAPTER, *TCP)),
        pytest.param("silent", marks=pytest.mark.real_wire(*TCP)),
        "drop",  # to the host the same silence
    ],
)
def test_the_cable_comes_out_in_mid_motion(watched, name):
    with watched.opened() as drive:
        outcome, on_s = broken(watched, drive, "link", name=name)
        assert outcome.outcome == "failed"
        assert any(
            word in outcome.reason
            for word in ("gone", "found", "answer", "heartbeat", "SYNC", "heard", "bus", "receiving")
        )
        assert on_s < LAST_WORDS_S + watched.watched_s + MARGIN_S
        opens_again(watched, drive)


def _corrupt_three(bench, drive):
    """Corrupt three packets, one at a time, of a joint in motion. Returns how the run ended; None where it went on."""
    # the demand stands while an answer is waited for: a hard push would carry the joint to its limits meanwhile
    swinging = Swinging(bench, drive, GENTLE_PUSH_A)
    for _ in range(3):
        bench.device.side.ask("link", name="corrupt", packets=1)
        time.sleep(LAST_WORDS_S)  # two in one question are more than one corrupted packet
    swinging.stop()  # where it was about to end by itself, that comes first
    return None if swinging.outcome.outcome == "stopped" else swinging.outcome


@pytest.mark.real_wire(*TCP)
def test_one_corrupted_packet_does_not_end_the_run(wired):
    if not wired.variant.is_checked:
        pytest.skip(f"{wired.name}: the line's packets have no check of their own")
    with wired.opened() as drive:
        assert _corrupt_three(wired, drive) is None


@pytest.mark.real_wire(*TCP)
def test_a_corrupted_packet_of_a_line_without_a_check_at_most_trips_a_limit(wired):
    """A flipped bit may read as another value. What the limits allow goes on, what they do not ends in power-off."""
    if wired.variant.is_checked is not False:
        pytest.skip(f"{wired.name}: a packet arrives as it was sent, or is known to be wrong")
    with wired.opened() as drive:
        ended = _corrupt_three(wired, drive)
        assert ended is None or ended.outcome in ("tripped", "failed")
        assert ended is None or ended.reason
        wired.device.wait_for_power(False)
        opens_again(wired, drive)


@pytest.mark.real_wire(*TCP)
def test_a_line_that_corrupts_everything_ends_in_power_off(watched):
    with watched.opened() as drive:
        outcome, on_s = broken(watched, drive, "link", name="corrupt")
        # where no packet has a check, a flipped bit may read as a value beyond a limit first
        assert outcome.outcome in (("failed",) if watched.variant.is_checked else ("failed", "tripped"))
        # there the host's words still feed the watchdog, too: those of its last question, then those of its quick stop
        words_s = LAST_WORDS_S if watched.variant.is_checked else 2.0 * LAST_WORDS_S
        assert on_s < words_s + watched.watched_s + MARGIN_S
        opens_again(watched, drive)


@pytest.mark.parametrize("name", ["over-current", "drive-failed", "supply-lost"])
def test_a_fault_of_the_drive_while_the_demand_rises(wired, name):
    with wired.opened() as drive:
        outcome, on_s = broken(wired, drive, "fault", name=name)
        assert outcome.outcome == "failed"
        assert outcome.reason
        assert on_s < MARGIN_S  # the drive itself, at once
        opens_again(wired, drive)


def test_an_encoder_that_stands_still_trips_a_limit_or_is_noticed(wired):
    """The joint moves on, its measured position does not: what the position servo would chase."""
    tight = wired.configuration.limits.model_copy(update={"tracking_error_rad": 0.02})
    with wired.opened() as drive:
        bench = wired.changed(limits=tight)
        wired.device.side.ask("fault", name="encoder-stuck")
        outcome, _ = run(bench, drive, _far_away(), StopRequest())
        assert outcome.outcome == "tripped"
        assert "tracking error" in outcome.reason
        wired.device.wait_for_power(False)


def _far_away():
    yield Action(OFF)
    for cycle in range(500):
        yield Action(Command(Mode.CURRENT, 0.0), target_rad=1e-4 * cycle)
    return {}


def exchange_until_it_fails(drive):
    for _ in range(100):
        drive.exchange(OFF)
        time.sleep(PERIOD_S)


@pytest.mark.real_wire(*PORTS)
def test_a_port_that_is_gone_and_comes_back(wired):
    with wired.opened() as drive:
        wired.device.side.ask("link", name="disconnect", duration_s=0.6)
        with pytest.raises(DriveConnectionError):
            exchange_until_it_fails(drive)
        opens_again(wired, drive)


def test_a_wrong_address_is_an_error_that_names_it(wired):
    key, address = wired.variant.wrong_address
    values = wired.configuration.drive.model_dump() | {key: address}
    drive = make_equipment(configured(**values)).drive
    began_s = time.monotonic()
    with pytest.raises(DriveError) as error:
        drive.open(PERIOD_S)
    drive.close()
    assert str(address) in str(error.value) or hex(address) in str(error.value)
    assert time.monotonic() - began_s < drive.describe().longest_open_s + 5.0


@pytest.mark.real_wire("roboclaw", *ADAPTER, "modbus-tcp")  # `canopen-socketcand` is silent in motion, too
def test_every_call_is_bounded_while_the_device_is_silent(wired):
    with wired.opened() as drive:
        longest_s = drive.describe().longest_call_s
        assert longest_s >= ANSWER_TIMEOUT_S
        wired.device.side.ask("link", name="silent")
        for call in (lambda: drive.exchange(OFF), drive.disable, drive.quick_stop, drive.clear_fault, drive.close):
            began_s = time.monotonic()
            with suppress(DriveError):
                call()
            assert time.monotonic() - began_s < longest_s + 2.0  # a busy machine's share
        opens_again(wired, drive)


def _pass_commissioning(store, configuration, found):
    """Have the store remember that this drive has passed, as `test_trials` does by the move itself."""
    told = provenance(configuration, found)
    passed = store.begin_experiment("commissioning", {}, "simulated", told, configuration.rig.model_dump(mode="json"))
    store.finish_experiment(passed, "completed")


@pytest.mark.wall_clock  # it is a process
@pytest.mark.parametrize("running", [name for name in BENCHES if name in KILLED], indirect=True)
def test_a_host_that_is_killed_in_mid_motion(watched, tmp_path):
    """SIGKILL: nobody says good-bye. The drive stops by itself; the record says so when the store is opened again."""
    url = f"sqlite:///{tmp_path / 'bench.sqlite'}"
    configuration = tmp_path / "bench.toml"
    configuration.write_text(tomli_w.dumps(watched.configuration.model_dump(mode="json", exclude_none=True)))
    with Store.open(url) as store, watched.opened() as drive:
        _pass_commissioning(store, watched.configuration, drive.describe())
    words = ["--config", str(configuration), "--store", url, "run", "steps", "--load-kg", "0", "--repeats", "3"]
    with no_turns():  # it asks for those of its loop by itself
        host = subprocess.Popen(
            [sys.executable, "-m", "bench.cli", *words], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL
        )
    try:
        host.stdin.write(b"\n")
        host.stdin.flush()
        watched.device.wait_for_power(True, timeout_s=60.0)
        time.sleep(0.3)
        killed_s = time.monotonic()
        os.kill(host.pid, signal.SIGKILL)
        host.wait(10.0)
        off_s = watched.device.wait_for_power(False)
    finally:
        host.kill()
        host.stdin.close()
        host.wait()
    assert off_s - killed_s < watched.watched_s + MARGIN_S, "the drive's watchdog did not stop it"
    with Store.open(url) as store:
        newest = store.experiments()[0]
        assert (newest.kind, newest.outcome) == ("steps", "interrupted")
    # the last torque stood until the watchdog: the arm may have run beyond what a frame of positions can tell
    watched.device.side.hang_load(0.0, False)
    with watched.opened() as drive:
        assert drive.exchange(OFF).status is Status.DISABLED, "the next start would need somebody to clear a fault"
        opens_again(watched, drive)
