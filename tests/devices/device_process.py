"""A simulated device in a process of its own, for tests of drivers and of whole benches.

    with device_process("roboclaw", "--baud", "0") as device:
        drive = SomeDriver(device.port)
        device.side.hang_load(0.05, balanced=False)
        device.side.ask("fault", name="over-current", duration_s=0.5)
        device.side.ask("link", name="drop", packets=3, direction="from-device")
        device.side.ask("link", name="disconnect", duration_s=0.3)
        truth = device.side.ask("truth")   # powered, powered_since_monotonic_s, joint, device ...

Times ending in `monotonic_s` are of `time.monotonic()`, which all processes of a machine share: so a test can say how
long after its own deed the motor was without power.
"""

import json
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from sim_backend.devices.side_channel_client import SideChannelClient
from tests.devices.forked import ForkedProcess, forked
from tests.devices.turns import DEVICE, ask_for_turns

START_S = 90.0  # the first start on a machine compiles the plant
IS_VIRTUAL = False  # `pytest -p tests.virtual.plugin`
Thread = threading.Thread  # there it shares virtual time with the test


@dataclass(frozen=True)
class DeviceProcess:
    """A device that runs.

    Attributes:
        port: what a driver opens.
        drive: the section of bench.toml that the command prints.
        side: the side channel.
        process: the process.
    """

    port: str
    drive: dict[str, Any]
    side: SideChannelClient
    process: ForkedProcess

    def truth(self) -> dict[str, Any]:
        """How things really are."""
        return self.side.ask("truth")

    def wait_for_power(self, on: bool, timeout_s: float = 5.0) -> float:
        """Wait until the stage can drive the motor, or cannot; return when that began, of `time.monotonic()` [s]."""
        end_s = time.monotonic() + timeout_s
        while time.monotonic() < end_s:
            truth = self.truth()
            if truth["powered"] is on:
                return float(truth["powered_since_monotonic_s"])
            time.sleep(0.005)
        raise AssertionError(f"the motor is {'off' if on else 'still powered'} after {timeout_s:g} s: {truth}")


@contextmanager
def device_process(kind: str, *options: str) -> Iterator[DeviceProcess]:
    """Run `friction-bench simulate-device <kind> <options> --json`, and end it."""
    process = forked("simulate-device", kind, *options, "--json")
    killer = threading.Timer(START_S, process.kill)
    killer.start()
    try:
        line = process.stdout.readline()
        killer.cancel()
        assert line, "the device did not start: see what it has printed"
        found = json.loads(line)
        ask_for_turns(process.pid, DEVICE)
        side = SideChannelClient(found["side_channel"])
        try:
            yield DeviceProcess(found["port"], found["drive"], side, process)
        finally:
            side.close()
    finally:
        killer.cancel()
        process.send_signal(signal.SIGTERM)
        if not process.wait(10.0):
            process.kill()
        process.close()
