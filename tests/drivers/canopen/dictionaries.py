"""Drives made from dictionaries of real ones: does each open, move, stop when its host is silent, and recover?

    python -m tests.drivers.canopen.dictionaries FOLDER

FOLDER holds EDS and DCF files. A simulated drive takes objects, access rights and limits from each; it behaves by
CiA 301 and 402, and shares no code with the driver. The command also prints how many fault resets succeed at drives
that look at the controlword seldom.
"""

import sys
import time
from dataclasses import dataclass
from pathlib import Path

from drivers.canopen import CanopenDrive
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveError
from tests.devices.device_process import DeviceProcess
from tests.drivers.canopen.conversation import driver_of, exchange_for, started

OFF = Command(Mode.OFF)
PUSH_A, AHEAD_RAD = 0.25, 0.2
MOVED_RAD = 0.02
SILENT_S = 2.0  # the watchdog's time, the drive's ramp, and what a busy machine adds
LOOKS_S = (0.001, 0.002, 0.004, 0.010, 0.020)
RESETS = 12


@dataclass(frozen=True)
class Tried:
    """What came of one dictionary.

    Attributes:
        name: of the file.
        steps: those that succeeded, in order: open, move, silence, recover.
        refusal: the error that ended it; "" where all four succeeded.
        watchdog: how the drive guards, in words.
    """

    name: str
    steps: tuple[str, ...]
    refusal: str = ""
    watchdog: str = ""

    @property
    def is_complete(self) -> bool:
        """Whether it opened, moved, stopped and recovered."""
        return not self.refusal


def files_of(folder: Path) -> list[Path]:
    """The dictionaries of a folder, by name."""
    return sorted(path for path in folder.iterdir() if path.suffix.lower() in (".eds", ".dcf"))


def try_dictionary(path: Path, *conduct: str) -> Tried:
    """Start a drive by a dictionary, and go through the steps.

    Args:
        path: of the EDS or DCF file.
        conduct: further options of `simulate-device canopen`.
    """
    steps: list[str] = []
    with started("slcan", "--eds", str(path), "--node", "5", *conduct) as device, driver_of(device) as drive:
        try:
            drive.open(0.01)
            steps.append("open")
            watchdog = drive.watchdog
            _move(drive)
            steps.append("move")
            _fall_silent(device)
            steps.append("silence")
            _recover(device, drive)
            steps.append("recover")
        except DriveError as error:
            return Tried(path.name, tuple(steps), str(error))
        except AssertionError as error:
            return Tried(path.name, tuple(steps), f"wrong: {error}")
    return Tried(path.name, tuple(steps), watchdog=watchdog)


def resets(look_s: float, count: int = RESETS) -> int:
    """How many fault resets out of a number succeed at a drive that looks at the controlword so seldom."""
    done = 0
    with started("slcan", "--look-s", str(look_s)) as device, driver_of(device) as drive:
        drive.open(0.005)
        for _ in range(count):
            device.side.ask("fault", name="over-current", duration_s=0.05)
            time.sleep(0.2)
            try:
                drive.exchange(OFF)
                drive.clear_fault()
                done += 1
            except DriveError:
                drive.close()
                drive.open(0.005)
    return done


def _move(drive: CanopenDrive) -> None:
    """Power the drive in a mode that it has, and go a little way."""
    before_rad = drive.exchange(OFF).position_rad
    modes = drive.describe().modes
    if Mode.CURRENT in modes:
        drive.enable(Mode.CURRENT)
        samples = exchange_for(drive, 0.4, Command(Mode.CURRENT, PUSH_A), 0.01)
    else:
        drive.enable(Mode.POSITION)
        samples = []
        for part in range(1, 21):
            samples += exchange_for(drive, 0.05, Command(Mode.POSITION, before_rad + AHEAD_RAD * part / 20), 0.01)
    moved_rad = abs(samples[-1].position_rad - before_rad)
    assert moved_rad > MOVED_RAD, f"it moved by {moved_rad:.3g} rad"


def _fall_silent(device: DeviceProcess) -> None:
    """Say nothing while the drive is powered: it has to switch off by itself."""
    device.wait_for_power(on=False, timeout_s=SILENT_S)


def _recover(device: DeviceProcess, drive: CanopenDrive) -> None:
    """Open again, have a fault, clear it, and power the drive once more."""
    drive.close()
    drive.open(0.01)
    if drive.exchange(OFF).status is Status.FAULT:
        drive.clear_fault()
    mode = next(iter(sorted(drive.describe().modes, key=lambda mode: mode is not Mode.CURRENT)))
    drive.enable(mode)
    drive.disable()
    device.wait_for_power(on=False)


def report(folder: Path) -> bool:
    """Print what came of each dictionary, and of fault resets; tell whether all is as it has to be."""
    tried = [try_dictionary(path) for path in files_of(folder)]
    for one in tried:
        sys.stdout.write(f"{one.name:40} {', '.join(one.steps):32} {one.refusal or one.watchdog}\n")
    done = {look_s: resets(look_s) for look_s in LOOKS_S}
    for look_s, count in done.items():
        sys.stdout.write(f"fault reset, looked for every {1000 * look_s:g} ms: {count} of {RESETS}\n")
    complete = sum(one.is_complete for one in tried)
    sys.stdout.write(f"{complete} of {len(tried)} open, move, stop on silence, and recover\n")
    return complete == len(tried) and all(count == RESETS for count in done.values())


if __name__ == "__main__":
    sys.exit(not report(Path(sys.argv[1])))
