"""The control loop: one code path for every drive, real or simulated, and every experiment.

Each cycle: send the procedure's command, take the sample, compare it with the limits, record it, and give it to the
procedure. However a run ends, it ends in power-off, and the outcome says why.
"""

from dataclasses import dataclass, field, replace
from math import ceil, isnan, nan
from typing import Any, Literal

from bench.control.clock import Clock
from bench.control.cycle import OFF, RECORDED, Action, Procedure, Reading, row_of
from bench.control.late_cycles import LateCycles, braking_cycles
from bench.control.limits import Guard
from bench.control.recorder import Recorder, Sink
from bench.control.servo import CurrentServo
from bench.control.stop_request import StopRequest
from bench.errors import ConfigurationError, LimitTrip
from drivers.contract import Command, Drive, Mode, Sample, Status
from drivers.errors import DriveStateError

__all__ = ["OFF", "RECORDED", "Action", "ControlLoop", "Outcome", "OutcomeName", "Procedure", "Reading"]

_OFF, _DUTY, _CURRENT, _ENABLED = Mode.OFF, Mode.DUTY, Mode.CURRENT, Status.ENABLED  # at hand, see cycle.py
WAKING_S = 1.0  # longest wait for a drive that nobody has asked for a while
OutcomeName = Literal["running", "completed", "stopped", "tripped", "failed", "interrupted", "refused"]


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a run ended.

    Attributes:
        outcome: one of `OutcomeName`.
        reason: why, in words; empty when completed.
        results: what the procedure returned.
        cycles: control cycles run.
        overruns: cycles lost because the host was late.
    """

    outcome: OutcomeName
    reason: str = ""
    results: dict[str, Any] = field(default_factory=dict)
    cycles: int = 0
    overruns: int = 0


_BRAKING = Action(OFF)


class _StopRequested(Exception):
    """Raised inside the loop when the stop event is set."""


class ControlLoop:
    """Runs procedures on an open drive.

    Args:
        drive: open and disabled; it is disabled again whenever `run` returns or raises.
        clock: paces the cycles.
        guard: the limits.
        period_s: control period [s], as the drive was opened with.
        current_servo: eq. (3); None where the rig does not say enough. Then there is no current estimate, and
            current commands need a drive with a current mode.
    """

    channels = RECORDED

    def __init__(
        self, drive: Drive, clock: Clock, guard: Guard, period_s: float, current_servo: CurrentServo | None = None
    ) -> None:
        self._drive = drive
        self._clock = clock
        self._guard = guard
        self._period_s = period_s
        self._current_servo = current_servo
        self._has_current_mode = Mode.CURRENT in drive.describe().modes
        self._mode = Mode.OFF  # of the power stage
        self._origin_s = 0.0
        self._previous: Sample | None = None
        self._velocity_rad_s = 0.0
        self._late = LateCycles(clock, period_s)
        self.cycles = 0
        self.last_reading: Reading | None = None

    def run(self, procedure: Procedure, sink: Sink, stop: StopRequest) -> Outcome:
        """Run one trial to its end.

        Args:
            procedure: fresh; it is closed when the run ends.
            sink: receives the rows and events from a thread of its own.
            stop: when set, the run ends in power-off within one cycle. An interrupt from the keyboard sets it too,
                so that a series of trials ends with the first.

        Returns:
            The outcome. Errors of the procedure, the drive and the sink are outcomes, not exceptions.
        """
        recorder = Recorder(sink, len(self.channels), self._clock.patience_s)
        lost_before = self._clock.overruns
        ending = Outcome("failed", "the run was torn down")
        try:
            ending = self._run_guarded(procedure, recorder, stop)
        finally:
            # also reached by what is no `Exception`: never leave the drive powered, nor the recorder running
            if ending.outcome not in ("completed", "refused"):
                ending = _with_notes(ending, self._brake(recorder, ending.reason))
            ending = _with_notes(ending, self._power_off())
            procedure.close()
            ending = self._close(recorder, ending)
        return replace(ending, cycles=self.cycles, overruns=self._clock.overruns - lost_before)

    def _run_guarded(self, procedure: Procedure, recorder: Recorder, stop: StopRequest) -> Outcome:
        """Run the cycles, and turn every way they can end into an outcome."""
        try:
            refusal = self._check_before_motion()
            if refusal:
                return Outcome("refused", refusal)
            return Outcome("completed", results=self._run_cycles(procedure, recorder, stop))
        except _StopRequested:
            return Outcome("stopped", stop.reason)
        except KeyboardInterrupt:
            stop.ask("interrupted from the keyboard")
            return Outcome("stopped", stop.reason)
        except LimitTrip as trip:
            return Outcome("tripped", f"{trip}{self._late.explain(self.cycles)}")
        except Exception as error:
            return Outcome("failed", str(error) or type(error).__name__)

    def _close(self, recorder: Recorder, ending: Outcome) -> Outcome:
        time_s = self.last_reading.time_s if self.last_reading is not None else 0.0
        try:
            recorder.event(time_s, "end", _joined(ending.outcome, ending.reason))
        except Exception as error:
            ending = _with_notes(ending, [str(error)])
        try:
            recorder.close()
        except Exception as error:
            ending = _with_notes(ending, [str(error)])
        return ending

    def _check_before_motion(self) -> str:
        """Take a sample with the power off, and say what forbids motion."""
        self.cycles = 0
        self._late = LateCycles(self._clock, self._period_s)
        self._previous = None
        self._velocity_rad_s = 0.0
        sample = self._fresh_sample()
        self._origin_s = sample.time_s
        reading, _ = self._read(sample)
        self.last_reading = reading
        try:
            self._guard.check(sample, reading.velocity_rad_s, reading.current_a, nan)
        except LimitTrip as trip:
            return f"before motion: {trip}"
        return ""

    def _fresh_sample(self) -> Sample:
        """A sample with the power off; nothing in it is too old, where the drive gets that far within a second.

        After a pause - somebody has hung a load - what a drive asks for seldom is as old as the pause.
        """
        sample = self._drive.exchange(OFF)
        self._clock.start(self._period_s)
        for _ in range(ceil(WAKING_S / self._period_s)):
            if not self._guard.is_stale(sample):
                break
            self._clock.wait()
            sample = self._drive.exchange(OFF)
        return sample

    def _run_cycles(self, procedure: Procedure, recorder: Recorder, stop: StopRequest) -> dict[str, Any]:
        exchange, check, wait, record = self._drive.exchange, self._guard.check, self._clock.wait, recorder.row
        send, stopping, look = procedure.send, stop.is_set, self._late.look
        action = next(procedure)
        self._clock.start(self._period_s)
        while True:
            wait()
            if stopping():
                raise _StopRequested
            command = self._wire_command(action.command)
            sample = exchange(command)
            reading, estimate_a = self._read(sample)
            self.cycles += 1
            look(self.cycles)
            self.last_reading = reading
            record(row_of(action, reading, estimate_a))
            _, target_rad, _, event, _ = action
            time_s, _, velocity_rad_s, current_a = reading
            if event is not None:
                recorder.event(time_s, *event)
            check(sample, velocity_rad_s, current_a, target_rad)
            if self._mode is not _OFF and sample.status is not _ENABLED:
                if sample.status is Status.FAULT:
                    exchange(command)  # a drive in fault refuses it, and says what the fault is
                raise DriveStateError(
                    self._drive.describe().device,
                    f"status is {sample.status.name} during motion; ENABLED is wanted. See the drive's own display",
                )
            try:
                action = send(reading)
            except StopIteration as end:
                return end.value or {}

    def _wire_command(self, command: Command) -> Command:
        """The command in a mode that the drive closes itself; powers the stage for it where it is not."""
        mode, value, _ = command
        if mode is _CURRENT and not self._has_current_mode:
            if self._current_servo is None or self._previous is None:
                raise ConfigurationError(
                    "the drive has no current mode, and the rig lacks the resistance, back-EMF constant or gear ratio "
                    "that eq. (3) needs to do without; add them to the rig"
                )
            mode = _DUTY
            value = self._current_servo.duty(value, self._previous, self._velocity_rad_s)
            command = Command(mode, value)
        if mode is not self._mode:
            self._switch(mode)
        return command

    def _switch(self, mode: Mode) -> None:
        # marked before the call: an `enable` that fails half-way may have powered the stage
        self._mode = mode
        if mode is Mode.OFF:
            self._drive.disable()
        else:
            self._drive.enable(mode)
        self._clock.start(self._period_s)

    def _read(self, sample: Sample) -> tuple[Reading, float]:
        """The reading of a sample, and its current by eq. (3) (NaN where that is not known)."""
        time_s, _, _, velocity_rad_s, _, measured_a, _, _, _, _, _ = sample
        if velocity_rad_s != velocity_rad_s:  # NaN
            velocity_rad_s = self._derived_velocity(sample)
        self._velocity_rad_s = velocity_rad_s
        self._previous = sample
        servo = self._current_servo
        estimate_a = nan if servo is None else servo.estimate_a(sample, velocity_rad_s)
        current_a = estimate_a if isnan(measured_a) else measured_a
        return Reading(time_s - self._origin_s, sample, velocity_rad_s, current_a), estimate_a

    def _derived_velocity(self, sample: Sample) -> float:
        previous = self._previous
        if previous is None:
            return 0.0
        elapsed_s = sample.time_s - previous.time_s
        if elapsed_s <= 0.0:
            return self._velocity_rad_s
        return (sample.position_rad - previous.position_rad) / elapsed_s

    def _brake(self, recorder: Recorder, known: str) -> list[str]:
        """Let the drive brake the joint until it stands, and record it; says what went wrong and is not known yet."""
        if self._mode is Mode.OFF:
            return []
        try:
            self._drive.quick_stop()
            for _ in braking_cycles(self._clock, self._period_s):
                self._clock.wait()
                sample = self._drive.exchange(OFF)
                reading, estimate_a = self._read(sample)
                self.last_reading = reading
                if recorder.error is None:
                    recorder.row(row_of(_BRAKING, reading, estimate_a))
                if sample.status is not Status.QUICK_STOP:
                    break
        except BaseException as error:  # a second Ctrl-C, too: on to power-off
            what = str(error) or type(error).__name__
            return [] if what in known else [f"quick stop failed: {what}"]
        return []

    def _power_off(self) -> list[str]:
        """Take the power away, and say what went wrong. Tried again when it fails or is interrupted."""
        notes = []
        for _ in range(3):
            try:
                self._drive.disable()
                break
            except BaseException as error:  # the power has to go, whatever happens meanwhile
                notes.append(f"power-off failed: {str(error) or type(error).__name__}")
        self._mode = Mode.OFF
        return notes


def _joined(*reasons: str) -> str:
    return "; ".join(dict.fromkeys(reason for reason in reasons if reason))


def _with_notes(ending: Outcome, notes: list[str]) -> Outcome:
    """An outcome that also says what went wrong while it ended; it is not a completed run then."""
    if not notes:
        return ending
    outcome: OutcomeName = "failed" if ending.outcome == "completed" else ending.outcome
    # the sink's failure ends the run and is met again at the close: said once
    new = [note for note in notes if note not in ending.reason]
    return replace(ending, outcome=outcome, reason=_joined(ending.reason, *new))
