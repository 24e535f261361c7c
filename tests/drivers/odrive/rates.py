"""How quick the ODrive driver is beside python-can used barely (`tests.drivers.rates`)."""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import can

from drivers.can_bus.bus import open_bus
from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode
from drivers.joint import JointScale
from drivers.odrive.drive import OdriveDrive
from drivers.odrive.settings import OdriveSettings
from tests.devices.device_process import device_process
from tests.devices.turns import own_processors
from tests.drivers.rate_rows import Cycle, quickest, ratio_row

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
NEVER = 1_000_000
ANSWERS = (0x09, 0x14, 0x03)


def rows() -> Iterator[str]:
    """The rows: an adapter (slcan) on a pty, two processes."""
    with device_process("odrive", "--watchdog", "2.0") as device, own_processors(device.process.pid):
        bus = BusSettings("slcan", device.drive["channel"])
        bare, driven = quickest(partial(barely, bus), partial(driver, bus), rounds=15)
    yield ratio_row("ODrive, slcan on a pty / python-can", bare, driven)


@contextmanager
def barely(settings: BusSettings) -> Iterator[Cycle]:
    """What a script would do: send the torque, ask three questions, receive until all are answered."""
    bus = open_bus(settings, "bare")

    def cycle() -> None:
        bus.send(can.Message(arbitration_id=0x0E, data=struct.pack("<f", 0.0), is_extended_id=False))
        for command in ANSWERS:
            bus.send(can.Message(arbitration_id=command, is_remote_frame=True, is_extended_id=False, dlc=8))
        missing = set(ANSWERS)
        while missing:
            message = bus.recv(1.0)
            assert message is not None
            if message.arbitration_id in missing:
                struct.unpack("<ff", message.data)
                missing.discard(message.arbitration_id)

    yield cycle
    bus.shutdown()


@contextmanager
def driver(settings: BusSettings) -> Iterator[Cycle]:
    """One exchange of the driver."""
    drive = OdriveDrive(
        OdriveSettings.model_construct(
            interface=settings.interface,
            channel=settings.channel,
            watchdog_s=2.0,
            watchdog_is_set_in_drive=True,
            answer_timeout_s=2.0,
            slow_every=NEVER,
        ),
        JOINT,
    )
    drive.open(0.01)
    drive.enable(Mode.TORQUE)
    yield lambda: drive.exchange(Command(Mode.TORQUE, 0.0))
    drive.close()
