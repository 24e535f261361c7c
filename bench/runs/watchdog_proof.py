"""Whether a drive stops by itself when its host falls silent: seen at the drive, before anything is written to it.

A small demand, silence for longer than the watchdog waits, then state and applied output are read. What the host
remembers, and what the drive makes of the next command, prove nothing.

No limit watches the motor while the host is silent. So the same demand is held first, with every sample compared with
the limits, until the joint has stood under it for as long as the silence is going to last. A joint that does not stand
is given less, in the end nothing; where even that does not hold it, the watchdog is not tried.
"""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import ceil, isnan

from bench.config.configuration import BenchConfiguration
from bench.control.cycle import OFF, Action
from bench.control.joint import ControlledJoint
from bench.control.limits import Guard
from bench.control.loop import WAKING_S
from bench.control.servo import current_servo
from bench.errors import ExperimentError
from drivers.contract import Command, Description, Drive, Inspection, Mode, Status, Watchdog

_SMALL = {Mode.DUTY: 0.02, Mode.CURRENT: 0.05, Mode.TORQUE: 0.002}  # of the supply; in A; in N m
_SHARES = (1.0, 0.5, 0.25, 0.0)
_MARGIN, _LEAST_S = 1.5, 0.1  # beyond the watchdog
_FARTHEST_RAD = 0.1  # under the demand, until the joint stands: the free play of a gear
_STILL_STEPS = 1.5  # of the position sensor
_PATIENCE_S = 2.0  # beyond twice the silence, for the joint to stand
_SHOWN_SHARE = 0.5  # of the demand, that a measured output has to reach to be told from noise
_GONE_SHARE = 0.2  # of the output before; less than that is none
_HAS_NONE = (
    "it has none, and nothing was tried: where this host falls silent, the motor goes on with the last demand. Keep a "
    "hand at the switch of its supply"
)
_LOOK_S = 0.01  # at whether the run is to stop


@dataclass(frozen=True, slots=True)
class WatchdogProof:
    """What came of it.

    Attributes:
        watchdog: PROVEN; NONE where the output went on; CONFIGURED where neither state nor output could tell.
        is_admitted: whether the drive says itself that it has none.
    """

    watchdog: Watchdog
    sentence: str
    is_admitted: bool = False


def prove_watchdog(
    drive: Drive, bench: BenchConfiguration, is_stopped: Callable[[], bool] = lambda: False
) -> WatchdogProof | None:
    """Power the stage with a small demand, say nothing for longer than the watchdog waits, and look.

    The power is off afterwards, and a fault of the drive that says only that its host was silent is cleared.

    Args:
        drive: open and disabled.
        bench: the joint's limits, rig and control period.
        is_stopped: whether the run is to end; asked in every cycle, and during the silence.

    Returns:
        What came of it; None where it was stopped.

    Raises:
        LimitTrip: the joint left its limits.
        DriveError: it cannot be powered, or asked afterwards.
        ExperimentError: the power could not be taken away.
    """
    watchdog_s = drive.describe().watchdog_s
    if watchdog_s is None:
        return WatchdogProof(Watchdog.NONE, _HAS_NONE, is_admitted=True)
    trial = _Trial(drive, bench, is_stopped, watchdog_s)
    try:
        proof = trial.run()
    except _StoppedError:
        proof = None
    except BaseException:
        trial.joint.power_off()
        raise
    if notes := trial.joint.power_off():
        raise ExperimentError("; ".join(notes))
    if proof is not None and proof.watchdog is Watchdog.PROVEN:
        drive.clear_fault()
    return proof


class _StoppedError(Exception):
    """The run is to end."""


