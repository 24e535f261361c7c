"""Connect, look, measure the cycle rate. The power stage stays off."""

import time
from dataclasses import dataclass

from bench.config.configuration import BenchConfiguration
from bench.control.clock import Clock, VirtualClock, WallClock
from bench.control.cycle import OFF
from bench.control.drive_factory import is_simulated, make_equipment
from bench.control.power.torque_off import torque_off_reason
from bench.control.timing import check_timing
from drivers.contract import Description, Drive, Sample

CYCLES = 200


@dataclass(frozen=True, slots=True)
class Connection:
    """A drive as it was found.

    Attributes:
        period_s: control period that was asked for [s].
        rate_hz: cycles a second that were reached at that period.
        exchange_s: median time of one exchange [s].
        slowest_s: the longest [s].
        lost_cycles: of `CYCLES`, because one before was late.
        torque_off: why there is no power, and what to do, where safe torque off is active; else "".
    """

    description: Description
    sample: Sample
    period_s: float
    rate_hz: float
    exchange_s: float
    slowest_s: float
    lost_cycles: int
    torque_off: str = ""


def connect(configuration: BenchConfiguration) -> Connection:
    """Open the drive, run cycles with the power off, close it.

    Raises:
        DriveError: it cannot be opened, or does not answer.
        ConfigurationError: it does not fit the control period.
    """
    drive = make_equipment(configuration).drive
    period_s = configuration.control.period_s
    clock: Clock = VirtualClock() if is_simulated(configuration) else WallClock()
    try:
        drive.open(period_s)
        check_timing(drive.describe(), period_s)
        return _measure(drive, clock, period_s)
    finally:
        drive.close()


def _measure(drive: Drive, clock: Clock, period_s: float) -> Connection:
    sample = drive.exchange(OFF)
    exchanges_s = []
    clock.start(period_s)
    began_s = time.perf_counter()
    for _ in range(CYCLES):
        clock.wait()
        sent_s = time.perf_counter()
        sample = drive.exchange(OFF)
        exchanges_s.append(time.perf_counter() - sent_s)
    rate_hz = CYCLES / (time.perf_counter() - began_s)
    exchanges_s.sort()
    return Connection(
        drive.describe(), sample, period_s, rate_hz, exchanges_s[CYCLES // 2], exchanges_s[-1], clock.overruns,
        torque_off_reason(drive),
    )  # fmt: skip
