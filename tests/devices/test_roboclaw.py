"""The RoboClaw device in virtual time, against the bytes of the manual. The CRC here is Python's own."""

from binascii import crc_hqx
from struct import pack, unpack
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.roboclaw.channel import BACKWARD, OVERFLOW, UNDERFLOW, Counter
from sim_backend.devices.roboclaw.commands import COMMANDS
from sim_backend.devices.roboclaw.device import MEASURED, RoboClaw, crc16
from sim_backend.faults.script import DriveFailed, OverTemperature, SupplyLost, TorqueDisabled

ACK = b"\xff"
ADDRESS = 0x80
COUNTS_PER_RAD = 4096 * 20 / 6.283185307179586


class Host:
    """Talks to a device in virtual time."""

    def __init__(self, **settings: Any) -> None:
        tables = settings.pop("plant", {})
        self.device = RoboClaw(behind_a_drive(measured=MEASURED, changed=tables), **settings)
        self.time_s = 0.0

    def send(self, data: bytes) -> bytes:
        return self.device.receive(data, self.time_s)

    def write(self, command: int, payload: bytes = b"", address: int = ADDRESS) -> bytes:
        packet = bytes([address, command]) + payload
        return self.send(packet + pack(">H", crc_hqx(packet, 0)))

    def read(self, command: int, layout: str) -> tuple[int, ...]:
        answer = self.send(bytes([ADDRESS, command]))
        data, crc = answer[:-2], answer[-2:]
        assert crc == pack(">H", crc_hqx(bytes([ADDRESS, command]) + data, 0))
        return unpack(">" + layout, data)

    def wait(self, duration_s: float) -> None:
        self.time_s += duration_s
        self.device.advance_to(self.time_s)


def test_crc_has_the_check_value_of_its_kind() -> None:
    assert crc16(b"123456789") == 0x31C3


@given(st.binary(max_size=64))
def test_crc_is_that_of_the_standard_library(data: bytes) -> None:
    assert crc16(data) == crc_hqx(data, 0)


def test_golden_bytes() -> None:
    host = Host()
    conversation = [
        ("80 0e 05 48 f0", "ff"),  # serial timeout 0.5 s
        ("80 0f", "05 7b c1"),
        ("80 18", "00 f0 d8 e5"),  # 24.0 V
        ("80 31", "00 00 00 00 72 9f"),  # no currents
        ("80 20 0c 80 8f 1b", "ff"),  # duty 3200
    ]
    for sent, expected in conversation:
        assert host.send(bytes.fromhex(sent)).hex(" ") == expected, sent


def test_version_is_text_with_its_end() -> None:
    answer = Host().send(bytes([ADDRESS, 21]))
    assert answer[:-2].startswith(b"USB Roboclaw")
    assert answer[:-2].endswith(b"\n\0")


@pytest.mark.parametrize("number", sorted(COMMANDS))
def test_every_command_is_answered_with_what_the_table_says(number: int) -> None:
    host, command = Host(), COMMANDS[number]
    if not command.reply:
        assert host.write(number, bytes(command.payload_length)) == ACK
    elif command.reply != "text":
        host.read(number, command.reply)


def test_wrong_crc_is_silence_and_then_ten_milliseconds_of_deafness() -> None:
    host = Host()
    assert host.send(bytes.fromhex("80 20 0c 80 8f 1c")) == b""
    host.time_s = 0.009
    assert host.write(32, b"\x0c\x80") == b""
    host.time_s = 0.0195  # that packet, too, has to be over for more than 10 ms
    assert host.send(bytes([ADDRESS, 15]))
    host.wait(0.1)
    assert host.read(48, "hh") == (0, 0)


def test_bytes_may_dribble_but_not_pause() -> None:
    host = Host()
    answers = b""
    for byte in bytes.fromhex("80 20 0c 80 8f 1b"):
        host.time_s += 0.0099
        answers += host.send(bytes([byte]))
    assert answers == ACK
    host.time_s += 0.02
    assert host.send(bytes.fromhex("80 20 0c")) == b""
    host.time_s += 0.0101
    assert host.send(bytes.fromhex("80 8f 1b")) == b""


def test_two_packets_in_one_piece_are_both_answered() -> None:
    assert len(Host().send(bytes([ADDRESS, 15, ADDRESS, 24]))) == 3 + 4


def test_another_address_is_silence_but_not_over_usb() -> None:
    assert Host().write(32, b"\0\0", address=0x81) == b""
    assert Host(usb=True).write(32, b"\0\0", address=0x81) == ACK
    assert Host(address=0x87).write(32, b"\0\0", address=0x87) == ACK


def test_unknown_command_is_silence() -> None:
    assert Host().send(bytes([ADDRESS, 200])) == b""


@given(duty=st.integers(-32768, 32767), crc=st.integers(0, 0xFFFF))
def test_duty_counts_only_with_its_crc(duty: int, crc: int) -> None:
    host, packet = _QUIET, pack(">BBh", ADDRESS, 32, duty)
    host.time_s += 0.02
    assert host.send(packet + pack(">H", crc)) == (ACK if crc == crc_hqx(packet, 0) else b"")


@given(st.binary(max_size=40))
def test_noise_does_not_end_the_device(noise: bytes) -> None:
    host = _QUIET
    host.time_s += 0.02
    host.send(noise)
    host.time_s += 0.02
    assert host.send(bytes([ADDRESS, 15]))


_QUIET = Host()  # one for all examples: to build a plant takes longer than an example


