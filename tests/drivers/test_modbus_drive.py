"""The Modbus driver against registers behind a socket, and against bytes on a serial line."""

import os
import socket
import threading
import time
import tty
from math import isnan, pi
from struct import pack

import pytest

from drivers.contract import Command, Mode, Status
from drivers.errors import (
    DriveConfigurationError,
    DriveConnectionError,
    DriveFault,
    DriveStateError,
    WatchdogError,
)
from drivers.joint import JointScale
from drivers.modbus.blocks import Block
from drivers.modbus.drive import ModbusDrive
from drivers.modbus.link import Link
from drivers.modbus.map_file import load_map, parse_map
from drivers.modbus.register import Number, Register, Space
from drivers.modbus.settings import ModbusSettings
from tests.drivers.modbus_answers import MAP, Answers

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
COUNT_RAD = 2 * pi / 4096 / 20
OFF = Command(Mode.OFF)
TIMEOUT_S = 0.2


@pytest.fixture
def answers():
    with Answers() as server:
        yield server
        server.shutdown()


@pytest.fixture
def made(answers):
    """Makes drives, and closes them."""
    drives = []

    def make(joint=JOINT, text=MAP, **settings):
        found = ModbusSettings(map="test", transport="tcp", port=answers.port, answer_timeout_s=TIMEOUT_S, **settings)
        drives.append(ModbusDrive(found, parse_map(text, "map"), joint))
        return drives[-1]

    yield make
    for drive in drives:
        drive.close()


@pytest.fixture
def drive(made):
    opened = made()
    opened.open(0.01)
    return opened


def test_the_conversation_of_opening(answers, drive):
    assert [pdu.hex(" ") for pdu in answers.sent[:6]] == [
        "04 00 00 00 01",  # family
        "04 00 01 00 01",  # firmware
        # off, and the state: function 23 reads 8 words at 20 and writes 6 at 10
        "17 00 14 00 08 00 0a 00 06 0c 00 00 00 00 00 00 00 00 00 00 00 00",
        "06 00 64 00 c8",  # watchdog 200 ms
        "03 00 64 00 01",  # and read back
        "04 00 05 00 02",  # supply and temperature
    ]
    assert drive.describe().firmware == "2.07"
    assert drive.describe().watchdog_s == 0.2
    assert drive.describe().max_rate_hz > 0.0


def test_a_cycle_is_one_request(answers, drive):
    drive.enable(Mode.DUTY)
    answers.sent.clear()
    drive.exchange(Command(Mode.DUTY, -0.25))
    assert [pdu.hex(" ") for pdu in answers.sent] == [
        "17 00 14 00 08 00 0a 00 06 0c 00 01 00 01 f6 3c 00 00 00 00 00 00"
    ]


def test_a_drive_without_that_function_takes_two(answers, made):
    drive = made(text=MAP.replace("read_write = true", ""))
    drive.open(0.01)
    drive.enable(Mode.CURRENT)
    answers.sent.clear()
    drive.exchange(Command(Mode.CURRENT, 1.5))
    assert [pdu.hex(" ") for pdu in answers.sent] == [
        "10 00 0a 00 06 0c 00 01 00 02 00 00 05 dc 00 00 00 00",
        "03 00 14 00 08",
    ]


def test_a_drive_that_takes_function_16_alone(answers, made):
    answers.unknown = frozenset({6})
    with pytest.raises(WatchdogError, match="exception 1, the drive does not know this function"):
        made().open(0.01)
    made(text=f"write_function = 16\n{MAP}").open(0.01)
    assert "10 00 64 00 01 02 00 c8" in [pdu.hex(" ") for pdu in answers.sent]  # the watchdog, a single word


def test_a_drive_that_takes_function_6_alone(answers, made):
    answers.unknown = frozenset({16, 23})
    drive = made(text=f"write_function = 6\n{MAP.replace('read_write = true', '')}")
    drive.open(0.01)
    drive.enable(Mode.POSITION)
    answers.sent.clear()
    drive.exchange(Command(Mode.POSITION, 70000 * COUNT_RAD))
    assert [pdu.hex(" ") for pdu in answers.sent] == [
        "06 00 0a 00 01", "06 00 0b 00 03", "06 00 0c 00 00", "06 00 0d 00 00", "06 00 0e 00 01", "06 00 0f 11 70",
        "03 00 14 00 08",
    ]  # fmt: skip


