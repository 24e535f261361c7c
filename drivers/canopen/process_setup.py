"""What travels in every cycle, by what the drive has: PDOs and the interpolation period."""

from drivers.canopen.capabilities import Capabilities
from drivers.canopen.cia301.object_access import ObjectAccess
from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import (
    INTERPOLATION_EXPONENT,
    INTERPOLATION_PERIOD,
    POSITION,
    STATUSWORD,
    SYNC_COB_ID,
    TARGET_POSITION,
    TARGET_TORQUE,
    TARGET_VELOCITY,
    TORQUE_OFFSET,
    VELOCITY,
    DriveObject,
)
from drivers.canopen.cia402.modes import TARGETS
from drivers.canopen.cia402.process_data import Arrangement, ProcessData
from drivers.canopen.cia402.units import interpolation_periods
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Mode, Untold
from drivers.errors import DriveConfigurationError

_SYNC = 0x80
_SYNC_MATTERS = 0x4000_07FF  # of 0x1005: the COB-ID, and whether the drive produces SYNC
_PURPOSE = "interpolation of positions"
_REMEDY = (
    "the drive does not tell its motor rated current; set rated_current_a in [drive] to it [A], by the drive's own "
    "tool or data sheet"
)


def set_interpolation(table: ObjectTable, period_s: float) -> None:
    """Tell the drive how often positions come, where it wants to know (0x60C2)."""
    if table.ask(INTERPOLATION_PERIOD, _PURPOSE) is None:
        return
    exponent = table.ask(INTERPOLATION_EXPONENT, _PURPOSE)
    for number, power in interpolation_periods(period_s, exponent):
        same = exponent is None or power == exponent or table.try_set(INTERPOLATION_EXPONENT, power, _PURPOSE)
        if same and table.try_set(INTERPOLATION_PERIOD, number, _PURPOSE):
            return
    if exponent is not None:
        table.try_set(INTERPOLATION_EXPONENT, exponent, _PURPOSE)  # as it was found


def set_up_pdos(
    table: ObjectTable, access: ObjectAccess, settings: CanopenSettings, found: Capabilities
) -> ProcessData:
    """Configure SYNC and the PDOs. A mode whose target finds no place is taken from those that were found.

    Raises:
        DriveConfigurationError: SYNC is elsewhere, or a PDO that is required has no room.
    """
    _require_sync(table)
    _require_position(table, settings)
    duty = found.profile.duty if settings.duty_sign_from_current else None
    motion = [POSITION, *(item for item in (VELOCITY,) if item in found.present)]
    # with every target: a drive adds the offset in other modes too, and keeps the last one it was given
    offsets = [TORQUE_OFFSET] if TORQUE_OFFSET in found.present else []
    targets = _targets(table, found)
    # a drive may tell its current when it is asked, and put into a PDO its torque alone
    for current in found.currents or (None,):
        state = [STATUSWORD, *(item for item in (current, duty) if item is not None and item in found.present)]
        data = Arrangement(access, settings.device, settings.node_id).arrange(targets, offsets, [state, motion])
        if current is None or current not in data.lost:
            break
        _note_lost(table, current, data)
    for pdo in (*data.demands.values(), *data.tpdos):
        table.note(pdo, Need.REQUIRED, "process data", True, ", ".join(map(str, pdo.layout.entries)))
    targets_of = {mode: TARGETS[code] for mode, code in found.modes.items()}
    if found.lacks_rated_current:
        targets_of[Mode.CURRENT] = TARGET_TORQUE
    for mode, target in targets_of.items():
        if target in data.lost:
            found.modes.pop(mode, None)
            why = f"no RPDO takes {target} with the controlword: {data.lost[target]}"
            table.note(f"mode '{mode.value}'", Need.WISHED, "mode", False, why)
    for item in (*state, *motion):
        if item in data.lost:
            _note_lost(table, item, data)
    return data


def untold(found: Capabilities, data: ProcessData) -> Untold | None:
    """What is to be set for want of the rated current; None where that is known, or would not help."""
    placed = [found.scale.tells(item) for item in found.currents if data.place(item) is not None]
    tells = bool(placed) and not any(placed)
    takes = found.lacks_rated_current and TARGET_TORQUE in data.demands
    return Untold(_REMEDY, tells, takes) if tells or takes else None


def _note_lost(table: ObjectTable, item: DriveObject, data: ProcessData) -> None:
    table.note(item, Need.WISHED, "process data", False, f"not measured, no TPDO takes it: {data.lost[item]}")


def _require_position(table: ObjectTable, settings: CanopenSettings) -> None:
    if table.ask(POSITION, "process data", Need.REQUIRED) is None:
        raise DriveConfigurationError(
            settings.device,
            f"has no {POSITION} that can be read ({table.outcome(POSITION, 'process data')}): nobody would know where "
            "the joint is; look in the drive's own tool for a firmware that has it",
        )


def _require_sync(table: ObjectTable) -> None:
    """SYNC at the COB-ID of CiA 301, and the drive does not produce it (bit 30). Many have it fixed."""
    found = table.ask(SYNC_COB_ID, "SYNC")
    if found is not None and found & _SYNC_MATTERS != _SYNC:
        table.set(SYNC_COB_ID, _SYNC, "SYNC")


def _targets(table: ObjectTable, found: Capabilities) -> list[DriveObject]:
    """One for each mode; where the drive offers none, whichever target it has: it can be looked at all the same.

    A torque whose unit is not known is tried, too: setting the unit is advised only where it would have a place.
    """
    used = [TARGETS[code] for code in found.modes.values()]
    if not used:
        have = (TARGET_POSITION, TARGET_VELOCITY, TARGET_TORQUE)
        used = [item for item in have if table.has(item, "process data")][:1]
    return list(dict.fromkeys([*used, *([TARGET_TORQUE] if found.lacks_rated_current else [])]))
