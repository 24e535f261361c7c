"""One bench per driver, the same joint behind each: in process, or a simulated device in a process of its own."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from tempfile import TemporaryDirectory
from typing import Any

from bench.config.configuration import BenchConfiguration, default_configuration, parse_configuration
from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.registry import drive_kinds
from bench.control.clock import Clock, VirtualClock, WallClock
from bench.control.drive_factory import make_equipment
from bench.control.ending import Outcome
from bench.control.limits import Guard
from bench.control.loop import joint_loop
from bench.control.servo import current_servo, torque_constant_n_m_a
from drivers.contract import Drive
from tests.control.fake_drive import ListSink
from tests.devices.device_process import IS_VIRTUAL, DeviceProcess, device_process

PERIOD_S = 0.01
ANSWER_TIMEOUT_S = 0.3
PATIENT = ("--patience", "0.012")  # for trials whose results count: a host that is late finds the joint where it was

# softer than on the quick in-process bench: cycles come late on a busy machine
SERVO = {"proportional_a_rad": 12.0, "integral_a_rad_s": 40.0, "derivative_a_s_rad": 0.3}
SEARCH = {"current_step_a": 0.008}


_PLAIN = ConformanceBench("")


@dataclass(frozen=True)
class Bench:
    """What a test talks to.

    Attributes:
        name: of the driver.
        configuration: with the drive's section.
        device: the process behind the wire; None in process.
        variant: what its kind says of it.
    """

    name: str
    configuration: BenchConfiguration
    device: DeviceProcess | None = None
    variant: ConformanceBench = _PLAIN

    @property
    def watched_s(self) -> float:
        """The drive's watchdog [s]."""
        return getattr(self.configuration.drive, "watchdog_s", 0.1)

    def changed(self, **sections: Any) -> "Bench":
        """The same with other sections of its configuration."""
        return replace(self, configuration=self.configuration.model_copy(update=sections))

    def clock(self) -> Clock:
        return VirtualClock() if self.device is None else WallClock()

    @contextmanager
    def drive(self) -> Iterator[Drive]:
        """A drive, not yet open; closed afterwards."""
        made = make_equipment(self.configuration, self.hang_as_asked).drive
        try:
            yield made
        finally:
            made.close()

    @contextmanager
    def opened(self) -> Iterator[Drive]:
        with self.drive() as made:
            made.open(PERIOD_S)
            yield made

    def hang_as_asked(self, sentence: str) -> bool:
        """Do what a person is asked to do, through the device's side channel."""
        assert self.device is not None
        words = sentence.split()
        load_kg = float(words[1]) / 1000.0 if words[0] == "Hang" else 0.0
        self.device.side.hang_load(load_kg, "balanced," in words)
        return True

    def repair(self) -> None:
        """Put right whatever a test has broken, wait until the motor is off, and put the arm back to angle 0."""
        if self.device is not None:
            self.device.side.ask("repair")
            self.device.wait_for_power(False)
            self.device.side.hang_load(0.0, False)


def configured(**drive: Any) -> BenchConfiguration:
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["control"]["period_s"] = PERIOD_S
    values["servo"] |= SERVO
    values["search"] |= SEARCH
    values["limits"] |= {"sample_age_s": 1.0, "slow_sample_age_s": 20.0}  # as cycles may take ten times as long
    values["limits"]["tracking_error_rad"] = 1.0
    if drive:
        drive.pop("side_channel", None)  # loads are hung by a person here, whom the tests play
        values["drive"] = drive
    return parse_configuration(values, "bench.toml")


@contextmanager
def port_name() -> Iterator[str]:
    """A name for a port that stays while the port goes and comes back."""
    with TemporaryDirectory(prefix="friction-bench-") as folder:
        yield f"{folder}/port"


@contextmanager
def set_up(kind: DriveKind[Any], variant: ConformanceBench, *device_options: str) -> Iterator[Bench]:
    """The bench of one variant of a kind, with its simulated device where it has one."""
    if kind.simulate is None:
        yield Bench(variant.name, configured(kind=kind.name, **variant.settings), variant=variant)
        return
    with port_name() as link:
        options = [*variant.device, *(("--link", link) if variant.has_link else ()), *device_options]
        with device_process(kind.name, *options) as device:
            yield Bench(variant.name, configured(**device.drive | variant.settings), device, variant)


_VARIANTS = [(kind, variant) for kind in drive_kinds().values() for variant in kind.conformance]

SERIAL, ADAPTER, TCP = ("roboclaw", "modbus-rtu"), ("canopen",), ("modbus-tcp", "canopen-socketcand")
"""One or two benches of each way to a drive, for `real_wire`: a serial port, an adapter on one, and the network."""
PORTS = (*SERIAL, "dynamixel", *ADAPTER, "moteus", "moteus-uart", *TCP)
"""One bench of each code that opens a port: other servos share that of `dynamixel`, other kinds on CAN an adapter."""

# of every kind that is installed: another package's driver is held to the contract by the same tests
BENCHES: dict[str, Callable[..., Any]] = {
    variant.name: partial(set_up, kind, variant)
    for kind, variant in _VARIANTS
    if variant.has_link or not IS_VIRTUAL  # the others are on TCP, whose time is the operating system's
}


def run(bench: Bench, drive: Drive, procedure: Any, stop: Any) -> tuple[Outcome, ListSink]:
    """Run a procedure on an open drive through the ordinary loop."""
    sink = ListSink()
    configuration = bench.configuration
    guard, servo = Guard(configuration.limits), current_servo(configuration.rig)
    loop = joint_loop(drive, bench.clock(), guard, PERIOD_S, servo, torque_constant_n_m_a(configuration.rig))
    return loop.run(procedure, sink, stop), sink
