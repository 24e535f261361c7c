"""The control loop: one code path for every drive, real or simulated, and every experiment.

Each cycle: send the procedure's command, take the sample, compare it with the limits, record it, and give it to the
procedure. However a run ends, it ends in power-off, and the outcome says why.
"""

from dataclasses import replace
from math import ceil, nan
from typing import Any

from bench.clock import Clock
from bench.cycle import OFF, RECORDED, Action, Procedure, Reading, row_of
from bench.driven_joint import DrivenJoint
from bench.errors import LimitTrip
from bench.limits import Guard
from bench.outcome import Outcome, OutcomeName, StopRequested, outcome_of
from bench.recorder import Recorder, Sink
from bench.servo import CurrentServo
from bench.stop_request import StopRequest
from drivers.contract import Drive, Sample, Status

__all__ = ["OFF", "RECORDED", "Action", "ControlLoop", "Outcome", "OutcomeName", "Procedure", "Reading"]

WAKING_S = 1.0  # longest wait for a drive that nobody has asked for a while
BRAKING_S = 0.5  # longest wait for a quick stop to bring the joint to rest

_BRAKING = Action(OFF)


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
        self._joint = DrivenJoint(drive, guard, current_servo)
        self._clock = clock
        self._period_s = period_s
        self.cycles = 0

    @property
    def last_reading(self) -> Reading | None:
        """None before the first trial."""
        return self._joint.last_reading

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
            ending = outcome_of(self._check_before_motion, lambda: self._run_cycles(procedure, recorder, stop), stop)
        finally:
            # also reached by what is no `Exception`: never leave the drive powered, nor the recorder running
            if ending.outcome not in ("completed", "refused"):
                ending = ending.with_notes(self._brake(recorder, ending.reason))
            ending = ending.with_notes(self._joint.power_off())
            procedure.close()
            reading = self.last_reading
            ending = ending.recorded(recorder, reading.time_s if reading is not None else 0.0)
        return replace(ending, cycles=self.cycles, overruns=self._clock.overruns - lost_before)

    def _check_before_motion(self) -> str:
        """Take a sample with the power off, and say what forbids motion."""
        self.cycles = 0
        reading = self._joint.begin(self._fresh_sample())
        try:
            self._joint.check(reading, nan)
        except LimitTrip as trip:
            return f"before motion: {trip}"
        return ""

    def _fresh_sample(self) -> Sample:
        """A sample with the power off; nothing in it is too old, where the drive gets that far within a second.

        After a pause - somebody has hung a load - what a drive asks for seldom is as old as the pause.
        """
        exchange = self._joint.drive.exchange
        sample = exchange(OFF)
        self._clock.start(self._period_s)
        for _ in range(ceil(WAKING_S / self._period_s)):
            if not self._joint.is_stale(sample):
                break
            self._clock.wait()
            sample = exchange(OFF)
        return sample

    def _run_cycles(self, procedure: Procedure, recorder: Recorder, stop: StopRequest) -> dict[str, Any]:
        joint, clock, stopping = self._joint, self._clock, stop.is_set
        action = next(procedure)
        clock.start(self._period_s)
        while True:
            clock.wait()
            if stopping():
                raise StopRequested
            command, target_rad, _, event = action
            if joint.power_for(command):
                clock.start(self._period_s)
            reading = joint.exchange(command)
            self.cycles += 1
            recorder.row(row_of(action, reading))
            if event is not None:
                recorder.event(reading.time_s, *event)
            joint.check(reading, target_rad)
            try:
                action = procedure.send(reading)
            except StopIteration as end:
                return end.value or {}

    def _brake(self, recorder: Recorder, known: str) -> list[str]:
        """Let the drive brake the joint until it stands, and record it; says what went wrong and is not known yet."""
        joint = self._joint
        if not joint.is_powered:
            return []
        try:
            joint.drive.quick_stop()
            for _ in range(ceil(BRAKING_S / self._period_s)):
                self._clock.wait()
                reading = joint.coast()
                if recorder.error is None:
                    recorder.row(row_of(_BRAKING, reading))
                if reading.sample.status is not Status.QUICK_STOP:
                    break
        except BaseException as error:  # a second Ctrl-C, too: on to power-off
            return joint.problem("quick stop failed", error, known)
        return []
