"""The port behind which a simulated device on a CAN bus is reached, by the name of an interface."""

from collections.abc import Callable
from dataclasses import dataclass

from sim_backend.devices.can.bus_port import BusPort
from sim_backend.devices.can.frame import CanDevice
from sim_backend.devices.can.stream_port import SlcanPort, SocketcandPort
from sim_backend.devices.link.line import Line
from sim_backend.devices.process import Port, RunningDevice, Workplace
from sim_backend.devices.served import Served
from sim_backend.errors import ParameterError


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
