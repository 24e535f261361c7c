"""How quick the Dynamixel driver is beside ROBOTIS' library, and how much of a line it uses (`tests.drivers.rates`)."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

from dynamixel_sdk import COMM_SUCCESS, GroupSyncRead, GroupSyncWrite, PacketHandler, PortHandler

from drivers.contract import Command, Mode
from drivers.dynamixel.control_table import GATHERED
from drivers.dynamixel.drive import DynamixelDrive
from drivers.dynamixel.frames import STATUS_BYTES, sync_read_packet, sync_write_packet
from drivers.dynamixel.settings import DynamixelSettings
from drivers.joint import JointScale
from tests.devices.device_process import device_process
from tests.devices.turns import own_processors
from tests.drivers.rate_rows import Cycle, quickest, ratio_row, row

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
BAUD_RATE, LEAST_SHARE = 1_000_000, 0.85
JOINTS = (1, 4, 7)
PERIOD_S = 0.02
GOAL_PWM, PIECE = 100, 224
PUSH = Command(Mode.DUTY, 0.0)


def rows() -> Iterator[str]:
    """The rows."""
    for joints in (1, 4):
        with (
            device_process("dynamixel", "--joints", str(joints), "--baud", "0") as device,
            own_processors(device.process.pid),
        ):
            bare, driver = quickest(partial(_library, device.port, joints), partial(_driver, device.port, joints))
        yield ratio_row(f"Dynamixel, {joints} on a pty / dynamixel-sdk", bare, driver)
    for joints in JOINTS:
        yield _line_row(joints)


def _line_row(joints: int) -> str:
    """How much of a line of 1 Mbaud is used while goals are written and measurements read."""
    line_s = _cycle_bytes(joints) * 10 / BAUD_RATE
    with (
        device_process("dynamixel", "--joints", str(joints), "--baud", str(BAUD_RATE)) as device,
        own_processors(device.process.pid),
    ):
        library_s, cycle_s = quickest(partial(_library, device.port, joints), partial(_driver, device.port, joints))
    share, its_share = line_s / cycle_s, line_s / library_s
    return row(
        f"Dynamixel, {joints} joint{'s' if joints > 1 else ''}, line paced as {BAUD_RATE} baud",
        f">= {100.0 * LEAST_SHARE:.0f} %",
        f"{100.0 * share:.1f} % ({1.0 / cycle_s:.0f} of {1.0 / line_s:.0f} cycles/s); its SDK {its_share:.1%}",
        share >= LEAST_SHARE,
    )


def _cycle_bytes(joints: int) -> int:
    """There and back; one servo alone is asked by a plain read, which has the length of a question to no servo."""
    ids = tuple(range(1, joints + 1))
    there = len(sync_write_packet(dict.fromkeys(ids, b"\0\0"), GOAL_PWM))
    asked = len(sync_read_packet(ids if joints > 1 else (), PIECE, len(GATHERED)))
    return there + asked + joints * (STATUS_BYTES + len(GATHERED))


@contextmanager
def _library(path: str, joints: int) -> Iterator[Cycle]:
    port, packets = PortHandler(path), PacketHandler(2.0)
    port.openPort()
    port.ser.timeout = 0.001  # it polls without a pause otherwise, and keeps the kernel from the pty
    goals = GroupSyncWrite(port, packets, GOAL_PWM, 2)
    found = GroupSyncRead(port, packets, 124, len(GATHERED))
    for servo in range(1, joints + 1):
        goals.addParam(servo, [0, 0])
        found.addParam(servo)

    def cycle() -> None:
        goals.txPacket()
        assert found.txRxPacket() == COMM_SUCCESS
        for servo in range(1, joints + 1):
            for address, size in ((124, 2), (126, 2), (128, 4), (132, 4)):
                found.getData(servo, address, size)

    yield cycle
    port.closePort()


@contextmanager
def _driver(path: str, joints: int) -> Iterator[Cycle]:
    drives = [
        DynamixelDrive(
            DynamixelSettings.model_construct(
                port=path, baud_rate=BAUD_RATE, servo_id=servo, watchdog_s=2.0, answer_timeout_s=2.0
            ),
            JOINT,
        )
        for servo in range(1, joints + 1)
    ]
    for drive in drives:
        drive.open(PERIOD_S)
    for drive in drives:
        drive.enable(Mode.DUTY)
    commands = [(drive, PUSH) for drive in drives]
    yield (lambda: drives[0].exchange_together(commands)) if joints > 1 else lambda: drives[0].exchange(PUSH)
    for drive in drives:
        drive.close()
