"""A simulated device in this process and in virtual time, in the place of one in a process of its own.

    with virtual_device("roboclaw", "--baud", "0") as device:   # as `device_process`, and with the same side channel

What is asked of `friction-bench simulate-device` is what starts it. Kinds on serial lines and on slcan adapters can be
had, not those whose port is the operating system's (TCP).
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest import mock

from bench.cli.operation import simulate_device
from tests.devices.device_process import DeviceProcess
from tests.virtual.side import SideClient


@contextmanager
def virtual_device(kind: str, *options: str) -> Iterator[DeviceProcess]:
    """Run `friction-bench simulate-device <kind> <options>` here."""
    started: list[Any] = []
    with mock.patch.object(simulate_device, "_serve", lambda simulated, _json: started.append(simulated)):
        simulate_device._command(simulate_device._kinds()[kind]).main([*options], standalone_mode=False)
    [simulated] = started
    with simulated.device as running:
        drive = simulated.drive | {"side_channel": running.side_channel}
        side: Any = SideClient(running.side_channel)
        process: Any = None  # there is none
        yield DeviceProcess(running.path, drive, side, process)
