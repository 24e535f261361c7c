"""What has to be known of a drive on Modbus before it is opened."""

from dataclasses import dataclass
from typing import Literal

_SILENT_CHARACTERS = 3.5  # MODBUS over serial line V1.02, 2.5.1.1
_DATA_BITS = 8


@dataclass(frozen=True, slots=True)
class ModbusSettings:
    """How to reach one drive.

    Attributes:
        map: name of a register map that comes with the package, or the path of a .toml file.
        transport: "rtu" on a serial line, "tcp" on a network.
        port: serial port, or TCP port of the host.
        host: name or address; "tcp" only.
        unit: address of the drive on the line, 1 .. 247; on TCP as the drive or its gateway wants it.
        baud_rate, parity, stop_bits: of the serial line.
        watchdog_s: silence after which the drive stops by itself [s].
        watchdog_is_set_in_drive: True where the map has no register for it, and somebody has set it with the drive's
            own tools; it cannot be verified then.
        answer_timeout_s: longest wait for one answer [s].
        slow_every: cycles between two requests for what changes slowly, where it takes requests of its own.
        silence_s: rest of the line between an answer and the next request [s]; None: 3.5 characters ("rtu" only).
        echo: True where the serial adapter hears what it sends.
        current_limit_a: highest motor current [A], set in the drive; None: the drive's own.
    """

    map: str
    transport: Literal["rtu", "tcp"]
    port: str
    host: str = "127.0.0.1"
    unit: int = 1
    baud_rate: int = 115200
    parity: Literal["N", "E", "O"] = "N"
    stop_bits: Literal[1, 2] = 1
    watchdog_s: float = 0.2
    watchdog_is_set_in_drive: bool = False
    answer_timeout_s: float = 0.05
    slow_every: int = 10
    silence_s: float | None = None
    echo: bool = False
    current_limit_a: float | None = None

    @property
    def device(self) -> str:
        """The name used in messages."""
        place = self.port if self.transport == "rtu" else f"{self.host}:{self.port}"
        return f"{place} unit {self.unit}"

    @property
    def line_silence_s(self) -> float:
        """Rest of the line between an answer and the next request [s]."""
        if self.transport == "tcp":
            return 0.0
        if self.silence_s is not None:
            return self.silence_s
        bits = 1 + _DATA_BITS + (self.parity != "N") + self.stop_bits
        return _SILENT_CHARACTERS * bits / self.baud_rate
