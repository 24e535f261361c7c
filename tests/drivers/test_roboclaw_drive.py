"""The RoboClaw driver against answers given as bytes."""

import time
from math import isnan, pi

import pytest
import serial

from drivers.contract import Command, Mode, Status
from drivers.errors import (
    DriveConfigurationError,
    DriveConnectionError,
    DriveFault,
    DriveStateError,
    WatchdogError,
)
from drivers.joint import JointScale
from drivers.roboclaw.drive import RoboclawDrive
from drivers.roboclaw.settings import RoboclawSettings
from tests.drivers.roboclaw_answers import Answers

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
COUNT_RAD = 2 * pi / 4096 / 20
OFF = Command(Mode.OFF)


@pytest.fixture
def answers(monkeypatch):
    made = Answers()
    monkeypatch.setattr(serial, "Serial", made)
    return made


def opened(joint=JOINT, period_s=0.01, **settings):
    drive = RoboclawDrive(RoboclawSettings(port="/dev/ttyACM0", **settings), joint)
    drive.open(period_s)
    return drive


def duty(value):
    return Command(Mode.DUTY, value)


def test_the_conversation_of_opening(answers):
    opened()
    assert [packet.hex(" ") for packet in answers.sent[:5]] == [
        "80 15",  # who is there
        "80 20 00 00 5b fe",  # motor M1 off
        "80 0e 02 38 17",  # serial time-out 0.2 s
        "80 0f",  # and read back
        "80 10",  # encoder
    ]


def test_a_cycle_asks_in_this_order(answers):
    drive = opened(slow_every=100, questions="in turn")
    drive.enable(Mode.DUTY)
    answers.sent.clear()
    drive.exchange(duty(0.5))
    assert [packet.hex(" ") for packet in answers.sent] == ["80 20 40 00 56 32", "80 10", "80 12", "80 30", "80 31"]


def test_questions_asked_together_go_out_in_one_write(answers):
    drive = opened(slow_every=100, questions="together")
    drive.enable(Mode.DUTY)
    answers.sent.clear()
    drive.exchange(duty(0.5))
    assert [packet.hex(" ") for packet in answers.sent] == ["80 20 40 00 56 32 80 10 80 12 80 30 80 31"]


def test_a_controller_that_does_not_answer_them_together_is_refused(answers):
    answers.buffered = False
    with pytest.raises(DriveConfigurationError, match=r'set drive.questions = "in turn"'):
        opened(questions="together")
    assert answers.closed


@pytest.mark.parametrize("buffered", [True, False])
def test_where_nothing_is_said_a_cycle_is_one_write_if_the_controller_can(answers, buffered):
    answers.buffered = buffered
    drive = opened(slow_every=100)
    answers.sent.clear()
    drive.exchange(OFF)
    assert len(answers.sent) == (1 if buffered else 5)


def test_together_what_was_not_answered_whole_is_asked_in_turn(answers):
    drive = opened(slow_every=100, questions="together")
    drive.enable(Mode.DUTY)
    answers.sent.clear()
    answers.corrupt = 1
    sample = drive.exchange(duty(0.5))
    assert sample.status is Status.ENABLED
    assert [packet.hex(" ") for packet in answers.sent[1:]] == [
        "80 20 40 00 56 32", "80 10", "80 12", "80 30", "80 31",
    ]  # fmt: skip
    assert answers.duties[-2:] == [16384, 16384]


@pytest.mark.parametrize("questions", ["in turn", "together"])
def test_a_sample_in_si_units(answers, questions):
    drive = opened(questions=questions)
    drive.enable(Mode.DUTY)
    answers.data[16] = (1000).to_bytes(4, "big") + b"\0"
    answers.data[48] = (16384).to_bytes(2, "big") + (-1).to_bytes(2, "big", signed=True)
    answers.data[49] = (-150).to_bytes(2, "big", signed=True) + (7).to_bytes(2, "big")
    sample = drive.exchange(duty(0.5))
    assert sample.position_rad == pytest.approx(1000 * COUNT_RAD)
    assert sample.duty == pytest.approx(16384 / 32767)
    assert sample.current_a == pytest.approx(-1.5)
    assert (sample.supply_v, sample.temperature_c) == (pytest.approx(24.0), pytest.approx(30.5))
    assert sample.status is Status.ENABLED
    assert 0.0 < sample.ages.duty_s <= sample.ages.position_s == sample.age_s
    assert answers.duties[-1] == 16384


