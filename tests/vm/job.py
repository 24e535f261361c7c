"""The CANopen driver on the kernel's own CAN, in the guest: see run.sh. What happens is checked, not how fast."""

import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConnectionError, DriveFault
from drivers.joint import JointScale
from tests.drivers.canopen.node_double import NodeDouble

OFF, PUSH = Command(Mode.OFF), Command(Mode.CURRENT, 0.2)
PERIOD_S = 0.5  # how long a cycle waits: an emulated processor is thirty times slower than a real one


def sh(command: str) -> None:
    subprocess.run(command, shell=True, check=True)


def drive_on(channel: str) -> CanopenDrive:
    settings = CanopenSettings(bus=BusSettings("socketcan", channel), node_id=5, watchdog_s=8.0, answer_s=5.0)
    return CanopenDrive(settings, JointScale(4096, 20.0))


def until_raised(drive: CanopenDrive, error: type[Exception]) -> str:
    end_s = time.monotonic() + 60.0
    while time.monotonic() < end_s:
        try:
            drive.exchange(PUSH)
        except error as raised:
            return str(raised)
        time.sleep(PERIOD_S)
    raise AssertionError(f"no {error.__name__} was raised")


def until_off(node: NodeDouble) -> None:
    end_s = time.monotonic() + 60.0
    while node.enabled:
        assert time.monotonic() < end_s, "the motor is still on"
        time.sleep(0.01)


def drives(channel: str, node: NodeDouble) -> CanopenDrive:
    """Open, move, quick stop, fault and its name, clear; left open and off."""
    drive = drive_on(channel)
    drive.open(PERIOD_S)
    drive.enable(Mode.CURRENT)
    samples = [drive.exchange(PUSH) for _ in range(20)]
    assert samples[-1].status is Status.ENABLED
    assert samples[-1].current_a == 0.2, samples[-1]
    assert [sample.number - samples[0].number for sample in samples] == list(range(20)), "a SYNC was not answered"
    drive.quick_stop()
    drive.disable()
    until_off(node)
    drive.enable(Mode.CURRENT)
    node.fail(0x8611)
    assert "following error" in until_raised(drive, DriveFault)
    drive.clear_fault()
    return drive


def loses_and_finds_its_bus(channel: str, node: NodeDouble, drive: CanopenDrive, up: str) -> None:
    """The interface goes down in motion: an error, the drive's own stop, and a new start."""
    drive.enable(Mode.CURRENT)
    drive.exchange(PUSH)
    sh(f"ip link set {channel} down")
    print("  ", until_raised(drive, DriveConnectionError))
    until_off(node)
    drive.close()
    sh(up)
    drive.open(PERIOD_S)
    drive.clear_fault()
    drive.enable(Mode.CURRENT)
    assert drive.exchange(PUSH).status is Status.ENABLED
    drive.close()


@contextmanager
def slcand() -> Iterator[str]:
    """The kernel's serial-line CAN at one end of a line; the path of the other."""
    line = subprocess.Popen(["socat", "pty,raw,echo=0,link=/dev/vmkernel", "pty,raw,echo=0,link=/run/node"])
    while not (Path("/dev/vmkernel").exists() and Path("/run/node").exists()):
        time.sleep(0.1)
    daemon = subprocess.Popen(["slcand", "-F", "-o", "-s8", "vmkernel", "slcan0"])
    while not Path("/sys/class/net/slcan0").exists():
        time.sleep(0.1)
    sh("ip link set slcan0 up")
    try:
        yield "/run/node"
    finally:
        daemon.terminate()
        line.terminate()


def main() -> None:
    vcan_up = "ip link set vcan0 up"
    sh(f"ip link add vcan0 type vcan; {vcan_up}")
    with NodeDouble("vcan0", interface="socketcan") as node:
        drive = drives("vcan0", node)
        drive.close()
    print("vcan0: passed")

    up = "ip link set {0} up type can bitrate 1000000 restart-ms 100"
    for channel in ("can0", "can1"):
        sh(up.format(channel))
    with NodeDouble("can1", interface="socketcan") as node:
        drive = drives("can0", node)
        loses_and_finds_its_bus("can0", node, drive, up.format("can0"))
    print("can0 - can1, two emulated SJA1000 controllers: passed")

    with slcand() as path, NodeDouble(path, interface="slcan", bitrate=1_000_000, sleep_after_open=0.0) as node:
        drives("slcan0", node).close()
    print("slcan0, the kernel's own reading of slcan lines: passed")
    print("VM TESTS PASSED")


if __name__ == "__main__":
    main()
