"""What has to be known of a CANopen drive before it is opened, but for its bus."""

from typing import Literal

from drivers.canopen.cia402.bits import TorqueOffSettings
from drivers.canopen.cia402.units import VelocityUnit
from drivers.settings import Settings, quantity

PositionMode = Literal["auto", "cyclic", "profile", "velocity"]


class CanopenParameters(Settings):
    """One CANopen drive, wherever it is."""

    node_id: int = quantity(..., "", "Node ID of the drive", ge=1, le=127)
    profile: Literal["auto", "cia402", "epos4"] = quantity(
        "auto", "", "Object profile; 'auto': by the vendor ID and by the objects that the drive has"
    )
    position_mode: PositionMode = quantity(
        "auto",
        "",
        "How a position is closed: 'cyclic' (CSP), 'profile' (PP), 'velocity' (by this host over CSV or PV); "
        "'auto': the first of these that the drive offers",
    )
    velocity_unit: VelocityUnit | None = quantity(
        None, "", "Unit of the drive's velocities; left out: what 0x60A9 or 0x6096 says"
    )
    units_from_configuration: bool = quantity(
        False, "", "Believe rig and settings where the drive's unit objects contradict them"
    )
    rated_current_a: float | None = quantity(
        None, "A", "Motor current of 1000 permille torque; left out: what the drive says", gt=0
    )
    current_limit_a: float | None = quantity(
        None, "A", "Highest motor current, set in the drive; left out: the drive's own", gt=0
    )
    position_min_rad: float | None = quantity(None, "rad", "Lowest joint angle that the drive itself keeps to (0x607D)")
    position_max_rad: float | None = quantity(
        None, "rad", "Highest joint angle that the drive itself keeps to (0x607D)"
    )
    profile_speed_rad_s: float | None = quantity(
        None, "rad/s", "Joint speed in profile position; left out: the drive's own", gt=0
    )
    profile_acceleration_rad_s2: float | None = quantity(
        None, "rad/s2", "Joint acceleration in profile position; left out: the drive's own", gt=0
    )
    duty_sign_from_current: bool = quantity(
        False, "", "The drive tells the duty without sign: take the current's; otherwise the duty is not measured"
    )
    watchdog_s: float = quantity(
        0.1, "s", "Time after the host's last sign of life at which the drive stops by itself", ge=0.01, le=10
    )
    watchdog_is_set_in_drive: bool = quantity(
        False, "", "The drive's own tool has set a watchdog; it is tried before the first motion"
    )
    answer_s: float = quantity(0.05, "s", "Longest silence of the drive; less than the watchdog", gt=0, le=5)
    sdo_answer_s: float = quantity(0.5, "s", "Longest wait for one answer to a read or write", ge=0.01, le=60)
    enable_s: float = quantity(
        3.0, "s", "Longest time from switching on to operation enabled: brake, finding the phase", ge=0.01, le=60
    )
    fault_reset_s: float = quantity(2.0, "s", "How long a fault reset is repeated", ge=0.01, le=60)
    mode_s: float = quantity(0.5, "s", "Longest time until the drive shows the mode", ge=0.01, le=60)
    poll_hz: float = quantity(4.0, "Hz", "How often supply and temperature are each asked for", gt=0, le=20)
    host_node_id: int | None = quantity(
        None, "", "Node ID under which the host's heartbeat is sent; left out: one that nobody uses", ge=1, le=127
    )
    listen_s: float = quantity(0.25, "s", "How long the bus is listened to for other hosts when opened", ge=0, le=10)
    torque_off: TorqueOffSettings | None = quantity(
        None,
        "",
        "Bit that tells that safe torque off is active; left out: only a drive that does not switch on shows it",
    )
    vendor_id: int | None = quantity(None, "", "What 0x1018:01 has to say; left out: anything", ge=0)
    product_code: int | None = quantity(None, "", "What 0x1018:02 has to say; left out: anything", ge=0)
    serial_number: int | None = quantity(None, "", "What 0x1018:04 has to say; left out: anything", ge=0)
