"""How a CAN bus of python-can is reached."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, get_args

from drivers.settings import Settings, quantity

_WITHOUT_BITRATE = ("socketcan", "virtual", "udp_multicast")  # the bus has it already, or has none
_NAMED_CHANNELS = ("virtual", "socketcan", "socketcand", "slcan")

Bitrate = Literal[10_000, 20_000, 50_000, 125_000, 250_000, 500_000, 1_000_000]
BITRATES: tuple[int, ...] = get_args(Bitrate)
"""Bit rates of CiA 301 that every interface here knows [bit/s]."""
Options = dict[str, str | int | float | bool]


@dataclass(frozen=True, slots=True)
class BusSettings:
    """How the CAN bus is reached.

    Attributes:
        interface: of python-can, by its name: "socketcan" (Linux network interface), "slcan" (serial adapter),
            "socketcand" (TCP server), "pcan", "kvaser", "gs_usb", "udp_multicast", "virtual" (inside one process) ...
        channel: as the interface has it: "can0"; "/dev/ttyACM0"; the server's name of the bus; "PCAN_USBBUS1"; "0".
        bitrate: of the bus [bit/s]. With socketcan and socketcand the interface has it already: it must be the same.
        host, port: of the socketcand server.
        tty_baudrate: of the serial line of an slcan adapter [bit/s].
        adapter_start_s: how long an slcan adapter needs after its port is opened [s].
        options: what else the interface takes, as python-can's documentation of it says.
    """

    interface: str
    channel: str
    bitrate: int = 1_000_000
    host: str = "localhost"
    port: int = 29536
    tty_baudrate: int = 115200
    adapter_start_s: float = 0.0
    options: Mapping[str, str | int | float | bool] = field(default_factory=dict)

    @property
    def sends_remote_frames(self) -> bool:
        """Whether remote requests reach the bus: python-can 4.6 sends them as data over socketcand."""
        return self.interface != "socketcand"

    @property
    def echoes(self) -> bool:
        """Whether the interface hands this host its own frames."""
        return self.interface == "udp_multicast"

    def listening(self) -> "BusSettings":
        """The same bus for who sends nothing: a serial adapter then acknowledges no frame either."""
        return replace(self, options={**self.options, "listen_only": True}) if self.interface == "slcan" else self

    @property
    def place(self) -> tuple[str | int, ...]:
        """What tells this bus from others."""
        server = (self.host, self.port) if self.interface == "socketcand" else ()
        return (self.interface, self.channel, *server)

    def __str__(self) -> str:
        return f"{self.channel}@{self.host}:{self.port}" if self.interface == "socketcand" else self.channel

    def arguments(self) -> dict[str, Any]:
        """Arguments of `can.Bus`, by name. Nothing comes from configuration files of python-can."""
        common: dict[str, Any] = {
            "interface": self.interface, "channel": self._channel(), "ignore_config": True, **self.options,
        }  # fmt: skip
        if self.interface == "slcan":
            return {
                **common, "bitrate": self.bitrate, "tty_baudrate": self.tty_baudrate,
                "sleep_after_open": self.adapter_start_s,
            }  # fmt: skip
        if self.interface == "socketcand":
            return {**common, "host": self.host, "port": self.port, "tcp_tune": True}
        return common if self.interface in _WITHOUT_BITRATE else {"bitrate": self.bitrate, **common}

    def _channel(self) -> str | int:
        """Kvaser and others number their channels."""
        return int(self.channel) if self.channel.isdigit() and self.interface not in _NAMED_CHANNELS else self.channel


class CanSettings(Settings):
    """How the bus of one drive is reached; the settings of a kind of drive derive from it."""

    interface: str = quantity(
        ..., "", "Interface of python-can: socketcan (Linux), slcan (serial adapter), pcan, kvaser ...", min_length=1
    )
    channel: str = quantity(..., "", "can0, /dev/ttyACM0, PCAN_USBBUS1", min_length=1)
    bitrate: Bitrate = quantity(1_000_000, "bit/s", "Bit rate of the bus")
    tty_baudrate: int = quantity(
        115200, "bit/s", "Baud rate of the serial line of an slcan adapter; ignored on USB", ge=9600
    )
    adapter_start_s: float = quantity(0.0, "s", "What an slcan adapter needs after its port is opened", ge=0, le=10)
    options: Options = quantity({}, "", "What else the interface takes, as python-can's documentation of it says")

    @property
    def bus(self) -> BusSettings:
        """The bus alone."""
        return BusSettings(**{name: getattr(self, name) for name in CanSettings.model_fields})
