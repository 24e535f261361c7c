"""The node on a python-can bus: virtual in one process, socketcan where the kernel has it."""

from contextlib import suppress
from typing import Any

import can

from sim_backend.devices.can.frame import CanDevice, Frame
from sim_backend.devices.can.stream_port import CanDevicePort
from sim_backend.devices.link.line import Line
from sim_backend.devices.wall_time import WallTime

_LOOK_UP_S = 0.05  # how soon the thread notices that it shall end


class BusPort(CanDevicePort):
    """A thread that receives for a device, and its way to send. No fault of a line strikes it.

    Args:
        device: what is on the bus.
        clock: of the device.
        interface: of python-can: "virtual", "socketcan" ...
        channel: of that interface.
        more: what the interface takes beside it.
    """

    def __init__(
        self,
        device: CanDevice,
        clock: WallTime,
        interface: str,
        channel: str,
        more: dict[str, Any] | None = None,
    ) -> None:
        self._bus = can.Bus(interface=interface, channel=channel, ignore_config=True, **(more or {}))
        super().__init__(device, clock, Line(), "device CAN bus")
        self.path = channel

    def close(self) -> None:
        """End the thread and leave the bus."""
        super().close()
        with self._device.lock:
            self._device.node.send = lambda _frame: None
        self._bus.shutdown()

    def _serve(self) -> None:
        message = self._bus.recv(_LOOK_UP_S)
        if message is not None and not message.is_error_frame:
            self._receive(message)

    def _receive(self, message: can.Message) -> None:
        self._clock.hear()
        frame = Frame(
            message.arbitration_id, bytes(message.data), message.is_remote_frame, message.is_extended_id, message.is_fd
        )
        self._deliver(frame)

    def _unplug(self) -> None:
        """The bus stays."""

    def _tell(self, frame: Frame) -> None:
        message = can.Message(
            arbitration_id=frame.can_id,
            data=frame.data,
            is_remote_frame=frame.remote,
            is_extended_id=frame.extended,
            is_fd=frame.fd,
            bitrate_switch=frame.fd,
        )
        with suppress(can.CanOperationError):  # its transmit buffer is full: as on any controller, the frame is lost
            self._bus.send(message)
