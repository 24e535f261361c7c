"""The port behind which a simulated device on a CAN bus is reached, by the name of an interface."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import can

from sim_backend.devices.can.frame import CanDevice, Frame
from sim_backend.devices.can.stream_port import CanDevicePort, SlcanPort, SocketcandPort
from sim_backend.devices.link.line import Line
from sim_backend.devices.process import Port, RunningDevice, Workplace
from sim_backend.devices.served import Served
from sim_backend.devices.wall_time import WallTime
from sim_backend.errors import ParameterError

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


def port_of(device: CanDevice, settings: Served, interface: str, channel: str) -> Callable[[Workplace], Port]:
    """Return what makes the port.

    Args:
        device: on the bus.
        settings: link for a pseudo-terminal, and seed of the line's faults.
        interface: "slcan" (a pseudo-terminal), "socketcand" (a TCP server here), "join" (another's), or one of
            python-can.
        channel: of such an interface; TCP port of the server; host:port of the server that is joined.

    Raises:
        ParameterError: the channel is none of the interface's.
    """

    def make(place: Workplace) -> Port:
        line = Line(None, place.faults, settings.seed)
        if interface == "slcan":
            return SlcanPort(device, place.clock, line, settings.link)
        if interface == "socketcand":
            return SocketcandPort(device, place.clock, line, int(channel))
        return BusPort(device, place.clock, *_bus(interface, channel))

    return make


@dataclass(frozen=True, kw_only=True)
class ServedOnBus(Served):
    """Its joint and its bus."""

    interface: str = "slcan"
    channel: str = "0"

    def on_bus(self, device: CanDevice) -> RunningDevice:
        """Return the device at work.

        Raises:
            ParameterError: the channel is none of the interface's.
            OSError: a port is taken.
        """
        return self.running(device, port_of(device, self, self.interface, self.channel))


def _bus(interface: str, channel: str) -> tuple[str, str, dict[str, str | int]]:
    """Interface, channel and whatever else python-can is told."""
    if interface == "udp_multicast":
        return interface, channel, {"hop_limit": 0}  # it does not leave this machine
    if interface != "join":
        return interface, channel, {}
    host, _, port = channel.rpartition(":")
    if not port.isdigit():
        raise ParameterError(f"channel '{channel}': host:port of another device's socketcand server is wanted")
    return "socketcand", "can0", {"host": host or "127.0.0.1", "port": int(port)}