COILS = (
    MAP.replace("read_write = true", "")
    .replace('[control]\nregister = "control"', '[control]\nregister = "run"')
    .replace("quick_stop = 2\nclear_fault = 8\n", "")
    .replace('register = "status"\nmask = 0x0F\nenabled = 1\nquick_stop = 2\nfault = 4', 'register = "on"\nenabled = 1')
    + """
[[register]]
name = "run"
space = "coil"
address = 0
type = "bit"
[[register]]
name = "on"
space = "discrete"
address = 8
type = "bit"
"""
)


def test_a_drive_that_is_switched_by_a_coil_and_tells_its_state_in_a_discrete_input(answers, made):
    drive = made(text=COILS)
    drive.open(0.01)
    assert drive.exchange(OFF).status is Status.DISABLED
    answers.sent.clear()
    drive.enable(Mode.DUTY)
    assert {"05 00 00 ff 00", "02 00 08 00 01"} <= {pdu.hex(" ") for pdu in answers.sent}
    assert drive.exchange(Command(Mode.DUTY, 0.1)).status is Status.ENABLED
    drive.disable()
    assert answers.coils[0] == 0
    assert drive.exchange(OFF).status is Status.DISABLED


@pytest.mark.parametrize(("slips", "refusal"), [(0, None), (100, "current limit reads back as 2.6 A, set was 2.5 A")])
def test_a_current_limit_is_set_and_read_back(answers, made, slips, refusal):
    text = MAP + (
        '[limits]\ncurrent_a = "limit"\n[[register]]\nname = "limit"\nspace = "holding"\naddress = 101\n'
        'type = "uint16"\nscale = 1e-3\nunit = "A"\n'
    )
    answers.holding[101], answers.slips_at = 0, {101: slips}
    drive = made(text=text, current_limit_a=2.5)
    if refusal is None:
        drive.open(0.01)
        assert answers.holding[101] == 2500
        return
    with pytest.raises(DriveConfigurationError, match=refusal):
        drive.open(0.01)


def test_a_current_limit_that_the_map_has_no_register_for_is_refused(made):
    with pytest.raises(DriveConfigurationError, match=r"has no register for a current limit \(\[limits\] current_a\)"):
        made(current_limit_a=2.5).open(0.01)


def test_what_a_watchdog_needs_elsewhere_is_set_and_read_back(answers, made):
    needs = MAP.replace("fault = 0x8130", "fault = 0x8130\nneeds = { action = 2 }") + (
        '[[register]]\nname = "action"\nspace = "holding"\naddress = 101\ntype = "uint16"\n'
    )
    answers.holding[101] = 0
    made(text=needs).open(0.01)
    assert answers.holding[101] == 2
    answers.slips_at = {101: 1}
    with pytest.raises(WatchdogError, match="its watchdog needs action = 2; it reads back as 3"):
        made(text=needs).open(0.01)


def test_a_sample_in_si_units(answers, drive):
    velocity = pack(">f", 2000.0)
    answers.holding |= {22: 0xFFFF, 23: 0xFC18}  # -1000 counts
    answers.holding |= {24: int.from_bytes(velocity[2:], "big"), 25: int.from_bytes(velocity[:2], "big")}
    answers.holding |= {26: 2500, 27: 0xFA24}
    sample = drive.exchange(OFF)
    assert sample.position_rad == pytest.approx(-1000 * COUNT_RAD)
    assert sample.velocity_rad_s == pytest.approx(2000 * COUNT_RAD)
    assert (sample.duty, sample.current_a) == (pytest.approx(0.25), pytest.approx(-1.5))
    assert (sample.supply_v, sample.temperature_c) == (pytest.approx(24.0), pytest.approx(25.0))
    assert 0.0 <= sample.age_s < sample.ages.supply_s


