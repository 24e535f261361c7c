"""How quick the moteus driver is beside mjbots' library on the same adapter (`tests.drivers.rates`)."""

import asyncio
import math
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import moteus
from moteus.fdcanusb_device import FdcanusbDevice

from drivers.contract import Command, Mode
from drivers.joint import JointScale
from drivers.moteus.drive import MoteusDrive
from drivers.moteus.settings import MoteusSettings
from tests.devices.device_process import device_process
from tests.devices.turns import own_processors
from tests.drivers.rate_rows import Cycle, quickest, ratio_row

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)


def rows() -> Iterator[str]:
    """The rows: an adapter (fdcanusb) on a pty, two processes."""
    with device_process("moteus") as device, own_processors(device.process.pid):
        bare, driven = quickest(partial(library, device.port), partial(driver, device.port), rounds=15)
    yield ratio_row("moteus, fdcanusb on a pty / moteus", bare, driven)


@contextmanager
def library(path: str) -> Iterator[Cycle]:
    """A torque and its answer, in the library's own event loop."""
    loop = asyncio.new_event_loop()

    async def opened() -> tuple[FdcanusbDevice, moteus.Controller]:
        device = FdcanusbDevice(path)
        device._checksum_active = False  # it takes a pseudo-terminal for a UART otherwise
        controller = moteus.Controller(id=1, transport=moteus.Transport([device]))
        await controller.set_stop(query=True)
        return device, controller

    device, controller = loop.run_until_complete(opened())

    def cycle() -> None:
        told = {"feedforward_torque": 0.0, "kp_scale": 0.0, "kd_scale": 0.0, "watchdog_timeout": 2.0}
        loop.run_until_complete(controller.set_position(position=math.nan, velocity=0.0, query=True, **told))

    yield cycle
    loop.run_until_complete(controller.set_stop(query=True))
    device.close()
    loop.run_until_complete(asyncio.sleep(0.0))
    loop.close()


@contextmanager
def driver(path: str) -> Iterator[Cycle]:
    """One exchange of the driver."""
    drive = MoteusDrive(MoteusSettings.model_construct(port=path, watchdog_s=2.0, answer_timeout_s=2.0), JOINT)
    drive.open(0.01)
    drive.enable(Mode.TORQUE)
    yield lambda: drive.exchange(Command(Mode.TORQUE, 0.0))
    drive.close()
