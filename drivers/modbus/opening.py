"""What is settled with a drive before anything moves: who it is, its current limit, and that it minds its host."""

from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveStateError, WatchdogError
from drivers.modbus.blocks import blocks
from drivers.modbus.link import Link
from drivers.modbus.register import Register
from drivers.modbus.register_map import RegisterMap
from drivers.modbus.settings import ModbusSettings
from drivers.polled_drive import Identity


def identify(link: Link, register_map: RegisterMap, device: str) -> Identity:
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
    told = identity.product if identity.product_text is None else link.read_text(identity.product_text)
    return Identity(identity.vendor, told or identity.product, firmware, serial, "simulated" in told.lower())


def set_watchdog(link: Link, register_map: RegisterMap, settings: ModbusSettings) -> None:
    """Set the watchdog, and see that it is set.

    Raises:
        WatchdogError: it is not, or there is no register for it and nobody vouches for it.
    """
    register, wanted_s = register_map.watchdog.register, settings.watchdog_s
    for other, value in register_map.watchdog.needs:
        found = _set(link, other, value, settings, f"its watchdog needs {other.name} = {value:g}")
        if not _is_set(other, value, found):
            raise WatchdogError(
                settings.device, f"its watchdog needs {other.name} = {value:g}; it reads back as {found:g}"
            )
    if register is None:
        if not settings.watchdog_is_set_in_drive:
            raise WatchdogError(
                settings.device,
                f"the map of {register_map.name} has no register for its watchdog. Set it to "
                f"{register_map.watchdog.fixed_s:g} s with the drive's own tools, try it, and then set "
                "drive.watchdog_is_set_in_drive = true",
            )
        return
    found_s = _set(link, register, wanted_s, settings, f"its watchdog cannot be set to {wanted_s:g} s")
    if not _is_set(register, wanted_s, found_s):
        raise WatchdogError(
            settings.device,
            f"its watchdog reads back as {found_s:g} s, set was {wanted_s:g} s; choose a time that it takes",
        )


def set_current_limit(link: Link, register_map: RegisterMap, settings: ModbusSettings) -> None:
    """Set the highest motor current where one is wanted, and see that it is set.

    Raises:
        DriveConfigurationError: the map has no register for it, or the drive does not take the value.
    """
    register, wanted_a = register_map.current_limit, settings.current_limit_a
    if wanted_a is None:
        return
    if register is None:
        raise DriveConfigurationError(
            settings.device,
            f"the map of {register_map.name} has no register for a current limit ([limits] current_a). Set it with the "
            "drive's own tools, and leave drive.current_limit_a out",
        )
    [block] = blocks([register])
    try:
        link.write(block, register.encode(wanted_a))
        found_a = link.read_one(register)
    except (DriveStateError, ValueError) as error:
        raise DriveConfigurationError(
            settings.device, f"its current limit cannot be set to {wanted_a:g} A: {error}"
        ) from error
    if not _is_set(register, wanted_a, found_a):
        raise DriveConfigurationError(
            settings.device,
            f"its current limit reads back as {found_a:g} A, set was {wanted_a:g} A; choose one that it takes",
        )


def _set(link: Link, register: Register, value: float, settings: ModbusSettings, what: str) -> float:
    """Write a register of the watchdog, and read it back."""
    [block] = blocks([register])
    try:
        link.write(block, register.encode(value))
        return link.read_one(register)
    except (DriveConnectionError, DriveStateError, ValueError) as error:
        raise WatchdogError(settings.device, f"{what}: {error}") from error


def _is_set(register: Register, wanted: float, found: float) -> bool:
    """Whether a value reads back as written, to half a step."""
    return abs(found - wanted) <= 0.5 * abs(register.scale) + 1e-9
