"""What is the host's and what is the line's: a busy host is not called a slow line."""

import time

import pytest

from drivers import host_time
from drivers.errors import DriveConnectionError
from drivers.host_time import CycleTime, host_was_away, measure_cycle


def test_what_a_host_waits_for_its_processor_is_no_time_of_the_drive(monkeypatch):
    waits_s = iter(0.02 * turn for turn in range(100))  # 20 ms in each cycle, by the scheduler's word
    monkeypatch.setattr(host_time, "processor_wait_s", lambda: next(waits_s))
    found = measure_cycle(lambda: time.sleep(0.025))
    assert 0.004 < found.quickest_s < 0.02
    assert found.host_s == pytest.approx(0.02)
    assert found.note.startswith("this host is busy: a cycle waits for its processor for 20 ms")


@pytest.mark.parametrize("counted_late", [1, 15])
def test_a_wait_that_is_counted_in_the_cycle_after_makes_no_cycle_of_no_time(monkeypatch, counted_late):
    """A rate is one over it."""
    monkeypatch.setattr(host_time, "processor_wait_s", _counted(counted_late).__next__)
    assert 0.002 <= measure_cycle(lambda: time.sleep(0.002)).quickest_s < 0.1


def _counted(late_cycles):
    """The counter before and after each cycle: one second of waiting is counted in each of so many."""
    for cycle in range(100):
        yield float(min(cycle, late_cycles))
        yield float(min(cycle + 1, late_cycles))


def test_a_host_that_has_its_time_is_not_mentioned():
    assert CycleTime(0.002, 0.0001).note == ""


def test_the_system_tells_what_this_thread_has_waited():
    before_s = host_time.processor_wait_s()
    assert before_s >= 0.0
    assert host_time.processor_wait_s() >= before_s


def test_a_system_that_does_not_tell(monkeypatch, tmp_path):
    monkeypatch.setattr(host_time, "_SCHEDULER", tmp_path / "absent")
    assert host_time.processor_wait_s() == 0.0


def test_an_answer_that_failed_while_the_host_was_late_is_not_blamed_on_the_line_alone():
    assert host_was_away(0.11, 0.1, 0.05) == ""
    assert "this host itself was 80 ms late, so the line may be sound" in host_was_away(0.18, 0.1, 0.05)


def test_half_an_answer_and_a_late_host(answers, monkeypatch):
    """The rest of an answer that is there by the time the host looks again belongs to it."""
    drive = answers.opened()
    answers.pieces = True
    drive.exchange(answers.OFF)


def test_the_message_says_so(answers):
    drive = answers.opened()
    answers.corrupt, answers.delay_s = 1000, 0.08
    with pytest.raises(DriveConnectionError, match=r"this host itself was .* ms late, so the line may be sound"):
        drive.exchange(answers.OFF)


@pytest.fixture
def answers(monkeypatch):
    import serial

    from drivers.contract import Command, Mode
    from drivers.joint import JointScale
    from drivers.roboclaw.drive import RoboclawDrive
    from drivers.roboclaw.settings import RoboclawSettings
    from tests.drivers.roboclaw_answers import Answers

    class Hindered(Answers):
        OFF = Command(Mode.OFF)
        pieces, delay_s = False, 0.0

        def read(self, size):
            time.sleep(self.delay_s)
            if self.pieces and size > 1 and not self.sent[-1].startswith(b"\x80\x15"):
                return super().read(size - 1)
            return super().read(size)

        def opened(self):
            drive = RoboclawDrive(RoboclawSettings(port="/dev/ttyACM0", questions="in turn"), JointScale(4096, 20.0))
            drive.open(0.01)
            return drive

    made = Hindered()
    monkeypatch.setattr(serial, "Serial", made)
    return made
