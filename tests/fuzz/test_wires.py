"""Hostile bytes on the wire of each kind of drive, to the driver and to the simulated device."""

import socket
import subprocess
import sys
from contextlib import suppress
from random import Random

import pytest

from sim_backend.devices.modbus.serve import ModbusSettings, serve_modbus
from tests.fuzz.edits import spoilt_by
from tests.fuzz.effort import TIMES
from tests.paths import ROOT

COUNT = 100  # of spoilt answers, and of spoilt questions
KINDS = (
    "roboclaw", "modbus", "canopen", "dynamixel", "feetech", "odrive", "damiao", "cubemars", "robstride", "moteus",
)  # fmt: skip


@pytest.mark.parametrize("kinds", [KINDS] if TIMES == 1 else [(kind,) for kind in KINDS], ids=lambda kinds: kinds[0])
def test_a_driver_raises_nothing_but_its_errors_and_a_device_goes_on(kinds: tuple[str, ...]) -> None:
    # a process of its own: its clocks are virtual; one for all where it is brief, as it takes longest to start
    words = [sys.executable, "-m", "tests.fuzz.wires", str(COUNT * TIMES), *kinds]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("sound") == len(kinds)


READ = bytes.fromhex("0001 0000 0006 01 03 0000 0001")  # Modbus TCP: one holding register


def test_the_simulated_modbus_server_goes_on_whatever_comes() -> None:
    chance = Random(TIMES)
    with serve_modbus(ModbusSettings(transport="tcp")) as device:
        host, _, port = device.path.partition(":")
        for _ in range(COUNT * TIMES):
            with socket.create_connection((host, int(port)), timeout=10.0) as line, suppress(ConnectionError):
                line.sendall(spoilt_by(chance, READ))
        with socket.create_connection((host, int(port)), timeout=10.0) as line:
            line.sendall(READ)
            assert line.recv(64)[:9] == bytes.fromhex("0001 0000 0005 01 03 02")