def test_signs_zero_and_the_second_motor(answers):
    joint = JointScale(counts_per_turn=4096, gear_ratio=20.0, motor_sign=-1, encoder_sign=-1, zero_rad=0.25)
    answers.data[17] = (0xFFFFFC18).to_bytes(4, "big") + b"\x02"  # -1000
    answers.data[48] = bytes(2) + (-16384).to_bytes(2, "big", signed=True)
    answers.data[49] = bytes(2) + (-150).to_bytes(2, "big", signed=True)
    drive = opened(joint, motor=2)
    drive.enable(Mode.DUTY)
    sample = drive.exchange(duty(0.5))
    assert sample.position_rad == pytest.approx(1000 * COUNT_RAD - 0.25)
    assert (sample.duty, sample.current_a) == (pytest.approx(0.5, abs=1e-4), pytest.approx(1.5))
    assert answers.duties[-1] == -16384


def test_a_current_without_sign_takes_that_of_the_duty(answers):
    answers.data[48] = (-16384).to_bytes(2, "big", signed=True) + bytes(2)
    answers.data[49] = (150).to_bytes(2, "big") + bytes(2)
    assert opened(current="magnitude").exchange(OFF).current_a == pytest.approx(-1.5)


def test_speed_where_it_is_wanted(answers):
    answers.data[18] = (-2000).to_bytes(4, "big", signed=True) + b"\x01"
    assert opened().exchange(OFF).velocity_rad_s == pytest.approx(-2000 * COUNT_RAD)
    assert isnan(opened(velocity="none").exchange(OFF).velocity_rad_s)  # left to the loop, which derives it


def test_firmware_that_gives_a_magnitude_has_the_sign_in_the_direction_byte(answers):
    answers.data[18] = (2000).to_bytes(4, "big") + b"\x01"
    assert opened().exchange(OFF).velocity_rad_s == pytest.approx(-2000 * COUNT_RAD)
    answers.data[18] = (2000).to_bytes(4, "big") + b"\x00"
    assert opened().exchange(OFF).velocity_rad_s == pytest.approx(2000 * COUNT_RAD)


@pytest.mark.parametrize(("motor", "number"), [(1, 133), (2, 134)])
def test_a_current_limit_is_set_and_read_back(answers, motor, number):
    opened(motor=motor, current_limit_a=2.5)
    [packet] = [packet for packet in answers.sent if packet[1] == number]
    assert packet[2:10].hex(" ") == "00 00 00 fa 00 00 00 00"  # 250 x 10 mA, and no lower limit


def test_a_current_limit_that_does_not_read_back_is_refused(answers):
    answers.keeps_limit = False
    answers.data[135] = (1500).to_bytes(4, "big") + bytes(4)
    with pytest.raises(DriveConfigurationError, match=r"current limit reads back as 15 A, set was 2.5 A"):
        opened(current_limit_a=2.5)
    assert answers.closed


def test_without_a_current_limit_that_of_the_controller_stays(answers):
    opened()
    assert not [packet for packet in answers.sent if packet[1] in (133, 134)]


def test_what_is_not_answered_is_not_measured(answers):
    answers.data |= {18: None, 49: None, 82: None}
    drive = opened()
    sample = drive.exchange(OFF)
    assert isnan(sample.current_a)
    assert isnan(sample.temperature_c)
    assert drive.describe().measured == {"time_s", "position_rad", "duty", "supply_v"}


