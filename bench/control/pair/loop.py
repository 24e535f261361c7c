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

from bench.control.clock import Clock
from bench.control.cycle import OFF, Action, Reading
from bench.control.late_cycles import LateCycles, braking_cycles
from bench.control.loop import WAKING_S, Outcome
from bench.control.pair.cycle import PAIR_RECORDED, PairAction, PairProcedure, PairReading, Reach, Truth, pair_row
from bench.control.pair.joint import PairJoint
from bench.control.recorder import Recorder, Sink
from bench.control.stop_request import StopRequest
from bench.errors import LimitTrip
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
        slave: PairJoint,
        master: PairJoint,
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
        self._late = LateCycles(clock, period_s)
        self.cycles = 0
        self.last_reading: Reading | None = None

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
            ending = self._run_guarded(procedure, recorder, stop)
        finally:
            # also reached by what is no `Exception`: never leave a drive powered, nor the recorder running
            try:
                if ending.outcome not in ("completed", "refused"):
                    ending = _with_notes(ending, self._brake(recorder, ending.reason))
            finally:
                try:
                    ending = _with_notes(ending, self._master.power_off())
                finally:
                    ending = _with_notes(ending, self._slave.power_off())
            procedure.close()
            ending = self._close(recorder, ending)
        return replace(ending, cycles=self.cycles, overruns=self._clock.overruns - lost_before)

    def _run_guarded(self, procedure: PairProcedure, recorder: Recorder, stop: StopRequest) -> Outcome:
        """Run the cycles, and turn every way they can end into an outcome."""
        try:
            refusal = self._check_before_motion()
            if refusal:
                return Outcome("refused", refusal)
            results = self._run_cycles(procedure, recorder, stop)
            return Outcome("stopped", stop.reason) if results is None else Outcome("completed", results=results)
        except KeyboardInterrupt:
            stop.ask("interrupted from the keyboard")
            return Outcome("stopped", stop.reason)
        except LimitTrip as trip:
            return Outcome("tripped", f"{trip}{self._late.explain(self.cycles)}")
        except Exception as error:
            return Outcome("failed", str(error) or type(error).__name__)

    def _check_before_motion(self) -> str:
        """Take samples with the power off, and say what forbids motion."""
        self.cycles = 0
        self._late = LateCycles(self._clock, self._period_s)
        samples = {joint: joint.drive.exchange(OFF) for joint in self._joints}
        self._clock.start(self._period_s)
        for _ in range(ceil(WAKING_S / self._period_s)):
            if not any(joint.is_stale(sample) for joint, sample in samples.items()):
                break
            self._clock.wait()
            samples = {joint: joint.drive.exchange(OFF) for joint in self._joints}
        try:
            for joint, sample in samples.items():
                reading = joint.begin(sample).reading
                joint.check(reading, nan)
        except LimitTrip as trip:
            return f"before motion: {trip}"
        self.last_reading = reading
        return ""

    def _run_cycles(self, procedure: PairProcedure, recorder: Recorder, stop: StopRequest) -> dict[str, Any] | None:
        """The procedure's results; None where a stop was asked for."""
        action = next(procedure)
        self._clock.start(self._period_s)
        while True:
            self._clock.wait()
            if stop.is_set():
                return None
            reading = self._cycle(action, recorder)
            self._late.look(self.cycles)
            self._master.check(reading.master, action.master.target_rad)
            self._slave.check(reading.slave, action.slave.target_rad)
            try:
                action = procedure.send(reading)
            except StopIteration as end:
                return end.value or {}

    def _cycle(self, action: PairAction, recorder: Recorder) -> PairReading:
        if action.reach is not None:
            self._operate(action.reach)
        actions = (action.master, action.slave)
        self._switch(actions)
        (master, master_a), (slave, slave_a) = (
            joint.exchange(one) for joint, one in zip(self._joints, actions, strict=True)
        )
        reading = PairReading(slave, master, self._truth())
        self.cycles += 1
        self.last_reading = slave
        recorder.row(pair_row(action, reading, slave_a, master_a))
        if action.slave.event is not None:
            recorder.event(slave.time_s, *action.slave.event)
        return reading

    def _switch(self, actions: tuple[Action, Action]) -> None:
        wanted = [(joint, one) for joint, one in zip(self._joints, actions, strict=True) if joint.needs_switch(one)]
        for joint, one in wanted:
            joint.switch(one)
        if wanted:
            self._clock.start(self._period_s)

    def _brake(self, recorder: Recorder, known: str) -> list[str]:
        """Let both drives brake until both stand, and record it; says what went wrong and is not known yet."""
        powered = [joint for joint in self._joints if joint.is_powered]
        notes = [note for joint in powered for note in _attempt(joint, joint.drive.quick_stop, known)]
        for _ in braking_cycles(self._clock, self._period_s) if powered else ():
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
            self.last_reading = slave.reading
            reading = PairReading(slave.reading, master.reading, self._truth())
            with suppress(Exception):
                recorder.row(pair_row(_BRAKING, reading, slave.estimate_a, master.estimate_a))
        return any(one.reading.sample.status is Status.QUICK_STOP for one in found.values())

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


def _attempt(joint: PairJoint, call: Callable[[], None], known: str) -> list[str]:
    """Call, and say what went wrong."""
    try:
        call()
    except BaseException as error:  # the other one has to stop, and both have to be powered off
        what = str(error) or type(error).__name__
        return [] if what in known else [f"{joint.name}: quick stop failed: {what}"]
    return []


def _joined(*reasons: str) -> str:
    return "; ".join(dict.fromkeys(reason for reason in reasons if reason))


def _with_notes(ending: Outcome, notes: list[str]) -> Outcome:
    """An outcome that also says what went wrong while it ended; it is not a completed run then."""
    new = [note for note in notes if note not in ending.reason]
    if not new:
        return ending
    return replace(
        ending,
        outcome="failed" if ending.outcome == "completed" else ending.outcome,
        reason=_joined(ending.reason, *new),
    )
