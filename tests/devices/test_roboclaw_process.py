"""The RoboClaw in a process of its own, over a pseudo-terminal."""

import json
import os
import signal
import subprocess
import sys
import time
import tomllib
from binascii import crc_hqx
from collections.abc import Iterator
from pathlib import Path
from struct import pack

import pytest
import serial

from sim_backend.errors import ParameterError
from tests.devices.device_process import DeviceProcess, device_process

ACK = b"\xff"
DUTY_QUARTER = pack(">h", 8192)


@pytest.fixture(scope="module")
def device(tmp_path_factory: pytest.TempPathFactory) -> Iterator[DeviceProcess]:
    link = tmp_path_factory.mktemp("roboclaw") / "port"
    with device_process("roboclaw", "--link", str(link), "--baud", "0") as running:
        yield running


@pytest.fixture
def port(device: DeviceProcess) -> Iterator[serial.Serial]:
    with serial.Serial(device.port, 115200, timeout=1.0, exclusive=True) as opened:
        yield opened
        opened.write(_packet(32, b"\0\0"))
        opened.read(1)
    device.side.ask("repair")


def _packet(command: int, payload: bytes) -> bytes:
    packet = bytes([0x80, command]) + payload
    return packet + pack(">H", crc_hqx(packet, 0))


def _write(port: serial.Serial, command: int, payload: bytes) -> bytes:
    port.write(_packet(command, payload))
    return port.read(1)


def _silence(port: serial.Serial) -> bool:
    port.timeout = 0.2
    port.write(b"\x80\x0f")
    answer = port.read(3)
    port.timeout = 1.0
    time.sleep(0.02)
    return answer == b""


def _talk_until(port: serial.Serial, end_s: float) -> None:
    while time.monotonic() < end_s:
        port.write(b"\x80\x0f")
        port.read(3)


def test_motor_turns_and_the_truth_is_told(device: DeviceProcess, port: serial.Serial) -> None:
    assert _write(port, 32, DUTY_QUARTER) == ACK
    since_s = device.wait_for_power(on=True)
    assert abs(time.monotonic() - since_s) < 2.0
    assert device.truth()["stage"] == "voltage"


def test_host_that_dies_leaves_a_motor_that_stops(device: DeviceProcess, port: serial.Serial) -> None:
    assert _write(port, 14, b"\x03") == ACK
    assert _write(port, 32, DUTY_QUARTER) == ACK
    last_s = time.monotonic()
    device.wait_for_power(on=True)
    stopped_s = device.wait_for_power(on=False)
    assert 0.25 < stopped_s - last_s < 0.8  # 0.3 s, and a machine with other work
    assert _write(port, 14, b"\x00") == ACK


def test_silent_device_answers_nothing_until_repaired(device: DeviceProcess, port: serial.Serial) -> None:
    device.side.ask("link", name="silent")
    assert _silence(port)
    device.side.ask("repair")
    assert not _silence(port)


def test_corrupted_request_is_not_obeyed(device: DeviceProcess, port: serial.Serial) -> None:
    device.side.ask("link", name="corrupt", direction="to-device", packets=1)
    port.timeout = 0.2
    assert _write(port, 32, DUTY_QUARTER) == b""
    assert not device.truth()["powered"]


def test_split_request_is_obeyed_within_ten_milliseconds_only(device: DeviceProcess, port: serial.Serial) -> None:
    device.side.ask("link", name="split", direction="to-device", packets=1, amount_s=0.05)
    port.timeout = 0.3
    assert _write(port, 32, DUTY_QUARTER) == b""
    time.sleep(0.02)
    assert _write(port, 32, DUTY_QUARTER) == ACK


def test_port_goes_and_comes_back_under_its_name(device: DeviceProcess) -> None:
    with serial.Serial(device.port, 115200, timeout=1.0) as opened:
        before = os.readlink(device.port)
        device.side.ask("link", name="disconnect", duration_s=0.3)
        end_s = time.monotonic() + 5.0
        with pytest.raises(serial.SerialException):
            _talk_until(opened, end_s)
    while not Path(device.port).exists() and time.monotonic() < end_s:
        time.sleep(0.01)
    with serial.Serial(device.port, 115200, timeout=1.0) as opened:
        assert not _silence(opened)
    assert before.startswith("/dev/pts/")


def test_load_is_hung_and_nonsense_is_refused(device: DeviceProcess) -> None:
    device.side.hang_load(0.05, balanced=True)
    with pytest.raises(ParameterError, match=r"Load\.mass_kg"):
        device.side.hang_load(-1.0, balanced=True)
    with pytest.raises(ParameterError, match="fault 'fire' is unknown; known are over-temperature"):
        device.side.ask("fault", name="fire")
    with pytest.raises(ParameterError, match="deed 'dance' is unknown"):
        device.side.ask("dance")
    with pytest.raises(ParameterError, match="unexpected keyword argument 'kg'"):
        device.side.ask("hang", kg=1)


def test_what_it_prints_is_a_file_of_its_drive(tmp_path: Path) -> None:
    file = tmp_path / "drive.toml"
    with file.open("w") as out:
        words = [sys.executable, "-m", "bench.cli", "simulate-device", "roboclaw", "--link", str(tmp_path / "port")]
        running = subprocess.Popen(words, stdout=out, stderr=subprocess.PIPE, text=True)
    try:
        assert running.stderr is not None
        while "Ctrl-C ends it" not in (line := running.stderr.readline()):
            assert line, "it ended by itself"
        drive = tomllib.loads(file.read_text())["drive"]
    finally:
        running.kill()
        running.wait()
        running.stderr.close()
    assert (drive["kind"], drive["port"]) == ("roboclaw", str(tmp_path / "port"))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_it_cleanly(number: int, tmp_path: Path) -> None:
    link = tmp_path / "port"
    words = [sys.executable, "-m", "bench.cli", "simulate-device", "roboclaw", "--link", str(link), "--json"]
    running = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert running.stdout is not None
        assert json.loads(running.stdout.readline())["port"] == str(link)
        running.send_signal(number)
        _, complaints = running.communicate(timeout=20)
    finally:
        running.kill()
        running.wait()
    assert (running.returncode, complaints) == (0, "")
    assert not link.is_symlink()
