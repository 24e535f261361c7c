"""Whether a drive stops by itself when its host falls silent: seen at the drive, before anything is written to it.

A small demand, silence for longer than the watchdog waits, then state and applied output are read. What the host
remembers, and what the drive makes of the next command, prove nothing.
"""

import time
from dataclasses import dataclass
from math import isnan

from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import make_equipment
from drivers.contract import Command, Description, Drive, Inspection, Mode, Status, Watchdog

_SMALL = {
    Mode.DUTY: 0.02,
    Mode.CURRENT: 0.05,
    Mode.TORQUE: 0.002,
    Mode.POSITION: 0.0,
}  # friction holds most joints against it
_SPOKEN_CYCLES = 5
_MARGIN = 1.5
_LEAST_S = 0.1
_HAS_NONE = (
    "it has none, and nothing was tried: where this host falls silent, the motor goes on with the last demand. Keep a "
    "hand at the switch of its supply"
)
_GONE_SHARE = 0.1  # of the output before; less than that is none


@dataclass(frozen=True, slots=True)
class WatchdogProof:
    """What came of it.

    Attributes:
        watchdog: PROVEN; NONE where the output went on; CONFIGURED where neither state nor output could tell.
        sentence: what was found.
        is_admitted: whether the drive says itself that it has none.
    """

    watchdog: Watchdog
    sentence: str
    is_admitted: bool = False


def prove_watchdog(configuration: BenchConfiguration) -> WatchdogProof:
    """Power the stage with a small demand, say nothing for longer than the watchdog waits, and look.

    Raises:
        DriveError: it cannot be opened, powered, or asked afterwards.
    """
    drive = make_equipment(configuration).drive
    try:
        drive.open(configuration.control.period_s)
        return keep_silent(drive, configuration.control.period_s)
    finally:
        drive.close()


def keep_silent(drive: Drive, period_s: float) -> WatchdogProof:
    """The same on an open drive. The power is off afterwards.

    Raises:
        DriveError: it cannot be powered, or asked afterwards.
    """
    description = drive.describe()
    if description.watchdog_s is None:
        return WatchdogProof(Watchdog.NONE, _HAS_NONE, is_admitted=True)
    mode = next(one for one in _SMALL if one in description.modes)
    drive.enable(mode)
    try:
        demand = _held(drive, mode)
        for _ in range(_SPOKEN_CYCLES):
            time.sleep(period_s)
            drive.exchange(demand)
        before = drive.inspect()
        drive.exchange(demand)  # from here on not a byte goes out
        silent_s = description.watchdog_s * _MARGIN + _LEAST_S
        time.sleep(silent_s)
        return _judge(description, silent_s, before, drive.inspect())
    finally:
        drive.disable()


def _held(drive: Drive, mode: Mode) -> Command:
    """A small demand; where the drive knows positions alone, the one that it stands at."""
    if mode is not Mode.POSITION:
        return Command(mode, _SMALL[mode])
    position_rad = drive.exchange(Command(Mode.OFF)).position_rad
    drive.enable(mode)
    return Command(mode, position_rad)


def _judge(found: Description, silent_s: float, before: Inspection, after: Inspection) -> WatchdogProof:
    """From what the drive said before and after the silence. It is proven only where the drive itself says so."""
    seen = f"after {silent_s:.2g} s of silence {_said(after)}"
    was, stays = _output(before), _output(after)
    goes_on = was > 0.0 and stays > _GONE_SHARE * was
    if goes_on or after.status is Status.ENABLED:
        return WatchdogProof(Watchdog.NONE, f"{seen}; it has to stop {found.watchdog_s:g} s after the last demand")
    if was > 0.0 or before.status is Status.ENABLED:
        return WatchdogProof(Watchdog.PROVEN, f"{seen}, read before anything was written")
    return WatchdogProof(
        Watchdog.CONFIGURED,
        f"{seen}, and {_said(before)} before it: that does not tell whether it has stopped. Watch the motor and try it "
        "by hand: pull the cable in motion",
    )


def _output(found: Inspection) -> float:
    """Magnitude of the applied duty, or of the motor current where that alone is measured; 0 where neither is."""
    return next((abs(value) for value in (found.duty, found.current_a) if not isnan(value)), 0.0)


def _said(found: Inspection) -> str:
    """What the drive says of itself, in words."""
    state = "not told" if found.status is None else found.status.name
    fault = f" ({found.fault})" if found.fault else ""
    duty = "not measured" if isnan(found.duty) else f"{found.duty:.3g}"
    return f"its state is {state}{fault}, its applied duty {duty}"
