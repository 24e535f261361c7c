"""What is settled with a drive before anything moves: who it is, and that it watches over its host."""

from typing import NamedTuple

from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveStateError, WatchdogError
from drivers.modbus.blocks import blocks
from drivers.modbus.link import Link
from drivers.modbus.register_map import RegisterMap
from drivers.modbus.settings import ModbusSettings


class Found(NamedTuple):
    """What the drive says of itself."""

    product: str
    firmware: str
    serial: str
    simulated: bool


UNKNOWN = Found("", "", "", simulated=False)


def identify(link: Link, register_map: RegisterMap, device: str) -> Found:
    """Compare the drive with its map, and ask who it is.

    Raises:
        DriveConfigurationError: it is of another family.
        DriveConnectionError, DriveStateError: it does not answer, or refuses.
    """
    identity = register_map.identity
    if identity.family is not None:
        found, wanted = int(link.read_one(identity.family.register)), identity.family.words["is"]
        if found != wanted:
            raise DriveConfigurationError(
                device,
                f"{identity.family.register.name} is {found:#06x}; a {register_map.name} has {wanted:#06x}. Check "
                "drive.map, drive.unit and drive.port",
            )
    firmware = "" if identity.firmware is None else f"{link.read_one(identity.firmware):g}"
    serial = "" if identity.serial is None else f"{link.read_one(identity.serial):.0f}"
    product = identity.product if identity.product_text is None else link.read_text(identity.product_text)
    return Found(product, firmware, serial, "simulated" in product.lower())


def set_watchdog(link: Link, register_map: RegisterMap, settings: ModbusSettings) -> None:
    """Set the watchdog, and see that it is set.

    Raises:
        WatchdogError: it is not, or there is no register for it and nobody vouches for it.
    """
    register, wanted_s = register_map.watchdog.register, settings.watchdog_s
    if register is None:
        if not settings.watchdog_is_set_in_drive:
            raise WatchdogError(
                settings.device,
                f"the map of {register_map.name} has no register for its watchdog. Set it to "
                f"{register_map.watchdog.fixed_s:g} s with the drive's own tools, try it, and then set "
                "drive.watchdog_is_set_in_drive = true",
            )
        return
    [block] = blocks([register])
    try:
        link.write(block, register.encode(wanted_s))
        found_s = link.read_one(register)
    except (DriveConnectionError, DriveStateError, ValueError) as error:
        raise WatchdogError(settings.device, f"its watchdog cannot be set to {wanted_s:g} s: {error}") from error
    if abs(found_s - wanted_s) > 0.5 * register.scale + 1e-9:
        raise WatchdogError(
            settings.device,
            f"its watchdog reads back as {found_s:g} s, set was {wanted_s:g} s; choose a time that it takes",
        )
