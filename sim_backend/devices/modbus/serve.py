"""Starts a drive on Modbus RTU or TCP."""

from dataclasses import dataclass

from sim_backend.devices.link.line import Line
from sim_backend.devices.link.serial_relay import SerialRelay
from sim_backend.devices.link.tcp_relay import TcpRelay
from sim_backend.devices.modbus.own_drive import OwnDrive
from sim_backend.devices.modbus.roboteq import Roboteq
from sim_backend.devices.modbus.server import ModbusServer, RegisterDevice
from sim_backend.devices.process import RunningDevice, Workplace
from sim_backend.devices.served import Served
from sim_backend.errors import ParameterError

MAPS = ("friction-bench", "roboteq")


@dataclass(frozen=True, kw_only=True)
class ModbusSettings(Served):
    """A drive, its joint and its line.

    Attributes:
        map: one of `MAPS`.
        transport: "rtu" (a pseudo-terminal) or "tcp" (a port of the loopback interface).
        low_word_first: word order of our own map at the start.
        baud: pace of a serial line; None is as fast as the machine.
        port: TCP port; 0 is any free one.
    """

    map: str = "friction-bench"
    transport: str = "rtu"
    unit: int = 1
    low_word_first: bool = False
    baud: int | None = None
    port: int = 0


def serve_modbus(settings: ModbusSettings) -> RunningDevice:
    """Start one.

    Raises:
        ParameterError: the joint cannot be, or map or transport is not known.
        OSError: a port is taken.
    """
    if settings.map not in MAPS:
        raise ParameterError(f"register map '{settings.map}' is unknown; known are {', '.join(MAPS)}")
    if settings.transport not in ("rtu", "tcp"):
        raise ParameterError(f"transport '{settings.transport}' is unknown; known are rtu, tcp")
    parameters = settings.joint()
    device: OwnDrive | Roboteq
    if settings.map == "roboteq":
        device = Roboteq(parameters, seed=settings.seed)
    else:
        device = OwnDrive(parameters, settings.low_word_first, settings.seed)
    return settings.running(device, lambda place: _ServedPort(device, settings, place))


class _ServedPort:
    """A line to hosts, and the server behind it."""

    def __init__(self, device: RegisterDevice, settings: ModbusSettings, place: Workplace) -> None:
        line = Line(settings.baud if settings.transport == "rtu" else None, place.faults, settings.seed)
        self._relay: SerialRelay | TcpRelay
        if settings.transport == "rtu":
            self._relay = SerialRelay(line, place.clock, settings.link)
            self._server = ModbusServer(device, place.clock, settings.unit, self._relay.inner)
            self._server.begin()
        else:
            self._server = ModbusServer(device, place.clock, settings.unit)
            self._server.begin()
            self._relay = TcpRelay(line, place.clock, self._server.address, settings.port)

    @property
    def path(self) -> str:
        """What a host opens."""
        return self._relay.path

    @property
    def error(self) -> BaseException | None:
        """What ended the line or the server before its time."""
        return self._relay.error or self._server.error

    def start(self) -> None:
        """Begin."""
        self._relay.start()

    def close(self) -> None:
        """End."""
        self._relay.close()
        self._server.close()