def test_older_firmware_answers_the_status_in_two_bytes(answers):
    answers.data[90] = (0x0001).to_bytes(2, "big")  # a warning there; an E-stop in the other layout
    drive = opened()
    drive.enable(Mode.DUTY)
    answers.data[90] = (0x0004).to_bytes(2, "big")
    with pytest.raises(DriveStateError, match="E-stop"):
        drive.enable(Mode.DUTY)


def test_a_line_that_fails_while_the_layout_of_the_status_is_found_out(answers):
    answer, failed = answers._answer, []

    def fails_at_first(packet):
        if packet[1] == 90 and len(failed) < 2:
            failed.append(packet)
            return b""
        return answer(packet)

    answers._answer = fails_at_first
    drive = opened()
    answers.data[90] = (0x0000_1000).to_bytes(4, "big")  # M1 current error, in the layout of four bytes
    with pytest.raises(DriveStateError, match="M1 current error"):
        drive.enable(Mode.DUTY)


def test_what_it_says_of_itself(answers):
    found = opened().describe()
    assert (found.vendor, found.product, found.firmware) == ("Basicmicro", "USB Roboclaw 2x15a", "4.1.34")
    assert (found.simulated, found.watchdog_s, found.modes) == (False, 0.2, {Mode.DUTY})
    assert found.max_rate_hz > 0.0
    assert found.resolution["position_rad"] == pytest.approx(COUNT_RAD)


def test_the_watchdog_is_read_back(answers):
    answers.data[15], answers.keeps_timeout = bytes([9]), False
    with pytest.raises(WatchdogError, match=r"reads back as 0.9 s, set was 0.2 s"):
        opened()
    assert answers.closed


def test_a_watchdog_shorter_than_the_period_is_refused(answers):
    with pytest.raises(DriveConfigurationError, match=r"would be 0.1 s, and the control period is 0.1 s"):
        opened(period_s=0.1, watchdog_s=0.1)
    assert answers.sent == []


def test_one_corrupted_answer_is_asked_for_again_after_a_silence(answers):
    drive = opened()
    answers.corrupt = 1
    began_s = time.perf_counter()
    drive.exchange(OFF)
    assert time.perf_counter() - began_s >= 0.010


def test_a_line_that_stays_corrupted_is_an_error(answers):
    drive = opened()
    answers.data[16] = bytes(5)
    answers.corrupt = 1000
    with pytest.raises(DriveConnectionError, match="instead of ff"):
        drive.exchange(OFF)


def test_who_does_not_answer_in_motion_is_left_in_silence(answers):
    """Every byte may put off the serial time-out: retries would keep the motor on."""
    drive = opened()
    drive.enable(Mode.DUTY)
    drive.exchange(duty(0.5))
    answers.corrupt = 1000
    with pytest.raises(DriveConnectionError, match="instead of ff"):
        drive.exchange(duty(0.5))
    assert answers.duties[-1] == 0  # the last word
    answers.sent.clear()
    for call in (drive.quick_stop, drive.disable, lambda: drive.exchange(OFF)):
        with pytest.raises(
            DriveConnectionError, match=r"left in silence so that its serial time-out \(0.2 s\) stops the"
        ):
            call()
    drive.close()
    assert answers.sent == []
    answers.corrupt = 0
    drive.open(0.01)
    drive.exchange(OFF)


def test_a_wrong_address_is_named(answers):
    with pytest.raises(DriveConnectionError, match=r"address 0x81 M1.*found nothing.*the address \(0x81\)"):
        opened(address=0x81)
    assert answers.closed


def test_a_port_that_is_not_there(answers):
    with pytest.raises(DriveConnectionError, match="could not open port /dev/absent"):
        RoboclawDrive(RoboclawSettings(port="/dev/absent"), JOINT).open(0.01)


def test_something_else_answers(answers):
    answers.data[21] = b"SDC2130 v1.8\n\0"
    with pytest.raises(DriveConfigurationError, match=r"calls itself 'SDC2130 v1.8'; a RoboClaw is wanted"):
        opened()


