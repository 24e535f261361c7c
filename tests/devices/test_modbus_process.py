"""The Modbus drives over a pseudo-terminal and TCP: golden bytes, mbpoll, a line that fails."""

import contextlib
import shutil
import socket
import subprocess
import time
from collections.abc import Callable, Iterator

import pytest
import serial

from tests.devices.device_process import DeviceProcess, device_process

Exchange = Callable[[str], str]


def _crc(data: bytes) -> bytes:
    """The CRC of Modbus RTU, bit by bit as its specification has it."""
    register = 0xFFFF
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = register >> 1 ^ 0xA001 if register & 1 else register >> 1
    return register.to_bytes(2, "little")


def _rtu(words: str) -> bytes:
    data = bytes.fromhex(words)
    return data + _crc(data)


@pytest.fixture(scope="module")
def rtu() -> Iterator[DeviceProcess]:
    with device_process("modbus", "--baud", "0") as device:
        yield device


@pytest.fixture(scope="module")
def tcp() -> Iterator[DeviceProcess]:
    with device_process("modbus", "--transport", "tcp") as device:
        yield device


@contextlib.contextmanager
def _line(device: DeviceProcess, timeout_s: float = 2.0) -> Iterator[Exchange]:
    with serial.Serial(device.port, 115200, timeout=timeout_s) as port:

        def exchange(request: str) -> str:
            """Send a request without its CRC; return the answer without, or '' for silence."""
            port.reset_input_buffer()
            port.write(_rtu(request))
            answer = port.read(3)
            if not answer:
                return ""
            more = 2 if answer[1] & 0x80 else (answer[2] + 2 if answer[1] in (3, 4, 23) else 5)
            answer += port.read(more)
            assert _crc(answer[:-2]) == answer[-2:]
            return answer[:-2].hex(" ")

        yield exchange


def test_crc_is_the_one_of_a_published_frame() -> None:
    assert _rtu("01 04 20 C1 00 02").hex(" ").upper() == "01 04 20 C1 00 02 2B F7"


def test_frames_of_our_map(rtu: DeviceProcess) -> None:
    with _line(rtu) as exchange:
        for request, answer in (
            ("01 03 00 c8 00 02", "01 03 04 fb 01 01 00"),  # identity
            ("01 04 00 c8 00 02", "01 04 04 fb 01 01 00"),
            ("01 06 00 10 00 c8", "01 06 00 10 00 c8"),  # watchdog 200 ms
            ("01 10 00 00 00 05 0a 00 00 00 00 00 00 00 00 00 00", "01 10 00 00 00 05"),
            ("01 17 00 10 00 01 00 10 00 01 02 01 2c", "01 17 02 01 2c"),  # reads what it has just written
            ("01 03 00 05 00 01", "01 83 02"),
            ("01 06 00 64 00 01", "01 86 02"),
            ("01 06 00 00 00 04", "01 86 03"),
            ("01 17 00 64 00 01 00 00 00 01 02 00 04", "01 97 03"),
            ("01 01 00 00 00 01", "01 81 01"),
            ("01 16 00 00 00 f2 00 25", "01 96 01"),
        ):
            assert exchange(request) == answer, request


def test_foreign_unit_is_silence_and_does_not_disturb_the_next(rtu: DeviceProcess) -> None:
    with _line(rtu, timeout_s=0.3) as exchange:
        assert exchange("02 03 00 c8 00 01") == ""
        assert exchange("01 03 00 c8 00 01") == "01 03 02 fb 01"


def test_damaged_request_is_silence(rtu: DeviceProcess) -> None:
    with _line(rtu, timeout_s=0.3) as exchange:
        rtu.side.ask("link", name="corrupt", direction="to-device", packets=1)
        assert exchange("01 06 00 00 00 01") == ""
        assert not rtu.truth()["powered"]
        rtu.side.ask("repair")
        time.sleep(0.05)
        answers = [exchange("01 03 00 c8 00 01") for _ in range(3)]
        assert "01 03 02 fb 01" in answers  # a damaged frame may take the one after it along