def test_signs_and_zero(answers, made):
    drive = made(JointScale(4096, 20.0, motor_sign=-1, encoder_sign=-1, zero_rad=0.1))
    drive.open(0.01)
    answers.holding |= {23: 1000, 26: 2500}
    sample = drive.exchange(OFF)
    assert sample.position_rad == pytest.approx(-1000 * COUNT_RAD - 0.1)
    assert sample.duty == pytest.approx(-0.25)
    drive.enable(Mode.POSITION)
    drive.exchange(Command(Mode.POSITION, 0.2))
    counts = round(-0.3 / COUNT_RAD)
    assert (answers.holding[14] << 16 | answers.holding[15]) == counts % 2**32


def test_enabling_a_position_loop_holds_the_joint_where_it_is(answers, drive):
    answers.holding[23] = 1234
    drive.enable(Mode.POSITION)
    assert (answers.holding[14], answers.holding[15]) == (0, 1234)


def test_what_is_not_in_the_map_is_not_measured(answers, made):
    text = MAP.replace('current_a = "current"\n', "").replace('temperature_c = "temperature"\n', "")
    drive = made(text=text)
    drive.open(0.01)
    sample = drive.exchange(OFF)
    assert isnan(sample.current_a)
    assert isnan(sample.temperature_c)
    assert "current_a" not in drive.describe().measured


def test_states_follow_what_the_drive_says(answers, drive):
    with pytest.raises(DriveStateError, match="a duty was demanded in state disabled; enable duty mode first"):
        drive.exchange(Command(Mode.DUTY, 0.1))
    drive.enable(Mode.DUTY)
    assert drive.exchange(Command(Mode.DUTY, 0.1)).status is Status.ENABLED
    with pytest.raises(DriveStateError, match="enable current mode first"):
        drive.exchange(Command(Mode.CURRENT, 0.1))
    drive.quick_stop()
    assert drive.exchange(OFF).status is Status.QUICK_STOP
    assert answers.holding[10] == 2  # an OFF of the loop does not end the braking
    answers.obeys, answers.holding[20] = False, 0
    assert drive.exchange(OFF).status is Status.DISABLED
    drive.exchange(OFF)
    assert answers.holding[10] == 0


def test_a_drive_that_does_not_switch_on(answers, drive):
    answers.obeys = False
    with pytest.raises(DriveStateError, match="cannot be enabled: disabled; remove the cause"):
        drive.enable(Mode.DUTY)
    with pytest.raises(DriveStateError):
        drive.exchange(Command(Mode.DUTY, 0.1))


def cleared(answers):
    """Whether the word that clears a fault was written (register 10, in the first place of the written block)."""
    return any(frame.hex(" ").split()[10:12] == ["00", "08"] for frame in answers.sent)


@pytest.mark.parametrize(("fault", "is_forgiven"), [(0x8130, True), (0x2310, False)])
def test_only_the_watchdogs_fault_is_cleared_by_the_next_host(answers, made, fault, is_forgiven):
    answers.obeys = False
    answers.holding |= {20: 4, 21: fault}
    made().open(0.01)
    assert cleared(answers) is is_forgiven


def test_a_fault_is_named_and_cleared(answers, drive):
    drive.enable(Mode.DUTY)
    answers.obeys = False
    answers.holding |= {20: 4, 21: 0x2310}
    assert drive.exchange(Command(Mode.DUTY, 0.1)).status is Status.FAULT
    with pytest.raises(DriveFault, match="has switched itself off: over-current; remove the cause, then clear the"):
        drive.exchange(Command(Mode.DUTY, 0.1))
    with pytest.raises(DriveFault, match="cannot be cleared: over-current"):
        drive.clear_fault()
    answers.obeys = True
    answers.holding |= {20: 0, 21: 0}
    drive.clear_fault()
    assert answers.sent[-2].hex(" ").split()[10:12] == ["00", "08"]
    assert drive.exchange(OFF).status is Status.DISABLED


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (Command(Mode.DUTY, 1.5), r"duty demand is 1.5; -1 .. 1 is allowed"),
        (Command(Mode.DUTY, float("nan")), "duty demand is nan"),
    ],
)
def test_an_impossible_demand_is_not_sent(answers, drive, command, message):
    drive.enable(Mode.DUTY)
    answers.sent.clear()
    with pytest.raises(DriveConfigurationError, match=message):
        drive.exchange(command)
    assert answers.sent == []


