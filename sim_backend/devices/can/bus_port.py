"""The node on a python-can bus: virtual in one process, socketcan where the kernel has it."""

import threading
from contextlib import suppress
from typing import Any

import can

from sim_backend.devices.can.frame import CanDevice, Frame
from sim_backend.devices.wall_time import WallTime

_LOOK_UP_S = 0.05  # how soon the thread notices that it shall end


class BusPort(threading.Thread):
    """A thread that receives for a device, and its way to send.

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
        super().__init__(name="device CAN bus", daemon=True)
        self._device = device
        self._clock = clock
        self._bus = can.Bus(interface=interface, channel=channel, ignore_config=True, **(more or {}))
        self._closing = threading.Event()
        self.path = channel
        self.error: BaseException | None = None
        device.node.send = self._send

    def run(self) -> None:
        """Receive until `close`."""
        with self._device.lock:
            self._device.node.boot()
        try:
            while not self._closing.is_set():
                message = self._bus.recv(_LOOK_UP_S)
                if message is not None and not message.is_error_frame:
                    self._receive(message)
        except BaseException as error:
            self.error = error
            raise

    def close(self) -> None:
        """End the thread and leave the bus."""
        self._closing.set()
        if self.is_alive():
            self.join()
        with self._device.lock:
            self._device.node.send = lambda _frame: None
        self._bus.shutdown()

    def _receive(self, message: can.Message) -> None:
        frame = Frame(
            message.arbitration_id, bytes(message.data), message.is_remote_frame, message.is_extended_id, message.is_fd
        )
        self._clock.hear()
        with self._device.lock:
            now_s = self._clock.now_s()
            self._device.advance_to(now_s)
            self._device.receive(frame, now_s)

    def _send(self, frame: Frame) -> None:
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
