"""What is settled with a servo before anything moves: who it is, that it is off, its limits, and its bus watchdog.

The X models have a name, a step of the current, and a place where the indirect data begin. Numbers, items and the move
of the indirect data with firmware 52 are those of the tables that come with `dynamixel-sdk` 4.1; the steps of the
current are those of the e-Manual, and are not in these tables.
"""

from typing import NamedTuple

from drivers.dynamixel import control_table as table
from drivers.dynamixel.settings import DynamixelSettings
from drivers.errors import DriveConfigurationError, DriveError, DriveStateError, WatchdogError
from drivers.joint import JointScale
from drivers.polled_drive import Identity
from drivers.servos.bus import ServoBus
from drivers.servos.frames import Item
from drivers.servos.opening import check_counts

_INDIRECT_DATA, _INDIRECT_DATA_LATER = 224, 208
_LATER_FIRMWARE = 52  # of the 330 models
SIMULATED_FIRMWARE = 255  # of our own simulated device; ROBOTIS counts from 0, and was at some 50 in 2026


class Model(NamedTuple):
    """What differs from model to model.

    Attributes:
        current_a: step of Present Current and Goal Current [A]; None where it measures no current.
        indirect_moves: whether firmware 52 and later have the indirect data elsewhere.
    """

    name: str
    current_a: float | None
    indirect_moves: bool = False

    def indirect_data(self, firmware: int) -> int:
        """Address of the first byte of indirect data."""
        return _INDIRECT_DATA_LATER if self.indirect_moves and firmware >= _LATER_FIRMWARE else _INDIRECT_DATA


MODELS: dict[int, Model] = {
    1000: Model("XH430-W350", 2.69e-3),
    1001: Model("XD430-T350", 2.69e-3),
    1010: Model("XH430-W210", 2.69e-3),
    1011: Model("XD430-T210", 2.69e-3),
    1020: Model("XM430-W350", 2.69e-3),
    1030: Model("XM430-W210", 2.69e-3),
    1040: Model("XH430-V350", 1.34e-3),
    1050: Model("XH430-V210", 1.34e-3),
    1060: Model("XL430-W250", None),
    1070: Model("XC430-W150", None),
    1080: Model("XC430-W240", None),
    1090: Model("2XL430-W250", None),
    1100: Model("XH540-W270", 2.69e-3),
    1101: Model("XD540-T270", 2.69e-3),
    1110: Model("XH540-W150", 2.69e-3),
    1111: Model("XD540-T150", 2.69e-3),
    1120: Model("XM540-W270", 2.69e-3),
    1130: Model("XM540-W150", 2.69e-3),
    1140: Model("XH540-V270", 2.69e-3),
    1150: Model("XH540-V150", 2.69e-3),
    1160: Model("2XC430-W250", None),
    1170: Model("XW540-T260", 2.69e-3),
    1180: Model("XW540-T140", 2.69e-3),
    1190: Model("XL330-M077", 1e-3, indirect_moves=True),
    1200: Model("XL330-M288", 1e-3, indirect_moves=True),
    1210: Model("XC330-T181", 1e-3, indirect_moves=True),
    1220: Model("XC330-T288", 1e-3, indirect_moves=True),
    1230: Model("XC330-M181", 1e-3, indirect_moves=True),
    1240: Model("XC330-M288", 1e-3, indirect_moves=True),
    1270: Model("XW430-T333", 2.69e-3),
    1310: Model("XW540-H260", 2.69e-3),
}


def identify(bus: ServoBus, settings: DynamixelSettings, joint: JointScale) -> tuple[Model, int, Identity]:
    """Ask who answers.

    Raises:
        DriveConfigurationError: it is no X servo that is known, or the rig has another number of counts.
        DriveConnectionError: nobody does.
    """
    bus.begin()
    number = bus.read(settings.servo_id, table.MODEL_NUMBER)
    model = MODELS.get(number)
    if model is None:
        raise DriveConfigurationError(
            settings.device,
            f"its model number is {number}, which is none of the X series with a bus watchdog; check drive.servo_id",
        )
    check_counts(settings.device, model.name, table.COUNTS_PER_TURN, joint)
    firmware = bus.read(settings.servo_id, table.FIRMWARE)
    simulated = firmware == SIMULATED_FIRMWARE
    return model, firmware, Identity("ROBOTIS", model.name, str(firmware), "", simulated)


def switch_off(bus: ServoBus, settings: DynamixelSettings) -> None:
    """Power off, and have every packet answered from now on."""
    bus.begin()
    bus.write(settings.servo_id, table.STATUS_RETURN, table.ANSWERS_ALL)
    bus.write(settings.servo_id, table.TORQUE_ENABLE, 0)
    bus.write(settings.servo_id, table.RETURN_DELAY, 0)


def set_watchdog(bus: ServoBus, settings: DynamixelSettings) -> None:
    """Clear the bus watchdog, set it, and see that it is set.

    Raises:
        WatchdogError: it is not.
    """
    bus.begin()
    servo_id, steps = settings.servo_id, settings.watchdog_steps
    try:
        bus.write(servo_id, table.BUS_WATCHDOG, 0)  # a trip of the host before
        bus.write(servo_id, table.BUS_WATCHDOG, steps)
        found = bus.read(servo_id, table.BUS_WATCHDOG)
    except DriveError as error:
        raise WatchdogError(settings.device, f"its bus watchdog cannot be set: {error}") from error
    if found != steps:
        raise WatchdogError(
            settings.device,
            f"its bus watchdog reads back as {found * table.WATCHDOG_STEP_S:g} s, set was "
            f"{steps * table.WATCHDOG_STEP_S:g} s; it needs firmware 38 or later",
        )


def set_current_limit(bus: ServoBus, settings: DynamixelSettings, model: Model) -> None:
    """Set the highest motor current where one is wanted, and see that it is set.

    Raises:
        DriveConfigurationError: the model has none, or does not take it.
    """
    if settings.current_limit_a is None:
        return
    if model.current_a is None:
        raise DriveConfigurationError(
            settings.device, f"a {model.name} has no current limit; leave drive.current_limit_a out"
        )
    wanted = round(settings.current_limit_a / model.current_a)
    _set(bus, settings, table.CURRENT_LIMIT, wanted, f"{settings.current_limit_a:g} A")


def gather(bus: ServoBus, settings: DynamixelSettings) -> None:
    """Put what each exchange asks for into one piece of indirect data.

    Raises:
        DriveConfigurationError: the servo does not take an address.
    """
    for place, address in enumerate(table.GATHERED):
        bus.begin()
        item = Item(table.INDIRECT_ADDRESS + 2 * place, 2, f"Indirect Address {place + 1}")
        _set(bus, settings, item, address, str(address))


def _set(bus: ServoBus, settings: DynamixelSettings, item: Item, value: int, words: str) -> None:
    bus.begin()
    try:
        bus.write(settings.servo_id, item, value)
    except DriveStateError as error:
        raise DriveConfigurationError(settings.device, f"{words} is not taken: {error}") from error
    found = bus.read(settings.servo_id, item)
    if found != value:
        raise DriveConfigurationError(
            settings.device, f"its {item.name} reads back as {found}, set was {value} ({words}); choose another"
        )