class _Trial:
    """One trial of a watchdog; the caller takes the power away, whatever comes of it."""

    def __init__(
        self, drive: Drive, bench: BenchConfiguration, is_stopped: Callable[[], bool], watchdog_s: float
    ) -> None:
        self.joint = ControlledJoint(drive, Guard(bench.limits), current_servo(bench.rig))
        self._drive = drive
        self._found = drive.describe()
        self._is_stopped = is_stopped
        self._period_s = bench.control.period_s
        self._still_rad = _STILL_STEPS * self._found.resolution.get("position_rad", 0.0)
        self._silent_s = watchdog_s * _MARGIN + _LEAST_S

    def run(self) -> WatchdogProof:
        """Try each demand until the joint stands under one, and fall silent then."""
        joint = self.joint
        self._wake()
        joint.check(float("nan"))
        for command in self._demands():
            joint.action = Action(command)
            joint.switch()
            if self._stands(self._silent_s):
                return self._fall_silent(command)
            joint.power_off()
            joint.action = Action(OFF)
            self._stands(self._silent_s)
        return WatchdogProof(
            Watchdog.CONFIGURED,
            "not tried: the joint does not stand still with the power on and nothing demanded, and no limit would "
            "watch it during the silence. Let the arm hang at rest, or try it by hand: pull the cable in motion",
        )

    def _wake(self) -> None:
        """Take samples with the power off until none is stale: somebody may have taken a load off meanwhile."""
        self.joint.begin()
        for _ in range(ceil(WAKING_S / self._period_s)):
            if not self.joint.is_stale():
                return
            time.sleep(self._period_s)
            self.joint.begin()

    def _demands(self) -> Iterator[Command]:
        """The small demand, then less; where the drive knows positions alone, the one that it stands at."""
        mode = next((one for one in _SMALL if one in self._found.modes), Mode.POSITION)
        if mode is Mode.POSITION:
            yield Command(mode, self.joint.reading.sample.position_rad)
            return
        yield from (Command(mode, share * _SMALL[mode]) for share in _SHARES)

    def _stands(self, duration_s: float) -> bool:
        """Hold the action, every sample within the limits; tell whether the joint comes to stand for so long."""
        start_rad = rest_rad = self.joint.reading.sample.position_rad
        now_s = rested_s = time.perf_counter()
        deadline_s = now_s + 2.0 * duration_s + _PATIENCE_S
        while now_s - rested_s < duration_s:
            time.sleep(self._period_s)
            self._cycle()
            position_rad, now_s = self.joint.reading.sample.position_rad, time.perf_counter()
            if abs(position_rad - rest_rad) > self._still_rad:
                rest_rad, rested_s = position_rad, now_s
            if now_s > deadline_s or abs(position_rad - start_rad) > _FARTHEST_RAD:
                return False
        return True

    def _cycle(self) -> None:
        if self._is_stopped():
            raise _StoppedError
        self.joint.exchange()
        self.joint.check(float("nan"))

    def _fall_silent(self, command: Command) -> WatchdogProof:
        before = self._drive.inspect()
        self._cycle()  # from here on not a byte goes out
        deadline_s = time.perf_counter() + self._silent_s
        while (remaining_s := deadline_s - time.perf_counter()) > 0.0:
            time.sleep(min(remaining_s, _LOOK_S))
            if self._is_stopped():
                raise _StoppedError
        proof = _judge(self._found, self._silent_s, command, before, self._drive.inspect())
        held = (
            f"{command.mode.value} {command.value:.3g} was held before, and the joint stood for {self._silent_s:.2g} s"
        )
        return WatchdogProof(proof.watchdog, f"{proof.sentence}. {held}")


def _judge(
    found: Description, silent_s: float, demand: Command, before: Inspection, after: Inspection
) -> WatchdogProof:
    """From what the drive said before and after the silence. It is proven only where the drive itself says so."""
    seen = f"after {silent_s:.2g} s of silence {_said(after)}"
    was, stays = _output(before), _output(after)
    asked = 0.0 if demand.mode is Mode.POSITION else abs(demand.value)
    shown = was > 0.0 and (was >= _SHOWN_SHARE * asked if asked else before.status is None)
    if after.status is Status.ENABLED or (shown and stays > _GONE_SHARE * was):
        return WatchdogProof(Watchdog.NONE, f"{seen}; it has to stop {found.watchdog_s:g} s after the last demand")
    if shown or before.status is Status.ENABLED:
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
    output = "its output not measured"
    if not isnan(found.duty):
        output = f"its applied duty {found.duty:.3g}"
    elif not isnan(found.current_a):
        output = f"its motor current {found.current_a:.3g} A"
    return f"its state is {state}{fault}, {output}"
