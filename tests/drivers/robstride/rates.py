"""How quick the RobStride driver is beside `robstride-dynamics` on the same bus (`tests.drivers.rates`)."""

from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from functools import partial
from io import StringIO

from robstride_dynamics import Motor, RobstrideBus

from drivers.can_bus.bus import open_bus
from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode
from drivers.joint import JointScale
from drivers.robstride.drive import RobstrideDrive
from drivers.robstride.settings import RobstrideSettings
from tests.devices.device_process import device_process
from tests.devices.turns import own_processors
from tests.drivers.rate_rows import Cycle, quickest, ratio_row

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)


def rows() -> Iterator[str]:
    """The rows: an adapter (slcan) on a pty, two processes."""
    with device_process("robstride") as device, own_processors(device.process.pid):
        bus = BusSettings("slcan", device.drive["channel"])
        bare, driven = quickest(partial(library, bus), partial(driver, bus), rounds=15)
    yield ratio_row("RobStride, slcan on a pty / robstride-dynamics", bare, driven)


@contextmanager
def library(settings: BusSettings) -> Iterator[Cycle]:
    """A command, and its answer taken apart; the actuator is enabled: one at rest has less to do."""
    bus = open_bus(settings, "library")
    with redirect_stdout(StringIO()):
        host = RobstrideBus("a bus of ours", {"joint": Motor(127, "rs-02")})
    host.channel_handler = bus
    while bus.recv(0.05) is not None:  # an answer that waits already would be taken for this cycle's
        pass

    def cycle() -> None:
        host.write_operation_frame("joint", 0.0, 0.0, 0.0)
        host.read_operation_frame("joint")

    host.enable("joint")
    yield cycle
    host.disable("joint")
    host.channel_handler = None  # else it says good-bye where it is forgotten
    bus.shutdown()


@contextmanager
def driver(settings: BusSettings) -> Iterator[Cycle]:
    """One exchange of the driver."""
    values = {"position_range_rad": 100.0, "speed_range_rad_s": 200.0, "torque_range_n_m": 0.5}
    drive = RobstrideDrive(
        RobstrideSettings.model_construct(
            interface=settings.interface, channel=settings.channel, watchdog_s=2.0, answer_timeout_s=2.0, **values
        ),
        JOINT,
    )
    drive.open(0.01)
    drive.enable(Mode.TORQUE)
    yield lambda: drive.exchange(Command(Mode.TORQUE, 0.0))
    drive.close()
