"""One drive from a data sheet on a bus inside this process, and what a host gets out of it."""

import itertools
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Sample, Status, Watchdog
from drivers.errors import DriveError, WatchdogError
from drivers.joint import JointScale
from sim_backend.devices.canopen.conduct import GOOD, Conduct
from sim_backend.devices.canopen.serve import CanOpenSettings, RunningDrive, serve_canopen
from sim_backend.faults.script import OverCurrent

NODE, PERIOD_S = 5, 0.01
WATCHDOG_S, ANSWER_S = 0.4, 0.3  # a busy machine stops for a tenth of a second
RATED_A = 1.0
PUSH_A, STEP_RAD = 0.3, 0.2
MOVED_RAD = 0.03
OFF = Command(Mode.OFF)
_BUSES = itertools.count()


@dataclass(frozen=True)
class Result:
    """What became of a drive.

    Attributes:
        opened, moved, stopped, recovered: each as far as it went; stopped: by itself, on silence.
        refusal: why it is not run; "" where it is.
        is_safety: the refusal is for want of a watchdog.
        watchdog: how sure the driver says it is that the drive stops by itself.
        modes: codes of 0x6060 in use.
    """

    opened: bool = False
    moved: bool = False
    stopped: bool = False
    recovered: bool = False
    refusal: str = ""
    is_safety: bool = False
    watchdog: Watchdog = Watchdog.CONFIGURED
    modes: tuple[int, ...] = ()

    @property
    def is_right(self) -> bool:
        """Whether it runs in every respect, or is refused for safety's sake."""
        return self.is_safety or (self.opened and self.moved and self.stopped and self.recovered)


@contextmanager
def device(
    sheet: Path, conduct: Conduct = GOOD, node: int = NODE, channel: str = "", **more: Any
) -> Iterator[RunningDrive]:
    """A simulated drive at work."""
    channel = channel or f"sheet-{next(_BUSES)}"
    settings = CanOpenSettings(eds=sheet, interface="virtual", channel=channel, node_id=node, conduct=conduct, **more)
    with serve_canopen(settings) as running:
        yield running


@contextmanager
def host(
    running: RunningDrive, counts_per_turn: float = 4096, node: int = NODE, **settings: Any
) -> Iterator[CanopenDrive]:
    """A driver for it, not yet open."""
    usual: dict[str, Any] = {"watchdog_s": WATCHDOG_S, "answer_s": ANSWER_S, "listen_s": 0.05}
    bus = BusSettings("virtual", running.path)
    drive = CanopenDrive(CanopenSettings(bus=bus, node_id=node, **usual | settings), JointScale(counts_per_turn, 20.0))
    try:
        yield drive
    finally:
        drive.close()


def mode_of(drive: CanopenDrive) -> Mode:
    """The mode to try: current where the drive has it."""
    return Mode.CURRENT if Mode.CURRENT in drive.describe().modes else Mode.POSITION


def cycles(drive: CanopenDrive, command: Command, duration_s: float) -> Sample:
    """Exchange one command over and over; the last sample."""
    end_s = time.perf_counter() + duration_s
    while True:
        sample = drive.exchange(command)
        if time.perf_counter() > end_s:
            return sample
        time.sleep(PERIOD_S / 2)


def push(drive: CanopenDrive, mode: Mode, start_rad: float) -> Command:
    """A command that moves the joint a little."""
    return Command(mode, PUSH_A if mode is Mode.CURRENT else start_rad + STEP_RAD)


def attempt(sheet: Path, conduct: Conduct = GOOD, **settings: Any) -> Result:
    """Open, move, fall silent, clear, move again; then a fault of the drive's own, and clear that."""
    result = Result()
    settings = {"rated_current_a": RATED_A, **settings}
    with device(sheet, conduct) as running, host(running, **settings) as drive:
        try:
            drive.open(PERIOD_S)
            modes = tuple(drive._session.found.modes.values()) if drive._session is not None else ()
            result = replace(result, opened=True, modes=modes)
            mode, start_rad = mode_of(drive), cycles(drive, OFF, 0.05).position_rad
            drive.enable(mode)
            result = replace(result, watchdog=drive.describe().watchdog)
            moved_rad = cycles(drive, push(drive, mode, start_rad), 0.4).position_rad - start_rad
            result = replace(result, moved=moved_rad > MOVED_RAD, stopped=_falls_silent(running, drive))
            result = replace(result, recovered=_recovers(running, drive, mode))
        except DriveError as error:
            return replace(result, refusal=str(error), is_safety=isinstance(error, WatchdogError))
    return result


def _falls_silent(running: RunningDrive, drive: CanopenDrive) -> bool:
    """Whether the drive's stage is without power after a silence, and says so before anything is written."""
    time.sleep(WATCHDOG_S * 1.5 + 0.6)  # and the time of a ramp
    return drive.inspect().status is not Status.ENABLED and not running.device.axis.power.on


def _recovers(running: RunningDrive, drive: CanopenDrive, mode: Mode) -> bool:
    """Whether it moves again after the silence, and once more after a fault of its own."""
    for fails in (False, True):
        if fails:
            _fail(running, drive, mode)
        drive.clear_fault()
        start_rad = drive.exchange(OFF).position_rad
        drive.enable(mode)
        sample = cycles(drive, push(drive, mode, start_rad), 0.3)
        if sample.status is not Status.ENABLED:
            return False
    drive.disable()
    return True


def _fail(running: RunningDrive, drive: CanopenDrive, mode: Mode) -> None:
    """Let the drive trip, and wait until it says so."""
    with running.device.lock:
        running.device.axis.meet(OverCurrent(start_s=running.device.axis.time_s, duration_s=0.05, current_a=5.0))
    with suppress(DriveError):
        cycles(drive, Command(mode, drive.exchange(OFF).position_rad), 0.2)
    time.sleep(0.1)
