"""Faults that drives hold on to: read, and cleared once a person has seen what they are. No power is switched on."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

from bench.config.configuration import BenchConfiguration
from bench.config.drives.real import RealDriveSettings
from bench.control.drive_factory import make_equipment, share_lines
from bench.control.power.torque_off import torque_off
from bench.errors import FaultChangedError
from drivers.contract import Drive


@dataclass(frozen=True, slots=True)
class DriveState:
    """What a drive says of itself, with the power off.

    Attributes:
        joint: "joint"; "slave" and "master" of a pair.
        state: of the power stage; "" where it has no word for it.
        fault: in words; "" where it reports none.
        torque_off: what says that safe torque off is active; "" where nothing does.
    """

    joint: str
    device: str
    state: str
    fault: str
    torque_off: str = ""


def read_drives(configuration: BenchConfiguration) -> tuple[DriveState, ...]:
    """Connect to each drive of the bench, and ask.

    Raises:
        DriveError: one cannot be opened, or does not answer.
        ConfigurationError: one cannot be made.
    """
    with _opened(configuration) as drives:
        return tuple(_read(joint, drive) for joint, drive in drives.items())


def clear_faults(configuration: BenchConfiguration, shown: str) -> tuple[DriveState, ...]:
    """Clear the faults of every drive of the bench that has one, and ask again.

    Raises:
        FaultChangedError: they are others by now; nothing was cleared.
        DriveFault: a cause is still there, and so is its fault.
        DriveError, ConfigurationError: as `read_drives`.
    """
    with _opened(configuration) as drives:
        found = tuple(_read(joint, drive) for joint, drive in drives.items())
        if (now := faults_in_words(found)) != shown:
            raise FaultChangedError(
                f"the fault is '{now or 'none'}' now, and '{shown or 'none'}' was shown; nothing was cleared. Read it "
                "again, and remove its cause"
            )
        for state in found:
            if state.fault:
                drives[state.joint].clear_fault()
        return tuple(_read(joint, drive) for joint, drive in drives.items())


def faults_in_words(states: tuple[DriveState, ...]) -> str:
    """Every fault, with its joint where there are two; "" where there is none."""
    return "; ".join(
        state.fault if len(states) == 1 else f"{state.joint}: {state.fault}" for state in states if state.fault
    )


@contextmanager
def _opened(configuration: BenchConfiguration) -> Iterator[dict[str, Drive]]:
    """The drives by joint, open and without power; closed again, whatever happens."""
    benches = {"joint": configuration}
    # a simulated master is made anew for each run, and holds on to nothing
    if configuration.master is not None and isinstance(configuration.master.drive, RealDriveSettings):
        benches = {"slave": configuration, "master": configuration.of_master()}
    with ExitStack() as stack:
        drives = {joint: make_equipment(bench).drive for joint, bench in benches.items()}
        share_lines((benches[joint], drive) for joint, drive in drives.items())
        for drive in drives.values():
            stack.callback(drive.close)
            drive.open(configuration.control.period_s)
        yield drives


def _read(joint: str, drive: Drive) -> DriveState:
    found = drive.inspect()
    state = "" if found.status is None else found.status.name.lower().replace("_", " ")
    return DriveState(joint, drive.describe().device, state, found.fault, torque_off(found))
