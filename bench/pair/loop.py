"""The control loop of a master-slave pair: both drives exchange in every cycle, and both end in power-off.

Each cycle: send the procedure's command to the master, then to the slave, record, compare both with their limits, and
give the readings to the procedure. A limit, a stop, an error or a fault of either brakes both and takes the power from
both, whatever the other does meanwhile.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from math import ceil, nan
from typing import Any

from bench.clock import Clock
from bench.cycle import OFF, Action, Reading
from bench.driven_joint import DrivenJoint
from bench.errors import LimitTrip
from bench.loop import BRAKING_S, WAKING_S
from bench.outcome import Outcome, StopRequested, outcome_of
from bench.pair.cycle import PAIR_RECORDED, PairAction, PairProcedure, PairReading, Reach, Truth, pair_row
from bench.recorder import Recorder, Sink
from bench.stop_request import StopRequest
from drivers.contract import Status

_BRAKING = PairAction(Action(OFF), Action(OFF))


def _nothing_true() -> Truth:
    return Truth()


def _free(_reach: Reach) -> None:
    """The operator does as he likes."""


class PairLoop:
    """Runs procedures on two open drives.

    Args:
        slave, master: both disabled; they are disabled again whenever `run` returns or raises.
        clock: paces the cycles.
        period_s: control period [s], as both drives were opened with.
        truth: what acts on the arms, where that is known.
        operate: tells the operator of a simulated master what to do.
    """

    channels = PAIR_RECORDED

    def __init__(
        self,
        slave: DrivenJoint,
        master: DrivenJoint,
        clock: Clock,
        period_s: float,
        truth: Callable[[], Truth] = _nothing_true,
        operate: Callable[[Reach], None] = _free,
    ) -> None:
        self._slave, self._master = slave, master
        self._joints = (master, slave)
        self._clock = clock
        self._period_s = period_s
        self._truth = truth
        self._operate = operate
        self.cycles = 0

    @property
    def last_reading(self) -> Reading | None:
        """The slave's; None before the first trial."""
        return self._slave.last_reading

    def run(self, procedure: PairProcedure, sink: Sink, stop: StopRequest) -> Outcome:
        """Run one trial to its end.

        Args:
            procedure: fresh; it is closed when the run ends.
            sink: receives the rows and events from a thread of its own.
            stop: when set, the run ends within one cycle, both joints off.

        Returns:
            The outcome. Errors of the procedure, the drives and the sink are outcomes, not exceptions.
        """
        recorder = Recorder(sink, len(self.channels), self._clock.patience_s)
        lost_before = self._clock.overruns
        ending = Outcome("failed", "the run was torn down")
        try:
            ending = outcome_of(self._check_before_motion, lambda: self._run_cycles(procedure, recorder, stop), stop)
        finally:
            # also reached by what is no `Exception`: never leave a drive powered, nor the recorder running
            try:
                if ending.outcome not in ("completed", "refused"):
                    ending = ending.with_notes(self._brake(recorder, ending.reason))
            finally:
                try:
                    ending = ending.with_notes(self._master.power_off())
                finally:
                    ending = ending.with_notes(self._slave.power_off())
            procedure.close()
            reading = self.last_reading
            ending = ending.recorded(recorder, reading.time_s if reading is not None else 0.0)
        return replace(ending, cycles=self.cycles, overruns=self._clock.overruns - lost_before)

    def _check_before_motion(self) -> str:
        """Take samples with the power off, and say what forbids motion."""
        self.cycles = 0
        samples = {joint: joint.drive.exchange(OFF) for joint in self._joints}
        self._clock.start(self._period_s)
        for _ in range(ceil(WAKING_S / self._period_s)):
            if not any(joint.is_stale(sample) for joint, sample in samples.items()):
                break
            self._clock.wait()
            samples = {joint: joint.drive.exchange(OFF) for joint in self._joints}
        try:
            for joint, sample in samples.items():
                joint.check(joint.begin(sample), nan)
        except LimitTrip as trip:
            return f"before motion: {trip}"
        return ""

    def _run_cycles(self, procedure: PairProcedure, recorder: Recorder, stop: StopRequest) -> dict[str, Any]:
        action = next(procedure)
        self._clock.start(self._period_s)
        while True:
            self._clock.wait()
            if stop.is_set():
                raise StopRequested
            reading = self._cycle(action, recorder)
            self._master.check(reading.master, action.master.target_rad)
            self._slave.check(reading.slave, action.slave.target_rad)
            try:
                action = procedure.send(reading)
            except StopIteration as end:
                return end.value or {}

    def _cycle(self, action: PairAction, recorder: Recorder) -> PairReading:
        if action.reach is not None:
            self._operate(action.reach)
        commands = (action.master.command, action.slave.command)
        # both before either moves: powering a stage may take longer than the other one's watchdog waits
        powered = [joint.power_for(command) for joint, command in zip(self._joints, commands, strict=True)]
        if any(powered):
            self._clock.start(self._period_s)
        master, slave = (joint.exchange(command) for joint, command in zip(self._joints, commands, strict=True))
        reading = PairReading(slave, master, self._truth())
        self.cycles += 1
        recorder.row(pair_row(action, reading))
        if action.slave.event is not None:
            recorder.event(slave.time_s, *action.slave.event)
        return reading

    def _brake(self, recorder: Recorder, known: str) -> list[str]:
        """Let both drives brake until both stand, and record it; says what went wrong and is not known yet."""
        powered = [joint for joint in self._joints if joint.is_powered]
        notes = [note for joint in powered for note in joint.quick_stop(known)]
        for _ in range(ceil(BRAKING_S / self._period_s) if powered else 0):
            with suppress(BaseException):  # a second Ctrl-C, too: on to power-off
                self._clock.wait()
            if not self._braking_cycle(recorder):
                break
        return notes

    def _braking_cycle(self, recorder: Recorder) -> bool:
        """One exchange with each that answers; True while one of them still brakes."""
        found = {}
        for joint in self._joints:
            with suppress(BaseException):  # the other one has to come to rest all the same
                found[joint] = joint.coast()
        if len(found) == len(self._joints) and recorder.error is None:
            master, slave = (found[joint] for joint in self._joints)
            with suppress(Exception):
                recorder.row(pair_row(_BRAKING, PairReading(slave, master, self._truth())))
        return any(reading.sample.status is Status.QUICK_STOP for reading in found.values())
