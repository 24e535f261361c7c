"""The control loop: one code path for every drive, real or simulated, one joint or several, and every experiment.

Each cycle: send the procedure's commands, take the samples, record them, compare them with the limits, and give them to
the procedure. A limit, a stop, an error or a fault of any joint brakes all joints and takes the power from all of them,
whatever the others do meanwhile. However a run ends, it ends in power-off, and the outcome says why.
"""

from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import ceil, nan
from typing import Any, Generic

from bench.control.clock import Clock
from bench.control.cycle import Action, Reading
from bench.control.ending import Outcome, OutcomeName, StopRequest
from bench.control.joint import ControlledJoint
from bench.control.joint_group import ActionT, JointGroup, ReadingT, SingleJoint, exchange_of
from bench.control.late_cycles import BRAKING_S, LateCycles, braking_cycles
from bench.control.limits import Guard
from bench.control.power.brake_order import BrakeOrder
from bench.control.power.torque_off import torque_off_reason
from bench.control.recorder import Recorder, Sink
from bench.control.servo import CurrentServo
from bench.errors import LimitTrip
from bench.json_types import Value
from drivers.contract import Drive
from drivers.errors import DriveError

WAKING_S = 1.0  # longest wait for a drive that nobody has asked for a while
_STILL_BRAKES = (
    f"the drive still braked {BRAKING_S:g} s after the stop, and its power was taken away: its ramp is slow, or a load "
    "moves the joint on"
)


