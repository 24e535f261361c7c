"""How often a fault is reset in a drive that looks at the controlword now and then."""

from contextlib import suppress
from pathlib import Path

from drivers.errors import DriveFault
from sim_backend.devices.canopen.conduct import Conduct
from sim_backend.faults.script import OverCurrent
from tests.drivers.dictionaries.attempt import OFF, PERIOD_S, cycles, device, host

RESETS = 12
TICKS_MS = (1, 2, 4, 10, 20)


def resets(sheet: Path, look_s: float, tries: int = RESETS) -> int:
    """Trip the drive so many times; how often it was reset.

    Args:
        sheet: of the drive.
        look_s: how often the drive looks at the controlword [s].
        tries: how many times.
    """
    count = 0
    with device(sheet, Conduct(look_s=look_s)) as running, host(running) as drive:
        drive.open(PERIOD_S)
        for _ in range(tries):
            axis = running.device.axis
            with running.device.lock:
                axis.meet(OverCurrent(start_s=axis.time_s, duration_s=0.02, current_a=5.0))
            cycles(drive, OFF, 0.08)
            with suppress(DriveFault):
                drive.clear_fault()
                count += 1
    return count
