"""Whether a powered drive minds that its host has gone: powered with no demand, then left without a word."""

import time
from dataclasses import dataclass

from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import make_equipment
from drivers.contract import Command, Drive, Mode, Status
from drivers.errors import DriveConnectionError, DriveError

_SPOKEN_CYCLES = 5
_MARGIN = 1.5
_LEAST_S = 0.1


@dataclass(frozen=True, slots=True)
class Silence:
    """What came of it.

    Attributes:
        noticed: whether the drive, or its driver, took the power away.
        sentence: what was found.
    """

    noticed: bool
    sentence: str


def keep_silent(configuration: BenchConfiguration) -> Silence:
    """Power the stage with a demand of zero, say nothing for longer than the watchdog waits, and look.

    Raises:
        DriveError: it cannot be opened, powered, or asked afterwards.
    """
    drive = make_equipment(configuration).drive
    try:
        drive.open(configuration.control.period_s)
        return _silence(drive, configuration.control.period_s)
    finally:
        drive.close()


def _silence(drive: Drive, period_s: float) -> Silence:
    description = drive.describe()
    mode = Mode.DUTY if Mode.DUTY in description.modes else Mode.CURRENT
    nothing = Command(mode, 0.0)
    drive.enable(mode)
    for _ in range(_SPOKEN_CYCLES):
        time.sleep(period_s)
        drive.exchange(nothing)
    silent_s = description.watchdog_s * _MARGIN + _LEAST_S
    time.sleep(silent_s)
    try:
        status = drive.exchange(nothing).status
    except DriveConnectionError:
        raise
    except DriveError as error:
        return Silence(True, f"after {silent_s:.2g} s of silence: {error}")
    wanted = f"it has to stop after {description.watchdog_s:g} s"
    return Silence(
        status is not Status.ENABLED, f"after {silent_s:.2g} s of silence its state is {status.name}; {wanted}"
    )
