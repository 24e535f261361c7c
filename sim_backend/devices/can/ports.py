"""The port behind which a simulated device on a CAN bus is reached, by the name of an interface."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from sim_backend.devices.can.bus_port import BusPort
from sim_backend.devices.can.frame import CanDevice
from sim_backend.devices.can.stream_port import SlcanPort, SocketcandPort
from sim_backend.devices.link.line import Line
from sim_backend.devices.process import Port, RunningDevice, Workplace
from sim_backend.devices.served import Served
from sim_backend.errors import ParameterError


class BusChoice(Protocol):
    """What the settings of a device on a CAN bus say of its bus."""

    @property
    def interface(self) -> str:
        """ "slcan" (a pseudo-terminal), "socketcand" (a TCP server here), "join" (another's), or one of python-can."""

    @property
    def channel(self) -> str:
        """Of such an interface; TCP port of the server; host:port of the server that is joined."""

    @property
    def link(self) -> Path | None:
        """Symbolic link to put on the pseudo-terminal."""

    @property
    def seed(self) -> int:
        """Of the line's faults."""


def port_of(device: CanDevice, settings: BusChoice) -> Callable[[Workplace], Port]:
    """Return what makes the port.

    Raises:
        ParameterError: the channel is none of the interface's.
    """

    def make(place: Workplace) -> Port:
        line = Line(None, place.faults, settings.seed)
        if settings.interface == "slcan":
            return SlcanPort(device, place.clock, line, settings.link)
        if settings.interface == "socketcand":
            return SocketcandPort(device, place.clock, line, int(settings.channel))
        return BusPort(device, place.clock, *_bus(settings))

    return make


@dataclass(frozen=True, kw_only=True)
class ServedOnBus(Served):
    """Its joint and its bus.

    Attributes:
        interface, channel: as `BusChoice` has them.
    """

    interface: str = "slcan"
    channel: str = "0"

    def on_bus(self, device: CanDevice) -> RunningDevice:
        """Return the device at work.

        Raises:
            ParameterError: the channel is none of the interface's.
            OSError: a port is taken.
        """
        return self.running(device, port_of(device, self))


def _bus(settings: BusChoice) -> tuple[str, str, dict[str, str | int]]:
    """Interface, channel and whatever else python-can is told."""
    if settings.interface == "udp_multicast":
        return settings.interface, settings.channel, {"hop_limit": 0}  # it does not leave this machine
    if settings.interface != "join":
        return settings.interface, settings.channel, {}
    host, _, port = settings.channel.rpartition(":")
    if not port.isdigit():
        raise ParameterError(f"channel '{settings.channel}': host:port of another device's socketcand server is wanted")
    return "socketcand", "can0", {"host": host or "127.0.0.1", "port": int(port)}
