"""Controllers on a CAN-FD bus, without an adapter."""

from collections.abc import Sequence
from threading import RLock

from sim_backend.devices.can.frame import Frame, QuietNode
from sim_backend.devices.moteus.adapter import padded
from sim_backend.devices.moteus.controller import MoteusController


class MoteusOnBus:
    """The controllers of a bus. Loads, faults and truth are the first one's."""

    def __init__(self, controllers: Sequence[MoteusController]) -> None:
        self.axis = controllers[0].axis
        self.lock = RLock()
        self.node = QuietNode()
        self._controllers = controllers

    def advance_to(self, time_s: float) -> None:
        """Let time pass."""
        for one in self._controllers:
            one.axis.advance_to(time_s)

    def receive(self, frame: Frame, time_s: float) -> None:  # noqa: ARG002
        """Take a frame from the bus."""
        source, destination = frame.can_id >> 8 & 0x7F, frame.can_id & 0x7F
        for one in self._controllers:
            if frame.fd and one.servo_id == destination:
                answer = one.hear(frame.data, bool(frame.can_id & 0x8000))
                if answer:
                    self.node.send(Frame(one.servo_id << 8 | source, padded(answer), extended=True, fd=True))

    def report(self) -> dict[str, object]:
        """Say what the first controller is about."""
        return self._controllers[0].report()
