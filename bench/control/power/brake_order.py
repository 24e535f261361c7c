"""The order in which the holding brakes of a loop's joints are released and set, as cycles of that loop."""

from collections.abc import Callable, Sequence

from bench.control.ending import Outcome
from bench.control.joint import ControlledJoint
from bench.control.power.brake import LOOK_S, SINK_S, STAND_S, TRUST_S, Brake

Hold = Callable[[float, str], Outcome | None]
"""Runs cycles for a time [s] in which the braked joints hold, and records under a name that they do; how the run ends,
where it ends meanwhile."""


class BrakeOrder:
    """Releases the brakes of joints that have just been powered, and sets them at the end."""

    def __init__(self, joints: Sequence[ControlledJoint]) -> None:
        self.joints = [joint for joint in joints if joint.brake is not None]

    def release(self, hold: Hold) -> Outcome | None:
        """Hold, release, wait: of every joint that has power and a brake that is still set.

        Raises:
            LimitTrip: a joint moves with its brake set, or sinks once it is released.
            DriveError: a drive does not confirm it.
        """
        waiting = [(joint, joint.brake) for joint in self.joints if joint.is_powered and joint.brake is not None]
        waiting = [(joint, brake) for joint, brake in waiting if not brake.is_released]
        if not waiting:
            return None
        for joint, brake in waiting:
            brake.watch(joint.reading, joint.action, "with the brake set")
        if any(brake.is_set_by_bench for _, brake in waiting) and (ended := hold(LOOK_S, "set")):
            return ended
        for joint, brake in waiting:
            brake.release()
            brake.watch(joint.reading, brake.wanted, "after the brake was released")
        return hold(max(brake.settings.release_s for _, brake in waiting) + SINK_S, "released")

    def set(self, hold: Hold) -> Outcome | None:
        """Stand, set, wait, let go of the torque: of every joint whose brake is released.

        Raises:
            LimitTrip: a brake does not hold its joint.
            DriveError: a drive does not confirm it.
        """
        released = [(joint, joint.brake) for joint in self.joints if joint.brake is not None]
        released = [(joint, brake) for joint, brake in released if brake.is_released]
        own = [brake for _, brake in released if not brake.is_set_by_bench]
        ours = [(joint, brake) for joint, brake in released if brake.is_set_by_bench]
        ended = self._set_ours(ours, hold) if ours else None
        for brake in own if ended is None else ():
            brake.stand_down()
        return ended

    def _set_ours(self, ours: list[tuple[ControlledJoint, Brake]], hold: Hold) -> Outcome | None:
        for joint, brake in ours:
            brake.watch(joint.reading, joint.action, "")
        if ended := hold(STAND_S, "about to be set"):
            return ended
        for joint, brake in ours:
            brake.watch(joint.reading, brake.wanted, "while the brake was set")
            brake.set()
        if ended := hold(max(brake.settings.engage_s for _, brake in ours), "set"):
            return ended
        for joint, brake in ours:
            brake.watch(joint.reading, brake.wanted, "with the brake set and no torque (it does not hold the joint)")
            brake.let_go()
        return hold(TRUST_S, "holds")
