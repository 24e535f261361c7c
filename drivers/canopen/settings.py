"""Settings of a CANopen drive, checked when they are made."""

from dataclasses import dataclass
from typing import Any, Literal

from drivers.canopen.cia402.profiles import PROFILES
from drivers.canopen.cia402.units import VELOCITY_UNITS
from drivers.errors import DriveConfigurationError

Interface = Literal["socketcan", "slcan", "socketcand", "virtual"]

BITRATES = (10_000, 20_000, 50_000, 125_000, 250_000, 500_000, 1_000_000)
"""Bit rates of CiA 301 that every interface here knows [bit/s]."""


@dataclass(frozen=True, slots=True)
class BusSettings:
    """How the CAN bus is reached.

    Attributes:
        interface: "socketcan" (Linux network interface), "slcan" (serial adapter), "socketcand" (TCP server),
            "virtual" (inside one process).
        channel: "can0"; "/dev/ttyACM0"; the server's name of the bus; any name.
        bitrate: of the bus [bit/s]. With socketcan and socketcand the interface has it already: it must be the same.
        host, port: of the socketcand server.
        tty_baudrate: of the serial line of an slcan adapter [bit/s].
        adapter_start_s: how long an slcan adapter needs after its port is opened [s].
    """

    interface: Interface
    channel: str
    bitrate: int = 1_000_000
    host: str = "localhost"
    port: int = 29536
    tty_baudrate: int = 115200
    adapter_start_s: float = 0.0

    def __str__(self) -> str:
        return f"{self.channel}@{self.host}:{self.port}" if self.interface == "socketcand" else self.channel

    def arguments(self) -> dict[str, Any]:
        """Arguments of `can.Bus`, by name. Nothing comes from configuration files of python-can."""
        common: dict[str, Any] = {"interface": self.interface, "channel": self.channel, "ignore_config": True}
        if self.interface == "slcan":
            return {
                **common, "bitrate": self.bitrate, "tty_baudrate": self.tty_baudrate,
                "sleep_after_open": self.adapter_start_s,
            }  # fmt: skip
        if self.interface == "socketcand":
            return {**common, "host": self.host, "port": self.port, "tcp_tune": True}
        return common


@dataclass(frozen=True, slots=True)
class CanopenSettings:
    """One CANopen drive.

    Attributes:
        bus: how the bus is reached.
        node_id: of the drive, 1 .. 127.
        profile: object profile, or "auto" to choose by vendor ID.
        position_mode: how Mode.POSITION is done: "cyclic" (CSP) or "profile" (PP).
        velocity_unit: one of `VELOCITY_UNITS`; None to read 0x60A9.
        rated_current_a: motor current of 1000 permille torque [A]; None to read it.
        current_limit_a: highest motor current, set in the drive [A]; None to leave the drive's own.
        duty_sign_from_current: the profile's duty has no sign: take the current's. Else the duty counts as not
            measured.
        watchdog_s: time after the host's last heartbeat at which the drive stops by itself [s].
        answer_s: longest silence of the drive in a row of cycles [s].
        poll_hz: how often supply and temperature are each asked for [Hz].
        host_node_id: node ID under which the host's heartbeat is sent.
        vendor_id, product_code, serial_number: what 0x1018 has to say; None for anything.
    """

    bus: BusSettings
    node_id: int
    profile: str = "auto"
    position_mode: Literal["cyclic", "profile"] = "cyclic"
    velocity_unit: str | None = None
    rated_current_a: float | None = None
    current_limit_a: float | None = None
    duty_sign_from_current: bool = False
    watchdog_s: float = 0.1
    answer_s: float = 0.05
    poll_hz: float = 4.0
    host_node_id: int = 127
    vendor_id: int | None = None
    product_code: int | None = None
    serial_number: int | None = None

    def __post_init__(self) -> None:
        """Refuse values that cannot be meant.

        Raises:
            DriveConfigurationError: the setting, its value, what is allowed.
        """
        for name, allowed, ok in self._checks():
            if not ok:
                value = self.bus.interface if name == "interface" else getattr(self, name, None)
                value = getattr(self.bus, name) if value is None and hasattr(self.bus, name) else value
                raise DriveConfigurationError(
                    self.device, f"setting {name} = {value!r}: {allowed} is wanted; correct it in the configuration"
                )

    def _checks(self) -> list[tuple[str, str, bool]]:
        bus = self.bus
        return [
            ("interface", "socketcan, slcan, socketcand or virtual", bus.interface in Interface.__args__),  # type: ignore[attr-defined]
            ("channel", "a name", bool(bus.channel)),
            ("bitrate", f"one of {', '.join(map(str, BITRATES))} [bit/s]", bus.bitrate in BITRATES),
            ("node_id", "1 .. 127", 1 <= self.node_id <= 127),
            (
                "host_node_id",
                "1 .. 127, not the drive's",
                1 <= self.host_node_id <= 127 and self.host_node_id != self.node_id,
            ),
            ("profile", f"auto or {' or '.join(PROFILES)}", self.profile in ("auto", *PROFILES)),
            ("position_mode", "cyclic or profile", self.position_mode in ("cyclic", "profile")),
            ("velocity_unit", f"one of {', '.join(VELOCITY_UNITS)}", self.velocity_unit in (None, *VELOCITY_UNITS)),
            ("rated_current_a", "more than 0 A", self.rated_current_a is None or self.rated_current_a > 0),
            ("current_limit_a", "more than 0 A", self.current_limit_a is None or self.current_limit_a > 0),
            ("watchdog_s", "0.01 .. 10 s", 0.01 <= self.watchdog_s <= 10.0),
            ("answer_s", "more than 0 s and less than the watchdog", 0 < self.answer_s < self.watchdog_s),
            ("poll_hz", "more than 0 and at most 20 Hz", 0 < self.poll_hz <= 20),
        ]

    @property
    def device(self) -> str:
        """Name in messages."""
        return f"{self.bus} node {self.node_id}"
