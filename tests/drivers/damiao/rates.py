"""How quick the Damiao driver is beside `damiao-motor` on the same bus (`tests.drivers.rates`)."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

from damiao_motor.core.motor import DaMiaoMotor

from drivers.can_bus.bus import open_bus
from drivers.can_bus.settings import BusSettings
from drivers.contract import Command, Mode
from drivers.damiao.drive import DamiaoDrive
from drivers.damiao.settings import DamiaoSettings
from drivers.joint import JointScale
from tests.devices.device_process import device_process
from tests.devices.turns import own_processors
from tests.drivers.rate_rows import Cycle, quickest, ratio_row

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)


def rows() -> Iterator[str]:
    """The rows: an adapter (slcan) on a pty, two processes."""
    with device_process("damiao") as device, own_processors(device.process.pid):
        bus = BusSettings("slcan", device.drive["channel"])
        bare, driven = quickest(partial(library, bus), partial(driver, bus), rounds=15)
    yield ratio_row("Damiao, slcan on a pty / damiao-motor", bare, driven)


@contextmanager
def library(settings: BusSettings) -> Iterator[Cycle]:
    """A command, and its answer taken apart; the actuator is enabled: one at rest has less to do."""
    bus = open_bus(settings, "library")
    motor = DaMiaoMotor(
        1, 0x11, bus, motor_type="4310", p_min=-100, p_max=100, v_min=-200, v_max=200, t_min=-0.5, t_max=0.5
    )

    while bus.recv(0.05) is not None:  # an answer that waits already would be taken for this cycle's
        pass

    def answer() -> None:
        message = bus.recv(1.0)
        assert message is not None
        motor.process_feedback_frame(bytes(message.data), message.arbitration_id)

    def cycle() -> None:
        motor.send_cmd_mit(0.0, 0.0, 0.0, 0.0, 0.0)
        answer()

    motor.enable()
    answer()
    yield cycle
    motor.disable()
    answer()
    bus.shutdown()


@contextmanager
def driver(settings: BusSettings) -> Iterator[Cycle]:
    """One exchange of the driver."""
    drive = DamiaoDrive(
        DamiaoSettings.model_construct(
            interface=settings.interface, channel=settings.channel, watchdog_s=2.0, answer_timeout_s=2.0
        ),
        JOINT,
    )
    drive.open(0.01)
    drive.enable(Mode.TORQUE)
    yield lambda: drive.exchange(Command(Mode.TORQUE, 0.0))
    drive.close()