class ControlLoop(Generic[ActionT, ReadingT]):
    """Runs procedures on open drives.

    Args:
        group: the joints; their drives are open and disabled, and disabled again whenever `run` returns or raises.
        clock: paces the cycles.
        period_s: control period [s], as the drives were opened with.

    Attributes:
        last_reading: of the last joint; None before the first.
    """

    def __init__(self, group: JointGroup[ActionT, ReadingT], clock: Clock, period_s: float) -> None:
        self._group = group
        self._joints = tuple(group.joints)
        self._clock = clock
        self._period_s = period_s
        self._late = LateCycles(clock, period_s)
        self._brakes = BrakeOrder(self._joints)
        self.channels = group.channels
        self.cycles = 0
        self.last_reading: Reading | None = None
        self._was_powered = self._lost_power = False

    def run(self, procedure: Generator[ActionT, ReadingT, dict[str, Value]], sink: Sink, stop: StopRequest) -> Outcome:
        """Run one trial to its end.

        Args:
            procedure: fresh; it is closed when the run ends.
            sink: receives the rows and events from a thread of its own.
            stop: when set, the run ends in power-off within one cycle. An interrupt from the keyboard sets it too,
                so that a series of trials ends with the first.

        Returns:
            The outcome. Errors of the procedure, the drives and the sink are outcomes, not exceptions.
        """
        self._lost_power = False
        recorder = Recorder(sink, len(self.channels), self._clock.patience_s)
        lost_before = self._clock.overruns
        ending = Outcome("failed", "the run was torn down")
        # each `finally` is also reached by what is no `Exception`: no drive stays powered, no recorder running
        try:
            ending = self._run_guarded(procedure, recorder, stop)
        finally:
            try:
                if ending.outcome not in ("completed", "refused"):
                    ending = ending.with_notes(self._brake(recorder, ending.reason))
            finally:
                try:
                    ending = ending.with_notes(_power_off(self._joints))
                    ending = self._with_torque_off(ending)
                finally:
                    ending = self._close(procedure, recorder, ending)
        return replace(ending, cycles=self.cycles, overruns=self._clock.overruns - lost_before)

    def _run_guarded(
        self, procedure: Generator[ActionT, ReadingT, dict[str, Value]], recorder: Recorder, stop: StopRequest
    ) -> Outcome:
        """Run the cycles, and turn every way they can end into an outcome."""
        try:
            refusal = self._check_before_motion()
            return Outcome("refused", refusal) if refusal else self._run_cycles(procedure, recorder, stop)
        except KeyboardInterrupt:
            stop.ask("interrupted from the keyboard")
            return Outcome("stopped", stop.reason)
        except LimitTrip as trip:
            return Outcome("tripped", f"{trip}{self._late.explain(self.cycles)}")
        except Exception as error:
            self._lost_power = isinstance(error, DriveError)
            return Outcome("failed", str(error) or type(error).__name__)

    def _with_torque_off(self, ending: Outcome) -> Outcome:
        """The ending of a drive without power, with the reason where safe torque off is it. The power is off by now."""
        if not self._lost_power:
            return ending
        reasons = [f"{joint.prefix}{why}" for joint in self._joints if (why := torque_off_reason(joint.drive))]
        if not reasons:
            return ending
        outcome: OutcomeName = ending.outcome if self._was_powered else "refused"
        return replace(ending, outcome=outcome, reason="; ".join((*reasons, ending.reason)))

    def _check_before_motion(self) -> str:
        """Take samples with the power off, and say what forbids motion."""
        self.cycles = 0
        self._was_powered = False
        self._late = LateCycles(self._clock, self._period_s)
        self._take_fresh_samples()
        self.last_reading = self._joints[-1].reading
        try:
            for joint in self._joints:
                joint.check(nan)
        except LimitTrip as trip:
            return f"before motion: {trip}"
        return ""

    def _take_fresh_samples(self) -> None:
        """With the power off; nothing in them is too old, where the drives get that far within a second.

        After a pause - somebody has hung a load - what a drive asks for seldom is as old as the pause.
        """
        for joint in self._joints:
            joint.begin()
        self._clock.start(self._period_s)
        for _ in range(ceil(WAKING_S / self._period_s)):
            if not any(joint.is_stale() for joint in self._joints):
                break
            self._clock.wait()
            for joint in self._joints:
                joint.begin()

    def _run_cycles(
        self, procedure: Generator[ActionT, ReadingT, dict[str, Value]], recorder: Recorder, stop: StopRequest
    ) -> Outcome:
        # at hand: each look-up of an attribute takes a per cent of a cycle
        joints, group, wait, stopping = self._joints, self._group, self._clock.wait, stop.is_set
        assign, reading_of, row_of, record = group.assign, group.reading, group.row, recorder.row
        send, look, last, exchange = procedure.send, self._late.look, joints[-1], exchange_of(joints)
        action = next(procedure)
        self._clock.start(self._period_s)
        while True:
            wait()
            if stopping():
                return Outcome("stopped", stop.reason)
            assign(action)
            # every joint is switched before the first is sent a command: none waits under power for another
            for joint in joints:
                if joint.action[0][0] is not joint.demanded:
                    self._switch()
                    if self._brakes.joints:
                        if ended := self._brakes.release(partial(self._hold, recorder, stop)):
                            return ended
                        assign(action)
            exchange()
            self.cycles += 1
            look(self.cycles)
            self.last_reading = last.reading
            reading = reading_of()
            # the row comes before the check: the sample that trips a limit is on record
            record(row_of(action, reading))
            event = last.action[3]
            if event is not None:
                recorder.event(last.reading.time_s, *event)
            for joint in joints:
                joint.check(joint.action[1])
            try:
                action = send(reading)
            except StopIteration as end:
                ended = self._brakes.set(partial(self._hold, recorder, stop)) or Outcome("completed")
                return replace(ended, results=end.value or {})

    def _hold(self, recorder: Recorder, stop: StopRequest, duration_s: float, brake: str) -> Outcome | None:
        """Cycles in which the joints with a brake hold, watched as any other; see `BrakeOrder`."""
        exchange, group = exchange_of(self._joints), self._group
        for cycle in range(ceil(duration_s / self._period_s)):
            self._clock.wait()
            if stop.is_set():
                return Outcome("stopped", stop.reason)
            for joint in self._brakes.joints:
                joint.hold()
            exchange()
            self.cycles += 1
            self._late.look(self.cycles)
            self.last_reading = self._joints[-1].reading
            recorder.row(group.row(group.held(), group.reading()))
            if cycle == 0:
                recorder.event(self.last_reading.time_s, "brake", brake)
            for joint in self._joints:
                joint.check(nan)
                joint.check_brake()
        return None

    def _switch(self) -> None:
        for joint in self._joints:
            joint.require_mode()
        switched = [joint.switch() for joint in self._joints]
        self._was_powered = self._was_powered or any(joint.is_powered for joint in self._joints)
        if any(switched):
            self._clock.start(self._period_s)

    def _brake(self, recorder: Recorder, known: str) -> list[str]:
        """Let the drives brake until every joint stands, and record it; what went wrong and is not known yet."""
        if not any(joint.is_powered for joint in self._joints):
            return []
        notes = []
        for joint in self._joints:
            try:
                joint.quick_stop()
            except BaseException as error:  # the other joints have to brake, and all have to be powered off
                notes += _unless_known(f"{joint.prefix}quick stop failed", error, known)
        try:
            for _ in braking_cycles(self._clock, self._period_s):
                self._clock.wait()
                if not self._braking_cycle(recorder, known, notes):
                    break
            else:
                notes += [f"{joint.prefix}{_STILL_BRAKES}" for joint in self._joints if joint.brakes]
        except BaseException as error:  # a second Ctrl-C, too: on to power-off
            notes += _unless_known("quick stop failed", error, known)
        return notes

    def _braking_cycle(self, recorder: Recorder, known: str, notes: list[str]) -> bool:
        """One exchange with each joint that answers; True while one of them still brakes."""
        answered = []
        for joint in self._joints:
            try:
                joint.coast()
                answered.append(joint)
            except Exception as error:  # the other joints have to come to rest all the same
                notes += _unless_known(f"{joint.prefix}quick stop failed", error, known)
        if len(answered) == len(self._joints):
            self.last_reading = self._joints[-1].reading
            if recorder.error is None:
                # a recorder that fails says so when it is closed; the joints have to brake meanwhile
                with suppress(Exception):
                    recorder.row(self._group.row(self._group.off, self._group.reading()))
        return any(joint.brakes for joint in answered)

    def _close(self, procedure: Generator[Any, Any, Any], recorder: Recorder, ending: Outcome) -> Outcome:
        """Close the procedure and the recorder, whatever one of them raises."""
        ending = ending.with_notes(_attempt(procedure.close))
        time_s = self.last_reading.time_s if self.last_reading is not None else 0.0
        recorder.event(time_s, "end", ending.in_words())
        return ending.with_notes(_attempt(recorder.close))


