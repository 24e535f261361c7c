"""What a person beside the bench can do to a simulated device: look, hang a load, break things."""

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from sim_backend.devices.axis import Device
from sim_backend.devices.joint_tables import fault_by_name
from sim_backend.devices.link.faults import LinkFaults, link_fault
from sim_backend.devices.wall_time import WallTime
from sim_backend.errors import ParameterError

Answer = dict[str, Any]


class Hand:
    """Deeds by name, as the side channel asks for them. Each takes the values of its request and returns its answer.

    Args:
        device: what it reaches into.
        clock: of the device.
        links: the lines to the device; they break together.
    """

    def __init__(self, device: Device, clock: WallTime, links: LinkFaults) -> None:
        self._device = device
        self._clock = clock
        self._links = links
        self._deeds: dict[str, Callable[..., Answer]] = {
            "truth": self.truth,
            "hang": self.hang,
            "hold": self.hold,
            "release": self.release,
            "fault": self.fault,
            "link": self.link,
            "repair": self.repair,
        }

    def do(self, deed: str, values: Answer) -> Answer:
        """Do a deed.

        Raises:
            ParameterError: it is not known, or its values are not.
        """
        if deed not in self._deeds:
            raise ParameterError(f"deed '{deed}' is unknown; known are {', '.join(self._deeds)}")
        with self._device.lock:
            self._device.advance_to(self._clock.now_s())
            try:
                return self._deeds[deed](**values)
            except TypeError as error:
                raise ParameterError(f"deed '{deed}': {error}") from error

    def truth(self) -> Answer:
        """Say how things really are. Names ending in `monotonic_s` are of `time.monotonic()`."""
        axis, origin_s = self._device.axis, self._clock.origin_s
        return {
            "now_monotonic_s": origin_s + axis.time_s,
            "powered": axis.power.on,
            "powered_since_monotonic_s": origin_s + axis.power.since_s,
            "stage": axis.stage_name,
            "demand": axis.applied.value,
            "device": self._device.report(),
            "joint": asdict(axis.plant.truth()),
        }

    def hang(self, load_kg: float, balanced: bool = False) -> Answer:
        """Hang a load."""
        self._device.axis.hang_load(load_kg, balanced)
        return {}

    def hold(self, angle_rad: float) -> Answer:
        """Turn the arm to an angle, and hold it there."""
        self._device.axis.hold_arm(angle_rad)
        return {}

    def release(self) -> Answer:
        """Let go of the arm."""
        self._device.axis.release_arm()
        return {}

    def fault(self, name: str, delay_s: float = 0.0, **values: Any) -> Answer:
        """Let something of drive or joint go wrong after a time."""
        self._device.axis.meet(fault_by_name(name, self._device.axis.time_s + delay_s, **values))
        return {}

    def link(self, name: str, delay_s: float = 0.0, **values: Any) -> Answer:
        """Let something of the line go wrong after a time."""
        self._links.add([link_fault(name, self._clock.now_s() + delay_s, **values)])
        return {}

    def repair(self) -> Answer:
        """Put right what is wrong with drive, joint and line."""
        self._device.axis.script.lift(self._device.axis.time_s)
        self._links.lift()
        return {}