def test_duty_turns_the_motor_and_is_read_back() -> None:
    host = Host()
    assert host.write(32, pack(">h", -6553)) == ACK
    host.wait(1.0)
    assert host.read(48, "hh")[0] == pytest.approx(-6553, abs=17)  # 1000 steps of duty
    truth = host.device.axis.plant.truth()
    assert truth.rotor_rad_s < -1.0
    count, flags = host.read(16, "IB")
    assert count - 2**32 == pytest.approx(truth.rotor_rad * COUNTS_PER_RAD, abs=1.5)
    assert flags & BACKWARD
    assert flags & UNDERFLOW
    speed, backward = host.read(30, "iB")
    assert speed == pytest.approx(truth.rotor_rad_s * COUNTS_PER_RAD, abs=301)  # one count in 1/300 s
    assert backward == 1
    assert host.read(18, "iB")[0] == pytest.approx(speed, rel=0.02)


def test_mean_speed_is_that_of_the_last_second() -> None:
    host = Host()
    host.write(32, pack(">h", 6553))
    host.wait(1.0)
    before = host.read(78, "II")[0]
    host.wait(1.0)
    assert host.read(108, "ii")[0] == pytest.approx(host.read(78, "II")[0] - before, rel=0.01)


def test_current_is_in_steps_of_ten_milliamperes() -> None:
    host = Host()
    host.write(32, pack(">h", 6553))
    host.wait(1.0)
    assert host.read(49, "hh")[0] * 0.01 == pytest.approx(host.device.axis.plant.truth().current_a, abs=0.005)


def test_serial_timeout_stops_the_motor_at_its_time() -> None:
    host = Host()
    host.write(14, b"\x02")
    host.write(32, pack(">h", 8000))
    host.wait(0.199)
    assert host.device.axis.power.on
    host.wait(0.004)
    assert not host.device.axis.power.on
    assert host.device.report()["watchdog_trips"] == 1
    host.read(15, "B")  # talking again does not start the motor again
    host.wait(0.01)
    assert not host.device.axis.power.on


def test_serial_timeout_waits_while_somebody_talks_and_zero_is_off() -> None:
    host = Host()
    host.write(14, b"\x02")
    host.write(32, pack(">h", 8000))
    for _ in range(10):
        host.wait(0.15)
        host.read(16, "IB")
    assert host.device.axis.power.on
    host.write(14, b"\x00")
    host.wait(5.0)
    assert host.device.axis.power.on


def test_current_limit_holds_and_warns() -> None:
    host = Host(plant={"friction": {"static_n_m": 1.0, "coulomb_n_m": 0.9}})  # jammed
    host.write(133, pack(">II", 50, 0))  # 0.5 A
    assert host.read(135, "II") == (50, 0)
    host.write(32, pack(">h", 32767))  # 3 A of a standing motor
    host.wait(0.3)
    assert host.device.axis.plant.truth().current_a == pytest.approx(0.5, rel=0.05)
    assert host.read(90, "I")[0] & 0x10000


def test_ramped_duty_approaches_at_its_rate() -> None:
    host = Host()
    host.write(52, pack(">hI", 16384, 32767))  # half of full duty at full duty a second
    host.wait(0.25)
    assert host.read(48, "hh")[0] == pytest.approx(8192, abs=70)
    host.wait(0.5)
    assert host.read(48, "hh")[0] == pytest.approx(16384, abs=40)


def test_speed_is_closed_by_the_drive() -> None:
    host = Host()
    host.write(28, pack(">IIII", 0, 0x00100000, 0x01000000, 312900))
    assert host.read(55, "IIII") == (0x00100000, 0x01000000, 0, 312900)
    host.write(35, pack(">i", 40000))
    host.wait(2.0)
    assert host.read(18, "iB")[0] == pytest.approx(40000, rel=0.02)


def test_counter_flags_its_ends_until_read() -> None:
    counter = Counter()
    counter.set(2**32 - 5)
    counter.follow(10)
    assert counter.read() == (5, OVERFLOW)
    assert counter.read() == (5, 0)
    counter.follow(0)
    assert counter.read() == (2**32 - 5, UNDERFLOW | BACKWARD)


def test_counts_can_be_set_and_reset() -> None:
    host = Host()
    host.write(22, pack(">i", 1000))
    assert host.read(78, "II") == (1000, 0)
    host.write(20)
    assert host.read(78, "II") == (0, 0)


def test_settings_come_back_and_defaults_restore_them() -> None:
    host = Host()
    host.write(57, pack(">HH", 100, 260))
    host.write(148, b"\x00")
    assert host.read(59, "HH") == (100, 260)
    assert host.read(149, "B") == (0,)
    host.write(80)
    assert host.read(149, "B") == (1,)


@pytest.mark.parametrize(
    ("kind", "flag"), [(OverTemperature, 0x2), (SupplyLost, 0x80000), (DriveFailed, 0x40), (TorqueDisabled, 0x1)]
)
def test_fault_stops_the_motor_and_shows_in_the_status(kind: Any, flag: int) -> None:
    host = Host()
    host.write(32, pack(">h", 8000))
    host.wait(0.1)
    host.device.axis.meet(kind(start_s=0.1, duration_s=0.2))
    host.wait(0.05)
    assert host.read(90, "I")[0] & flag
    assert not host.device.axis.power.on
    host.wait(0.3)  # over; but the motor was stopped
    assert host.read(90, "I") == (0,)
    assert not host.device.axis.power.on