def test_a_demand_that_its_register_does_not_hold_is_not_sent(answers, drive):
    drive.enable(Mode.CURRENT)
    answers.sent.clear()
    with pytest.raises(DriveConfigurationError, match=r"current_demand is 40 A; its register holds -32.768 .. 32.767"):
        drive.exchange(Command(Mode.CURRENT, 40.0))
    assert answers.sent == []


def test_another_family_is_refused(answers, made):
    answers.input[0] = 0x1111
    with pytest.raises(DriveConfigurationError, match="family is 0x1111; a test drive has 0x4242"):
        made().open(0.01)


def test_the_watchdog_is_read_back(answers, made):
    answers.slips_at = {100: 100}
    with pytest.raises(WatchdogError, match=r"reads back as 0.3 s, set was 0.2 s"):
        made().open(0.01)


def test_a_watchdog_that_the_drive_refuses(answers, made):
    del answers.holding[100]
    with pytest.raises(WatchdogError, match=r"cannot be set to 0.2 s: .*exception 2, the drive has no such register"):
        made().open(0.01)


def test_a_map_without_watchdog_needs_somebody_to_vouch_for_it(made):
    text = MAP.replace('[watchdog]\nregister = "watchdog"', "[watchdog]\nfixed_s = 0.5")
    with pytest.raises(WatchdogError, match=r"Set it to 0.5 s with the drive's own tools"):
        made(text=text).open(0.01)
    drive = made(text=text, watchdog_is_set_in_drive=True)
    drive.open(0.01)
    assert drive.describe().watchdog_s == 0.5


def test_a_host_that_was_late_is_told_that_the_watchdog_has_acted(answers, made):
    drive = made(watchdog_s=0.1)
    drive.open(0.01)
    drive.enable(Mode.DUTY)
    drive.exchange(Command(Mode.DUTY, 0.1))
    time.sleep(0.15)
    with pytest.raises(DriveFault, match=r"no demand for .*, and its watchdog allows 0.1 s: .* switched off"):
        drive.exchange(Command(Mode.DUTY, 0.1))
    assert answers.holding[10] == 0


def test_one_answer_that_is_no_modbus_is_asked_for_again(answers, drive):
    answers.corrupt = 1
    assert drive.exchange(OFF).status is Status.DISABLED


def test_a_silent_drive_is_an_error_in_bounded_time_and_comes_back(answers, drive):
    answers.silent = True
    began_s = time.perf_counter()
    with pytest.raises(
        DriveConnectionError, match=r"status, fault, position.*found nothing within 0.2 s.*the unit \(1\)"
    ):
        drive.exchange(OFF)
    assert time.perf_counter() - began_s < drive.describe().longest_call_s + 2.0  # a busy machine's share
    answers.silent = False
    drive.exchange(OFF)


def test_a_wrong_unit_is_named(made):
    with pytest.raises(DriveConnectionError, match=r"unit 9.*found nothing.*the unit \(9\)"):
        made(unit=9).open(0.01)


def test_nobody_listens():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    with pytest.raises(DriveConnectionError, match="cannot be opened; is the drive on"):
        ModbusDrive(ModbusSettings(map="test", transport="tcp", port=port), parse_map(MAP, "map"), JOINT).open(0.01)


def test_calls_before_open(made):
    with pytest.raises(DriveStateError, match="exchange before open"):
        made().exchange(OFF)


# a serial line: what the manual prints, byte by byte


@pytest.fixture
def line():
    """A pty: our end of it, and the path of the driver's."""
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    yield ours, os.ttyname(theirs)
    os.close(ours)
    os.close(theirs)


def test_a_request_as_the_manual_prints_it(line):
    """Roboteq GDC3660E data sheet, 2.2.1: VAR1 is asked for with 01 04 20 C1 00 02 2B F7."""
    ours, path = line
    link = Link(ModbusSettings(map="roboteq", transport="rtu", port=path, answer_timeout_s=TIMEOUT_S))
    variable = Register("var1", Space.INPUT, 0x20C1, Number.INT32)
    link.begin()
    os.write(ours, b"")
    with pytest.raises(DriveConnectionError, match="found nothing"):
        link.read(Block(variable.space, variable.address, variable.words, (variable,)))
    link.close()
    assert os.read(ours, 100) == bytes.fromhex("01 04 20 C1 00 02 2B F7") * 2  # asked twice


