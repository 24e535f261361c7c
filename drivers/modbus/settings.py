"""What has to be known of a drive on Modbus before it is opened."""

from typing import Literal

from drivers.settings import Settings, quantity

_SILENT_CHARACTERS = 3.5  # MODBUS over serial line V1.02, 2.5.1.1
_DATA_BITS = 8


class ModbusSettings(Settings):
    """How to reach one drive."""

    map: str = quantity(..., "", "Register map: a name that comes with the package, or a .toml file", min_length=1)
    transport: Literal["rtu", "tcp"] = quantity("rtu", "", "'rtu': serial line; 'tcp': network")
    port: str = quantity(..., "", "Serial port, such as /dev/ttyUSB0; or the TCP port", min_length=1)
    host: str = quantity("127.0.0.1", "", "Name or address of the drive; 'tcp' only")
    unit: int = quantity(1, "", "Address of the drive on the line", ge=0, le=247)  # on TCP as its gateway wants it
    baud_rate: int = quantity(115200, "", "Baud rate of the line", ge=1200, le=4_000_000)
    parity: Literal["N", "E", "O"] = quantity("N", "", "Parity of the line")
    stop_bits: Literal[1, 2] = quantity(1, "", "Stop bits of the line")
    watchdog_s: float = quantity(0.2, "s", "Silence after which the drive stops by itself", gt=0, le=2.0)
    watchdog_is_set_in_drive: bool = quantity(
        False, "", "True where the map has no watchdog register, and it was set and tried with the drive's own tools"
    )
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.005, le=1.0)
    slow_every: int = quantity(
        10,
        "cycles",
        "Cycles between requests for what changes slowly, where it takes requests of its own",
        ge=1,
        le=100,
    )
    silence_s: float | None = quantity(
        None,
        "s",
        "Rest of the line between an answer and the next request; left out: 3.5 characters",
        ge=0,
        le=0.1,
    )
    echo: bool = quantity(False, "", "True where the serial adapter hears what it sends itself (two-wire RS-485)")
    current_limit_a: float | None = quantity(
        None, "A", "Highest motor current, set in the drive by the map's [limits]; left out: the drive's own", gt=0
    )

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
