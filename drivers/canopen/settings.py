"""Settings of a CANopen drive, checked when they are made."""

from dataclasses import dataclass
from typing import Literal, get_args

import can

from drivers.can_bus.settings import BITRATES, BusSettings
from drivers.canopen.cia402.bits import BrakeBit, TorqueOffBit
from drivers.canopen.cia402.homing import DriveHoming
from drivers.canopen.cia402.profiles import PROFILES
from drivers.canopen.cia402.units import VELOCITY_UNITS
from drivers.errors import DriveConfigurationError

PositionMode = Literal["auto", "cyclic", "profile", "velocity"]


@dataclass(frozen=True, slots=True)
class CanopenSettings:
    """One CANopen drive.

    Attributes:
        bus: how the bus is reached.
        node_id: of the drive, 1 .. 127.
        profile: object profile, or "auto" to choose by vendor ID.
        position_mode: how Mode.POSITION is done: "cyclic" (CSP), "profile" (PP), "velocity" (this host closes the
            position over the drive's speed: CSV or PV), or "auto": the first of these that the drive offers.
        velocity_unit: one of `VELOCITY_UNITS`; None to read it.
        units_from_configuration: believe rig and settings where the drive's unit objects contradict them.
        rated_current_a: motor current of 1000 permille torque [A]; None to read it.
        torque_constant_n_m_a: of the motor [N m/A]: rated current, where the drive tells only its rated torque.
        current_limit_a: highest motor current, set in the drive [A]; None to leave the drive's own.
        position_min_rad, position_max_rad: joint angles that the drive itself keeps to [rad]; None to leave its own.
        profile_speed_rad_s, profile_acceleration_rad_s2: of the joint, in profile position; None to leave the drive's.
        duty_sign_from_current: the profile's duty has no sign: take the current's. Else the duty counts as not
            measured.
        watchdog_s: time after the host's last sign of life at which the drive stops by itself [s].
        watchdog_is_set_in_drive: the drive's own tool has set a watchdog; it is tried before the first motion.
        answer_s: longest silence of the drive in a row of cycles [s].
        sdo_answer_s: longest wait for one answer to a read or write of an object [s].
        enable_s: longest time from switching on to operation enabled [s]; brakes and finding the phase take some.
        fault_reset_s: how long a fault reset is repeated [s].
        mode_s: longest time until the drive shows the mode [s].
        poll_hz: how often supply and temperature are each asked for [Hz].
        host_node_id: node ID under which the host's heartbeat is sent; None for one that nobody on the bus uses.
        listen_s: how long the bus is listened to for other hosts before anything is sent [s].
        brake: the output that this host sets the holding brake by; None where it sets none.
        homing: how the drive homes by itself; None where it is not to.
        torque_off: the bit that tells that safe torque off is active; None where the drive has none.
        vendor_id, product_code, serial_number: what 0x1018 has to say; None for anything.
    """

    bus: BusSettings
    node_id: int
    profile: str = "auto"
    position_mode: PositionMode = "auto"
    velocity_unit: str | None = None
    units_from_configuration: bool = False
    rated_current_a: float | None = None
    torque_constant_n_m_a: float | None = None
    current_limit_a: float | None = None
    position_min_rad: float | None = None
    position_max_rad: float | None = None
    profile_speed_rad_s: float | None = None
    profile_acceleration_rad_s2: float | None = None
    duty_sign_from_current: bool = False
    watchdog_s: float = 0.1
    watchdog_is_set_in_drive: bool = False
    answer_s: float = 0.05
    sdo_answer_s: float = 0.5
    enable_s: float = 3.0
    fault_reset_s: float = 2.0
    mode_s: float = 0.5
    poll_hz: float = 4.0
    host_node_id: int | None = None
    listen_s: float = 0.25
    brake: BrakeBit | None = None
    homing: DriveHoming | None = None
    torque_off: TorqueOffBit | None = None
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
        bus, host_id = self.bus, self.host_node_id
        low, high = self.position_min_rad, self.position_max_rad
        positive = ("rated_current_a", "torque_constant_n_m_a", "current_limit_a", "profile_speed_rad_s",
                    "profile_acceleration_rad_s2")  # fmt: skip
        times = ("sdo_answer_s", "enable_s", "fault_reset_s", "mode_s")
        modes = get_args(PositionMode)
        return [
            ("interface", f"one of {', '.join(sorted(can.VALID_INTERFACES))}", bus.interface in can.VALID_INTERFACES),
            ("channel", "a name", bool(bus.channel)),
            ("bitrate", f"one of {', '.join(map(str, BITRATES))} [bit/s]", bus.bitrate in BITRATES),
            ("node_id", "1 .. 127", 1 <= self.node_id <= 127),
            (
                "host_node_id",
                "1 .. 127, not the drive's",
                host_id is None or (1 <= host_id <= 127 and host_id != self.node_id),
            ),
            ("profile", f"auto or {' or '.join(PROFILES)}", self.profile in ("auto", *PROFILES)),
            ("position_mode", " or ".join(modes), self.position_mode in modes),
            ("velocity_unit", f"one of {', '.join(VELOCITY_UNITS)}", self.velocity_unit in (None, *VELOCITY_UNITS)),
            *((name, "more than 0", _is_positive(getattr(self, name))) for name in positive),
            ("position_min_rad", "less than position_max_rad, and both or neither", _are_limits(low, high)),
            ("watchdog_s", "0.01 .. 10 s", 0.01 <= self.watchdog_s <= 10.0),
            ("answer_s", "more than 0 s and less than the watchdog", 0 < self.answer_s < self.watchdog_s),
            *((name, "0.01 .. 60 s", 0.01 <= getattr(self, name) <= 60.0) for name in times),
            ("listen_s", "0 .. 10 s", 0.0 <= self.listen_s <= 10.0),
            (
                "torque_off",
                "index 0x1000 .. 0xFFFF, subindex 0 .. 255, bit 0 .. 31, level 0 or 1",
                self.torque_off is None or self.torque_off.is_possible,
            ),
            ("poll_hz", "more than 0 and at most 20 Hz", 0 < self.poll_hz <= 20),
        ]

    @property
    def device(self) -> str:
        """Name in messages."""
        return f"{self.bus} node {self.node_id}"


def _is_positive(value: float | None) -> bool:
    return value is None or value > 0.0


def _are_limits(low: float | None, high: float | None) -> bool:
    return (low is None) == (high is None) and (low is None or high is None or low < high)