def test_the_roboteq_map_has_no_demand_but_zero_to_switch_off():
    drive = ModbusDrive(ModbusSettings(map="roboteq", transport="rtu", port="/dev/absent"), load_map("roboteq"), JOINT)
    assert drive.describe().modes == {Mode.DUTY}
    with pytest.raises(DriveConnectionError, match="is it plugged in, and not open elsewhere"):
        drive.open(0.01)


def test_an_answer_that_comes_late_is_not_taken_for_that_of_another_request(line):
    """RTU does not number its requests; the answer to one of two registers is no answer to one of a single register."""
    ours, path = line
    link = Link(ModbusSettings(map="roboteq", transport="rtu", port=path, answer_timeout_s=TIMEOUT_S))
    link.begin()
    late, wanted = bytes.fromhex("01 04 04 00 00 00 07"), bytes.fromhex("01 04 02 00 2a")

    def answer():
        for frame in (late, wanted):
            os.read(ours, 8)
            os.write(ours, frame + crc(frame))

    drive = threading.Thread(target=answer)
    drive.start()
    assert link.read_one(Register("speed", Space.INPUT, 0x2061, Number.INT16)) == 42.0
    drive.join()
    link.close()


def crc(frame):
    """CRC-16 of Modbus over serial line, low byte first."""
    remainder = 0xFFFF
    for byte in frame:
        remainder ^= byte
        for _ in range(8):
            remainder = (remainder >> 1) ^ 0xA001 if remainder & 1 else remainder >> 1
    return remainder.to_bytes(2, "little")


def frame(text):
    found = bytes.fromhex(text)
    return found + crc(found)


SPEED = Register("speed", Space.INPUT, 0x2061, Number.INT16)
ANSWER = frame("01 04 02 00 2a")


def serial_link(path, **settings):
    link = Link(
        ModbusSettings(map="roboteq", transport="rtu", port=path, **{"answer_timeout_s": TIMEOUT_S, **settings})
    )
    link.begin()
    return link


def in_background(work):
    """Do the drive's part while the driver waits."""
    thread = threading.Thread(target=work)
    thread.start()
    return thread


@pytest.mark.parametrize(
    ("settings", "silence_s"),
    [
        ({"baud_rate": 9600}, 3.5 * 10 / 9600),
        ({"baud_rate": 1200, "stop_bits": 2}, 3.5 * 11 / 1200),
        ({"baud_rate": 115200, "silence_s": 0.02}, 0.02),
    ],
)
def test_between_an_answer_and_the_next_request_the_line_is_silent_for_3_5_characters(line, settings, silence_s):
    ours, path = line
    link, answered_s, asked_s = serial_link(path, **settings), [], []

    def answer():
        for _ in range(2):
            os.read(ours, 8)
            asked_s.append(time.perf_counter())
            answered_s.append(time.perf_counter())
            os.write(ours, ANSWER)

    drive = in_background(answer)
    for _ in range(2):
        link.read_one(SPEED)
    drive.join()
    link.close()
    assert asked_s[1] - answered_s[0] >= silence_s


def test_an_adapter_that_hears_itself(line):
    ours, path = line
    link = serial_link(path, echo=True)

    def answer():
        os.write(ours, os.read(ours, 8))  # the echo
        os.write(ours, ANSWER)

    drive = in_background(answer)
    assert link.read_one(SPEED) == 42.0
    drive.join()
    link.close()


def test_an_echo_that_does_not_come_is_named(line):
    ours, path = line
    link = serial_link(path, echo=True)

    def answer():
        for _ in range(2):
            os.read(ours, 8)
            os.write(ours, ANSWER)

    drive = in_background(answer)
    with pytest.raises(DriveConnectionError, match=r"the echo of 01 04 20 61.* \(drive.echo\), and does nobody else"):
        link.read_one(SPEED)
    drive.join()
    link.close()


def test_safe_torque_off_is_told_beside_the_state(answers, made):
    drive = made(text=MAP.replace("\nenabled = 1\n", "\nenabled = 1\ntorque_off = 7\n"))
    drive.open(0.01)
    assert drive.inspect().torque_off == ""
    answers.holding[20] = 7
    assert drive.inspect().torque_off.startswith("bit or word 'torque_off' of its status")
    assert drive.inspect().fault == ""
