"""The limits that the drive itself keeps: motor current (0x6073, 0x6072 or the vendor's own), position (0x607D)."""

from math import ceil, floor, isnan

from drivers.canopen.capabilities import Capabilities
from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import HIGHEST_POSITION, LOWEST_POSITION, MAX_TORQUE, DriveObject
from drivers.canopen.settings import CanopenSettings
from drivers.contract import OwnLimit
from drivers.errors import DriveConfigurationError

_PURPOSE = "limit in the drive"


def set_limits(table: ObjectTable, settings: CanopenSettings, found: Capabilities) -> OwnLimit | None:
    """Set each limit that the settings name, and read it back; the drive's own limit of current where they name none.

    Raises:
        DriveConfigurationError: the drive has no such limit, refuses it, or keeps another one.
    """
    if settings.current_limit_a is not None:
        _set_current(table, settings, found, settings.current_limit_a)
    if settings.position_min_rad is not None and settings.position_max_rad is not None:
        _set_positions(table, found, settings.position_min_rad, settings.position_max_rad)
    return None if settings.current_limit_a is not None else _own_current(table, found)


def _own_current(table: ObjectTable, found: Capabilities) -> OwnLimit | None:
    """The lowest limit of current that somebody has set in the drive; None where it tells none."""
    told = {item: table.ask(item, _PURPOSE) for item in _limiting(found)}
    if none := " and ".join(str(item) for item, value in told.items() if value == 0):
        words = f"The drive may not move the motor, for its {none} is 0; set current_limit_a [A] in [drive]."
        return OwnLimit(0.0, words)
    limits_a = {item: value * found.scale.current_a(item) for item, value in told.items() if value}
    limits_a = {item: limit_a for item, limit_a in limits_a.items() if not isnan(limit_a)}
    if not limits_a:
        return None
    lowest = min(limits_a, key=limits_a.__getitem__)
    return OwnLimit(
        limits_a[lowest],
        f"The drive limits the motor current to {limits_a[lowest]:.3g} A ({lowest}); current_limit_a sets it.",
    )


def _limiting(found: Capabilities) -> list[DriveObject]:
    """The objects that limit the current, where a drive has them."""
    return list(dict.fromkeys((found.profile.current_limit, MAX_TORQUE)))


def _set_current(table: ObjectTable, settings: CanopenSettings, found: Capabilities, limit_a: float) -> None:
    """Set the highest current in every object that limits it; one that is lower already may stay."""
    candidates = _limiting(found)
    there = [item for item in candidates if table.has(item, _PURPOSE)]
    items = [item for item in there if found.scale.tells(item)]
    if not items:
        what = (
            f"has neither {' nor '.join(map(str, candidates))} as CiA 402 has them; leave it out, and set the limit in "
            "the drive's own tool"
        )
        if there:
            what = f"does not tell what {' and '.join(map(str, there))} count; set rated_current_a [A] to what 1000 are"
        raise DriveConfigurationError(settings.device, f"current_limit_a is {limit_a:g} A, and the drive {what}")
    for item in items:
        wanted = int(limit_a / found.scale.current_a(item))  # never above what was asked for
        before = table.ask(item, _PURPOSE)
        try:
            table.set(item, wanted, _PURPOSE)
        except DriveConfigurationError as error:
            if before is not None and 0 < before <= wanted:
                table.note(item, Need.REQUIRED, _PURPOSE, True, f"{before}, as it was: lower than {wanted} already")
                continue
            raise DriveConfigurationError(
                settings.device, f"current_limit_a is {limit_a:g} A: {error.message}; choose one that the drive takes"
            ) from error


def _set_positions(table: ObjectTable, found: Capabilities, low_rad: float, high_rad: float) -> None:
    joint = found.scale.joint
    ends = sorted(joint.encoder_sign * (rad + joint.zero_rad) / joint.count_rad for rad in (low_rad, high_rad))
    # within what was asked for
    table.set(LOWEST_POSITION, ceil(ends[0]), _PURPOSE)
    table.set(HIGHEST_POSITION, floor(ends[1]), _PURPOSE)