def _attempt(call: Callable[[], None]) -> list[str]:
    """Call, and say what went wrong."""
    try:
        call()
    except Exception as error:
        return [str(error) or type(error).__name__]
    return []


def _unless_known(what: str, error: BaseException, known: str) -> list[str]:
    """What went wrong while the joints braked; nothing where the reason of the run's end says it already."""
    text = str(error) or type(error).__name__
    return [] if text in known else [f"{what}: {text}"]


def _power_off(joints: Sequence[ControlledJoint]) -> list[str]:
    """Take the power from every joint, and say what went wrong; whatever comes between two of them stops neither."""
    if not joints:
        return []
    notes: list[str] = []
    try:
        notes += joints[0].power_off()
    finally:
        notes += _power_off(joints[1:])
    return notes


def joint_loop(
    drive: Drive,
    clock: Clock,
    guard: Guard,
    period_s: float,
    current_servo: CurrentServo | None = None,
    torque_constant_n_m_a: float = nan,
) -> ControlLoop[Action, Reading]:
    """The loop of one joint; the arguments are those of `ControlledJoint` and `ControlLoop`."""
    joint = ControlledJoint(drive, guard, current_servo, torque_constant_n_m_a=torque_constant_n_m_a)
    return ControlLoop(SingleJoint(joint), clock, period_s)