def test_motor_stops_when_nobody_writes(rtu: DeviceProcess) -> None:
    with _line(rtu) as exchange:
        exchange("01 06 00 00 00 03")
        exchange("01 06 00 10 00 fa")
        exchange("01 10 00 00 00 03 06 00 01 00 00 07 d0")
        last_s = time.monotonic()
        rtu.wait_for_power(on=True)
        off_s = rtu.wait_for_power(on=False)
        assert 0.2 < off_s - last_s < 0.8  # 0.25 s, and a machine with other work
        assert exchange("01 03 00 64 00 02") == "01 03 04 00 04 00 01"
        exchange("01 06 00 00 00 03")


def test_tcp_frames_and_a_connection_that_is_lost(tcp: DeviceProcess) -> None:
    host, port = tcp.port.split(":")
    request, answer = "00 07 00 00 00 06 01 03 00 c8 00 01", "00 07 00 00 00 05 01 03 02 fb 01"
    with socket.create_connection((host, int(port)), 2.0) as connection:
        connection.sendall(bytes.fromhex(request))
        assert connection.recv(100).hex(" ") == answer
        tcp.side.ask("link", name="disconnect", duration_s=0.2)
        assert connection.recv(100) == b""
    end_s = time.monotonic() + 5.0
    while time.monotonic() < end_s:
        with contextlib.suppress(OSError), socket.create_connection((host, int(port)), 2.0) as connection:
            connection.sendall(bytes.fromhex(request))
            if connection.recv(100).hex(" ") == answer:
                return
        time.sleep(0.05)
    raise AssertionError("the port did not come back")


def test_published_frames_of_a_roboteq() -> None:
    with (
        device_process("modbus", "--map", "roboteq", "--baud", "0") as device,
        serial.Serial(device.port, 115200, timeout=2.0) as port,
    ):
        for request, answer in (
            ("01 10 00 A1 00 02 04 00 00 12 34 35 6C", "01 10 00 A1 00 02 10 2A"),
            ("01 04 20 C1 00 02 2B F7", "01 04 04 00 00 12 34 F6 F3"),
        ):
            port.write(bytes.fromhex(request))
            assert port.read(len(bytes.fromhex(answer))).hex(" ").upper() == answer
        port.timeout = 0.3
        port.write(_rtu("01 04 20 c1 00 01"))
        assert port.read(1) == b""
        port.write(_rtu("01 04 20 c1 00 02"))
        assert port.read(9).hex() == "0104040000" + "1234f6f3"


@pytest.mark.skipif(shutil.which("mbpoll") is None, reason="needs mbpoll (apt-get install mbpoll)")
@pytest.mark.parametrize("transport", ["rtu", "tcp"])
def test_mbpoll_reads_and_writes(transport: str, rtu: DeviceProcess, tcp: DeviceProcess) -> None:
    """A master that is not ours, on libmodbus."""
    where = ["-m", "rtu", "-b", "115200", "-P", "none"]
    port = rtu.port
    if transport == "tcp":
        port, number = tcp.port.split(":")
        where = ["-m", "tcp", "-p", number]

    def mbpoll(*words: str, value: str = "") -> str:
        command = ["mbpoll", *where, "-0", "-1", "-a", "1", "-o", "2", *words, port, *([value] if value else [])]
        return subprocess.run(command, capture_output=True, text=True, timeout=20, check=True).stdout

    assert "[200]: \t0xFB01" in mbpoll("-t", "4:hex", "-r", "200", "-c", "1")
    mbpoll("-t", "4", "-r", "16", value="321")
    assert "[16]: \t321" in mbpoll("-t", "4", "-r", "16", "-c", "1")
    assert "[108]: \t2400" in mbpoll("-t", "3", "-r", "108", "-c", "1")
