"""How quick the Feetech driver is beside Feetech's own library (`tests.drivers.rates`)."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

from scservo_sdk import COMM_SUCCESS, GroupSyncRead, GroupSyncWrite, PortHandler, sms_sts

from drivers.contract import Command, Mode
from drivers.feetech.drive import FeetechDrive
from drivers.feetech.settings import FeetechSettings
from drivers.joint import JointScale
from tests.devices.device_process import device_process
from tests.devices.turns import own_processors
from tests.drivers.rate_rows import Cycle, quickest, ratio_row

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
GOAL_TIME, PIECE, TORQUE_ENABLE = 44, 40, 40


def rows() -> Iterator[str]:
    """The rows."""
    for joints in (1, 4):
        with (
            device_process("feetech", "--joints", str(joints), "--baud", "0") as device,
            own_processors(device.process.pid),
        ):
            bare, driven = quickest(partial(library, device.port, joints), partial(driver, device.port, joints))
        yield ratio_row(f"Feetech, {joints} on a pty / ftservo-python-sdk", bare, driven)


@contextmanager
def library(path: str, joints: int) -> Iterator[Cycle]:
    """One sync write and one sync read of what the driver reads, too; the servos are on, as with the driver."""
    port = PortHandler(path)
    port.openPort()
    port.ser.timeout = 0.001  # it polls without a pause otherwise, and keeps the kernel from the pty
    host = sms_sts(port)
    goals, found = GroupSyncWrite(host, GOAL_TIME, 2), GroupSyncRead(host, PIECE, 31)
    for servo in range(1, joints + 1):
        goals.addParam(servo, [0, 0])
        found.addParam(servo)
        assert host.write1ByteTxRx(servo, TORQUE_ENABLE, 1)[0] == COMM_SUCCESS

    def cycle() -> None:
        goals.txPacket()
        assert found.txRxPacket() == COMM_SUCCESS
        for servo in range(1, joints + 1):
            for address, size in ((56, 2), (58, 2), (60, 2), (69, 2)):
                found.getData(servo, address, size)

    yield cycle
    for servo in range(1, joints + 1):
        host.write1ByteTxRx(servo, TORQUE_ENABLE, 0)
    port.closePort()


@contextmanager
def driver(path: str, joints: int) -> Iterator[Cycle]:
    """One exchange of the driver."""
    drives = [
        FeetechDrive(
            FeetechSettings.model_construct(port=path, servo_id=servo, accept_no_watchdog=True, answer_timeout_s=2.0),
            JOINT,
        )
        for servo in range(1, joints + 1)
    ]
    for drive in drives:
        drive.open(0.02)
    for drive in drives:
        drive.enable(Mode.DUTY)
    push = Command(Mode.DUTY, 0.0)
    commands = [(drive, push) for drive in drives]
    yield (lambda: drives[0].exchange_together(commands)) if joints > 1 else lambda: drives[0].exchange(push)
    for drive in drives:
        drive.close()
