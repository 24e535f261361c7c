"""Whether a drive of a data sheet is homed by an index pulse, or says what it lacks."""

from pathlib import Path
from typing import NamedTuple

from drivers.canopen.cia402.homing import DriveHoming
from drivers.contract import Command, Mode
from drivers.errors import DriveError
from tests.drivers.dictionaries.attempt import PERIOD_S, RATED_A, cycles, device, host

INDEX_PULSE = DriveHoming(34, 1.0, 1.0, 20.0)  # a tenth of a turn of the joint in a third of a second
SEARCH = Command(Mode.HOME, 1.0)


class Homed(NamedTuple):
    """What became of it.

    Attributes:
        found: whether the drive says that it is at home, and counts from an index pulse.
        refusal: why it was not begun; "" where it was.
    """

    found: bool
    refusal: str = ""


def home(sheet: Path) -> Homed:
    """Home a simulated drive of a data sheet; its speeds are counts a second where it does not tell."""
    plain = _home(sheet)
    return _home(sheet, velocity_unit="counts/s") if "velocity_unit" in plain.refusal else plain


def _home(sheet: Path, **settings: str) -> Homed:
    with device(sheet) as running, host(running, rated_current_a=RATED_A, homing=INDEX_PULSE, **settings) as drive:
        try:
            drive.open(PERIOD_S)
            drive.enable(Mode.HOME)
        except DriveError as error:
            return Homed(False, str(error))
        sample = cycles(drive, SEARCH, 2.0)
        return Homed(sample.homed and running.device.axis.zero_counts != 0.0)
