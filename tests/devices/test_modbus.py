"""The Modbus drives in virtual time, against docs/modbus-map.md and the bytes of Roboteq's manual."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.modbus.own_drive import OwnDrive
from sim_backend.devices.modbus.register_file import Kind, Refused, Unanswered, from_words, to_words
from sim_backend.devices.modbus.roboteq import Roboteq
from sim_backend.faults.script import DriveFailed, OverCurrent, OverTemperature, SupplyLost, TorqueDisabled

READ_HOLDING, READ_INPUT, WRITE_ONE, WRITE_SEVERAL, READ_WRITE = 3, 4, 6, 16, 23
OFF, ON, QUICK_STOP, CLEAR = range(4)
DUTY, CURRENT = 0, 1
IS_ON, IS_STOPPING, IS_FAULT, IS_LIMITED, IS_DISABLED = 1, 2, 4, 8, 16
JAMMED = {"static_n_m": 1.0, "coulomb_n_m": 0.9}


class Host:
    """Talks to our drive in virtual time."""

    def __init__(self, **tables: Any) -> None:
        self.drive = OwnDrive(behind_a_drive(changed=tables))
        self.time_s = 0.0

    def command(self, control: int, mode: int = DUTY, duty: int = 0, current_ma: int = 0) -> None:
        words = [control, mode, duty & 0xFFFF, current_ma >> 16 & 0xFFFF, current_ma & 0xFFFF]
        self.drive.write(WRITE_SEVERAL, 0, words)

    def set(self, address: int, value: int) -> None:
        self.drive.write(WRITE_ONE, address, [value])

    def word(self, address: int, signed: bool = False) -> int:
        (word,) = self.drive.read(READ_INPUT, address, 1)
        return word - 65536 if signed and word > 32767 else word

    def wait(self, duration_s: float) -> None:
        self.time_s += duration_s
        self.drive.advance_to(self.time_s)

    @property
    def powered(self) -> bool:
        return self.drive.axis.power.on


def _code(call: Any, *arguments: Any) -> int:
    with pytest.raises(Refused) as refused:
        call(*arguments)
    return refused.value.code


@given(st.sampled_from(Kind), st.integers(-(2**31), 2**32 - 1), st.booleans())
def test_number_comes_back_from_its_words(kind: Kind, value: int, low_word_first: bool) -> None:
    least, most = kind.range
    kept = max(least, min(most, value))
    assert from_words(to_words(value, kind, low_word_first), kind, low_word_first) == kept


def test_words_of_a_number() -> None:
    assert to_words(-2, Kind.I32, low_word_first=False) == [0xFFFF, 0xFFFE]
    assert to_words(0x12345678, Kind.U32, low_word_first=False) == [0x1234, 0x5678]
    assert to_words(0x12345678, Kind.U32, low_word_first=True) == [0x5678, 0x1234]


def test_identity() -> None:
    host = Host()
    assert host.drive.read(READ_HOLDING, 200, 4) == [0xFB01, 0x0100, 0, 1]
    words = host.drive.read(READ_INPUT, 210, 10)
    text = b"".join(word.to_bytes(2) for word in words)
    assert text.rstrip(b"\0") == b"simulated drive"


def test_duty_turns_the_motor_and_is_measured() -> None:
    host = Host()
    host.command(ON, DUTY, duty=-2000)
    host.wait(1.0)
    truth = host.drive.axis.plant.truth()
    words = host.drive.read(READ_INPUT, 100, 12)
    assert words[0] == IS_ON
    assert from_words(words[2:4], Kind.I32, False) == pytest.approx(truth.rotor_rad * 13037.97, abs=2)
    assert from_words(words[4:6], Kind.I32, False) == pytest.approx(truth.rotor_rad_s * 13037.97, abs=201)
    assert from_words(words[6:7], Kind.I16, False) == -2000
    assert from_words(words[7:8], Kind.I16, False) == pytest.approx(truth.current_a * 1000, abs=1)
    assert words[8] == 2400
    assert words[10:] == [0, 1000]


def test_current_is_driven_and_limited() -> None:
    host = Host(friction=JAMMED)
    host.set(17, 400)
    for wanted_ma, found_ma, limited in ((250, 250, 0), (-900, -400, IS_LIMITED)):
        host.command(ON, CURRENT, current_ma=wanted_ma)
        host.wait(0.05)
        assert host.word(107, signed=True) == pytest.approx(found_ma, abs=1)
        assert host.word(100) == IS_ON | limited


def test_duty_is_limited_by_the_current_too() -> None:
    host = Host(friction=JAMMED)
    host.set(17, 500)
    host.command(ON, DUTY, duty=10000)
    host.wait(0.05)
    assert host.word(107) == pytest.approx(500, abs=2)


def test_watchdog_is_restarted_by_commands_and_not_by_reading() -> None:
    host = Host()
    host.set(16, 200)
    host.command(ON, DUTY, duty=2000)
    for _ in range(5):
        host.wait(0.15)
        host.command(ON, DUTY, duty=2000)
    assert host.powered
    for _ in range(4):
        host.wait(0.05)
        host.word(100)
    assert host.powered
    host.wait(0.01)
    assert not host.powered
    assert (host.word(100), host.word(101), host.word(0)) == (IS_FAULT, 1, OFF)
    host.command(ON, DUTY, duty=2000)
    host.wait(0.01)
    assert not host.powered
    host.command(CLEAR)
    assert (host.word(100), host.word(101), host.word(0)) == (0, 0, OFF)
    host.command(ON, DUTY, duty=2000)
    host.wait(0.01)
    assert host.powered


def test_quick_stop_brakes_and_then_switches_off() -> None:
    host = Host()
    host.command(ON, DUTY, duty=3000)
    host.wait(0.5)
    host.command(QUICK_STOP)
    host.wait(0.01)
    assert host.word(100) == IS_STOPPING
    assert host.drive.axis.stage_name == "brake"
    host.wait(0.5)
    assert (host.word(100), host.word(0)) == (0, OFF)
    assert abs(host.drive.axis.plant.truth().rotor_rad_s) < 0.05


@pytest.mark.parametrize(("kind", "fault"), [(OverCurrent, 2), (SupplyLost, 3), (OverTemperature, 4), (DriveFailed, 5)])
def test_fault_stays_while_its_cause_does(kind: Any, fault: int) -> None:
    host = Host()
    host.command(ON, DUTY, duty=2000)
    host.wait(0.1)
    host.drive.axis.meet(kind(start_s=0.1, duration_s=0.2))
    host.wait(0.05)
    assert not host.powered
    assert (host.word(100) & IS_FAULT, host.word(101)) == (IS_FAULT, fault)
    host.command(CLEAR)
    assert host.word(101) == fault
    host.wait(0.3)
    host.command(CLEAR)
    assert (host.word(100), host.word(101)) == (0, 0)


def test_torque_disabled_from_outside_is_no_fault() -> None:
    host = Host()
    host.command(ON, DUTY, duty=2000)
    host.drive.axis.meet(TorqueDisabled(start_s=0.0, duration_s=0.2))
    host.wait(0.05)
    assert (host.word(100), host.word(101), host.powered) == (IS_DISABLED, 0, False)
    host.wait(0.3)
    assert not host.powered


@pytest.mark.parametrize(
    ("address", "count"), [(5, 1), (99, 1), (98, 4), (112, 1), (102, 1), (103, 1), (3, 1), (65535, 1)]
)
def test_what_is_not_there_or_a_half_is_not_read(address: int, count: int) -> None:
    assert _code(Host().drive.read, READ_HOLDING, address, count) == 2


@pytest.mark.parametrize(
    ("address", "words", "code"),
    [
        (100, [0], 2),
        (200, [0], 2),
        (3, [0], 2),
        (4, [0, 0], 2),
        (0, [4], 3),
        (1, [2], 3),
        (2, [10001], 3),
        (2, [65536 - 10001], 3),
        (3, [0x7FFF, 0], 3),
        (17, [0], 3),
        (16, [60001], 3),
    ],
)
def test_wrong_write_is_refused(address: int, words: list[int], code: int) -> None:
    assert _code(Host().drive.write, WRITE_SEVERAL, address, words) == code


def test_of_a_refused_write_nothing_is_written() -> None:
    host = Host()
    assert _code(host.drive.write, WRITE_SEVERAL, 0, [ON, DUTY, 20000, 0, 0]) == 3
    host.wait(0.01)
    assert host.drive.read(READ_HOLDING, 0, 5) == [0] * 5
    assert not host.powered


@pytest.mark.parametrize("function", [1, 2, 22])
def test_other_functions_are_refused(function: int) -> None:
    assert _code(Host().drive.read, function, 0, 1) == 1
    assert _code(Host().drive.write, function, 0, [0]) == 1


def test_word_order_turns_both_ways() -> None:
    host = Host(friction=JAMMED)
    host.set(18, 1)
    host.drive.write(WRITE_SEVERAL, 0, [ON, CURRENT, 0, 300, 0])
    host.wait(0.05)
    assert host.word(107) == pytest.approx(300, abs=1)
    assert host.drive.read(READ_HOLDING, 3, 2) == [300, 0]
    assert host.drive.read(READ_INPUT, 110, 2) == [50, 0]


class RoboteqHost:
    """Talks to the Roboteq-like drive in virtual time."""

    def __init__(self) -> None:
        self.drive = Roboteq(behind_a_drive())

    def write(self, address: int, value: int) -> None:
        self.drive.write(WRITE_SEVERAL, address, to_words(value, Kind.I32, low_word_first=False))

    def read(self, address: int) -> int:
        return from_words(self.drive.read(READ_INPUT, address, 2), Kind.I32, low_word_first=False)


def test_roboteq_takes_two_registers_and_is_silent_about_others() -> None:
    host = RoboteqHost()
    for count in (1, 3):
        with pytest.raises(Unanswered):
            host.drive.read(READ_INPUT, 0x2001, count)
        with pytest.raises(Unanswered):
            host.drive.write(WRITE_SEVERAL, 0x0001, [0] * count)
    assert _code(host.drive.read, READ_HOLDING, 0x2001, 2) == 1
    assert _code(host.drive.read, READ_INPUT, 0x3001, 2) == 2
    assert _code(host.write, 0x0001, 1001) == 3


def test_roboteq_drives_and_measures() -> None:
    host = RoboteqHost()
    host.write(0x0001, -200)
    host.drive.advance_to(0.9)
    truth = host.drive.axis.plant.truth()
    assert host.read(0x2041) == -200
    assert host.read(0x2081) == pytest.approx(truth.rotor_rad * 13037.97, abs=2)
    assert host.read(0x2061) == pytest.approx(truth.rotor_rad_s * 20 * 9.5493, abs=4)
    assert host.read(0x2001) == round(truth.current_a * 10)
    assert host.read(0x21A2) == 240


def test_roboteq_stops_after_a_second_without_a_write() -> None:
    host = RoboteqHost()
    host.write(0x0001, 300)
    host.drive.advance_to(0.99)
    host.read(0x2001)
    assert host.drive.axis.power.on
    host.drive.advance_to(1.01)
    assert not host.drive.axis.power.on
    assert host.read(0x2021) == 0
