"""What is settled with a servo before anything moves: who it is, that it is off, its limits, and its bus watchdog."""

from drivers.dynamixel import control_table as table
from drivers.dynamixel.models import MODELS, Model
from drivers.dynamixel.settings import DynamixelSettings
from drivers.errors import DriveConfigurationError, DriveError, DriveStateError, WatchdogError
from drivers.joint import JointScale
from drivers.polled_drive import Identity
from drivers.servos.bus import ServoBus
from drivers.servos.frames import Item
from drivers.servos.opening import check_counts

SIMULATED_FIRMWARE = 255  # of our own simulated device; ROBOTIS counts from 0, and was at some 50 in 2026


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
