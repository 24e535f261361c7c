"""The kinds of actuator, and what each says: what one suite asks of all of them."""

from collections.abc import Callable
from typing import Any, NamedTuple

from drivers.can_bus.settings import BusSettings
from drivers.cubemars.drive import CubemarsDrive
from drivers.cubemars.settings import CubemarsSettings
from drivers.damiao.drive import DamiaoDrive
from drivers.damiao.settings import DamiaoSettings
from drivers.joint import JointScale
from drivers.moteus.drive import MoteusDrive
from drivers.moteus.settings import MoteusSettings
from drivers.odrive.drive import OdriveDrive
from drivers.odrive.settings import OdriveSettings
from drivers.robstride.drive import RobstrideDrive
from drivers.robstride.settings import RobstrideSettings

JOINT = JointScale(counts_per_turn=4096, gear_ratio=20.0)
PERIOD_S = 0.01
RANGES = (100.0, 200.0, 0.5)
WRITTEN = dict(zip(("position_range_rad", "speed_range_rad_s", "torque_range_n_m"), RANGES, strict=True))


class Kind(NamedTuple):
    """What differs from kind to kind.

    Attributes:
        name: of the kind.
        drive, settings: classes of the driver.
        values: settings that fit a busy test machine.
        measured: what its samples tell.
        faults: what it says of each fault of the simulated device.
        firmware: that it says it has.
        damps: whether its quick stop is a torque against the motion.
        options: of its simulated device.
    """

    name: str
    drive: Callable[..., Any]
    settings: Callable[..., Any]
    values: dict[str, Any]
    measured: frozenset[str]
    faults: dict[str, str]
    firmware: str = ""
    damps: bool = True
    options: tuple[str, ...] = ()

    def on(self, place: Any, **settings: Any) -> Any:
        """A driver at a bus or a port."""
        where = {"port": place} if isinstance(place, str) else {"interface": place.interface, "channel": place.channel}
        return self.drive(self.settings(**{"answer_timeout_s": 0.2, **where, **self.values, **settings}), JOINT)

    def drive_of(self, device: Any, **settings: Any) -> Any:
        """The driver of a device that runs in a process of its own."""
        table = device.drive
        return self.on(device.port if "port" in table else BusSettings("slcan", table["channel"]), **settings)


DAMIAO = Kind(
    "damiao", DamiaoDrive, DamiaoSettings, {"watchdog_s": 1.0}, frozenset({"torque_n_m", "temperature_c"}),
    {
        "supply-lost": "under-voltage", "over-temperature": "motor over-temperature", "over-current": "over-current",
        "drive-failed": "overload",
    },
    firmware="4294967295",
)  # fmt: skip
CUBEMARS = Kind(
    "cubemars", CubemarsDrive, CubemarsSettings, {"accept_no_watchdog": True, **WRITTEN},
    frozenset({"torque_n_m", "temperature_c"}),
    {"supply-lost": "under-voltage", "over-temperature": "over-temperature", "over-current": "over-current"},
)  # fmt: skip
ROBSTRIDE = Kind(
    "robstride", RobstrideDrive, RobstrideSettings, {"watchdog_s": 1.0, **WRITTEN},
    frozenset({"torque_n_m", "supply_v", "temperature_c"}),
    {
        "supply-lost": "under-voltage", "over-temperature": "over-temperature", "over-current": "over-current",
        "drive-failed": "overload",
    },
    firmware="0.4.2.6",
)  # fmt: skip
MOTEUS = Kind(
    "moteus", MoteusDrive, MoteusSettings, {"watchdog_s": 1.0},
    frozenset({"torque_n_m", "current_a", "supply_v", "temperature_c"}),
    {"supply-lost": "under-voltage", "over-temperature": "over-temperature", "over-current": "motor driver fault"},
    firmware="1.11.0", damps=False, options=("--joints", "2"),
)  # fmt: skip
ODRIVE = Kind(
    "odrive", OdriveDrive, OdriveSettings, {"watchdog_s": 1.0, "watchdog_is_set_in_drive": True},
    frozenset({"current_a", "supply_v", "temperature_c"}),
    {
        "supply-lost": "DC bus under-voltage", "over-temperature": "motor over-temperature",
        "over-current": "current limit violation", "drive-failed": "driver fault",
        "torque-disabled": "e-stop requested",
    },
    firmware="0.6.11", damps=False, options=("--watchdog", "1.0"),
)  # fmt: skip
MIT = (DAMIAO, CUBEMARS, ROBSTRIDE)
KINDS = (*MIT, MOTEUS, ODRIVE)