@pytest.mark.parametrize("value", [1.01, -2.0, float("nan"), float("inf")])
def test_an_impossible_duty_is_not_sent(answers, value):
    drive = opened()
    drive.enable(Mode.DUTY)
    answers.sent.clear()
    with pytest.raises(DriveConfigurationError, match=r"duty demand is .*; -1 .. 1 is allowed"):
        drive.exchange(duty(value))
    assert answers.sent == []


def test_states(answers):
    drive = RoboclawDrive(RoboclawSettings(port="/dev/ttyACM0"), JOINT)
    with pytest.raises(DriveStateError, match="exchange before open"):
        drive.exchange(OFF)
    drive.open(0.01)
    with pytest.raises(DriveStateError, match="a duty was demanded in state disabled"):
        drive.exchange(duty(0.1))
    with pytest.raises(DriveConfigurationError, match="has no mode 'current', only duty"):
        drive.enable(Mode.CURRENT)
    drive.enable(Mode.DUTY)
    assert drive.exchange(duty(0.1)).status is Status.ENABLED
    drive.disable()
    assert answers.duties[-1] == 0
    assert drive.exchange(OFF).status is Status.DISABLED
    drive.close()
    drive.close()
    assert answers.closed


def test_a_quick_stop_lasts_until_the_count_stands(answers):
    drive = opened()
    drive.enable(Mode.DUTY)
    drive.exchange(duty(0.5))
    drive.quick_stop()
    assert answers.duties[-1] == 0
    found = []
    for count in (10, 20, 25, 25, 25, 25, 25):
        answers.data[16] = count.to_bytes(4, "big") + b"\0"
        found.append(drive.exchange(OFF).status)
    assert found == [Status.QUICK_STOP] * 6 + [Status.DISABLED]


def test_a_fault_takes_the_demand_back_and_is_named(answers):
    drive = opened(slow_every=1)
    drive.enable(Mode.DUTY)
    drive.exchange(duty(0.5))
    answers.data[90] = (0x41).to_bytes(4, "big")
    sample = next(found for found in iter(lambda: drive.exchange(duty(0.5)), None) if found.status is Status.FAULT)
    assert sample.status is Status.FAULT
    assert answers.duties[-1] == 0
    with pytest.raises(DriveFault, match="E-stop, M1 driver fault; remove the cause, then clear the fault"):
        drive.exchange(duty(0.5))
    with pytest.raises(DriveFault, match="cannot be cleared: E-stop"):
        drive.clear_fault()
    assert drive.exchange(OFF).status is Status.FAULT
    answers.data[90] = bytes(4)
    drive.clear_fault()
    assert drive.exchange(OFF).status is Status.DISABLED


def test_a_motor_that_is_switched_off_is_asked_why_at_once(answers):
    drive = opened(slow_every=100)
    drive.enable(Mode.DUTY)
    drive.exchange(duty(0.5))
    answers.data[90] = (0x01).to_bytes(4, "big")  # and the applied PWM is 0
    assert drive.exchange(duty(0.5)).status is Status.FAULT


def test_a_host_that_was_late_is_told_that_the_watchdog_has_acted(answers):
    drive = opened(watchdog_s=0.1)
    drive.enable(Mode.DUTY)
    drive.exchange(duty(0.5))
    time.sleep(0.15)
    with pytest.raises(DriveFault, match=r"no demand for .*, and its serial time-out allows 0.1 s: .* switched off"):
        drive.exchange(duty(0.5))
    assert answers.duties[-1] == 0
    with pytest.raises(DriveStateError, match="enable duty mode first"):
        drive.exchange(duty(0.5))


def test_a_port_that_goes_away(answers):
    drive = opened()
    drive.enable(Mode.DUTY)

    def gone(_packet):
        raise serial.SerialException("write failed: [Errno 5] Input/output error")

    answers.write = gone
    with pytest.raises(DriveConnectionError, match=r"the port is gone .*plug it in, then start again"):
        drive.exchange(duty(0.5))
    drive.close()
    assert answers.closed
