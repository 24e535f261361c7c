"""What tests and benchmarks of the driver against the simulated device share."""

import time
from collections.abc import Iterator
from contextlib import contextmanager

from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Sample
from drivers.joint import JointScale
from tests.devices.device_process import DeviceProcess, device_process

JOINT = JointScale(4096, 20.0)  # of the preset `paper`
PERIOD_S = 0.005
WATCHDOG_S, ANSWER_S = 0.6, 0.4
TRANSPORTS = ("slcan", "socketcand")


def bus_of(device: DeviceProcess) -> BusSettings:
    """The bus to a device, as the command that started it prints it."""
    values = {name: value for name, value in device.drive.items() if name in BusSettings.__match_args__}
    return BusSettings(**values)


@contextmanager
def started(interface: str, *options: str) -> Iterator[DeviceProcess]:
    """A device in a process of its own."""
    with device_process("canopen", "--interface", interface, *options) as device:
        yield device


@contextmanager
def driver_of(device: DeviceProcess, **settings: object) -> Iterator[CanopenDrive]:
    """A driver for a device whose faults are repaired; not yet open. A busy machine stops for 50 ms: it is patient."""
    device.side.ask("repair")
    values = {"node_id": 5, "watchdog_s": WATCHDOG_S, "answer_s": ANSWER_S} | settings
    drive = CanopenDrive(CanopenSettings(bus=bus_of(device), **values), JOINT)  # type: ignore[arg-type]
    try:
        yield drive
    finally:
        drive.close()


def exchange_for(drive: CanopenDrive, duration_s: float, command: Command, period_s: float = PERIOD_S) -> list[Sample]:
    """Exchange one command over and over."""
    samples = []
    end_s = deadline_s = time.perf_counter()
    end_s += duration_s
    while (now_s := time.perf_counter()) < end_s:
        samples.append(drive.exchange(command))
        deadline_s = max(deadline_s + period_s, now_s)
        time.sleep(max(0.0, deadline_s - time.perf_counter()))
    return samples


def hold(drive: CanopenDrive, target_rad: float, duration_s: float) -> Sample:
    """Close the position in the host, by a current command each cycle; the last sample. Soft: cycles may come late."""
    sample = drive.exchange(Command(Mode.CURRENT, 0.0))
    integral_a, end_s = 0.0, time.perf_counter() + duration_s
    while time.perf_counter() < end_s:
        error_rad = target_rad - sample.position_rad
        integral_a = min(max(integral_a + 10.0 * error_rad * PERIOD_S, -0.5), 0.5)
        current_a = 4.0 * error_rad + integral_a - 0.4 * sample.velocity_rad_s
        sample = drive.exchange(Command(Mode.CURRENT, min(max(current_a, -1.0), 1.0)))
        time.sleep(PERIOD_S)
    return sample
