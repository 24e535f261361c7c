"""What the drive can do and measure, found by asking it: absent is NaN, and is said."""

from dataclasses import dataclass
from math import nan

from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import RATED_TORQUE, TORQUE, TORQUE_OFFSET, VELOCITY, VELOCITY_OFFSET, DriveObject
from drivers.canopen.cia402.drive_units import UnitRow, read_units
from drivers.canopen.cia402.homing import why_not
from drivers.canopen.cia402.modes import ModeChoice
from drivers.canopen.cia402.profiles import ObjectProfile, choose_profile
from drivers.canopen.cia402.scale import DriveScale
from drivers.canopen.meeting import Identity
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Mode, Untold
from drivers.joint import JointScale

_MEASURED = "measured"
_RATED = "what 1000 permille of torque are in A"


@dataclass(frozen=True, slots=True)
class Capabilities:
    """What was found.

    Attributes:
        present: optional objects that it has.
        currents: the objects that tell the motor current, the best first; not each can be put into a PDO.
        modes: the code of 0x6060 for each mode.
        units: by the drive and by the configuration.
        told_counts: encoder counts of a motor turn, by the drive; NaN where it tells none.
        no_homing: why it does not home by itself; "" where it does.
        untold: what is to be set for want of the rated current; None where that is known, or would not help.
    """

    identity: Identity
    profile: ObjectProfile
    present: frozenset[DriveObject]
    currents: tuple[DriveObject, ...]
    modes: dict[Mode, int]
    scale: DriveScale
    units: tuple[UnitRow, ...]
    told_counts: float
    no_homing: str
    untold: Untold | None

    @property
    def current(self) -> DriveObject | None:
        """The object that tells the motor current when it is asked; None where there is none."""
        return next(iter(self.currents), None)


def probe(table: ObjectTable, settings: CanopenSettings, joint: JointScale, identity: Identity) -> Capabilities:
    """Ask for every optional object.

    Raises:
        DriveConfigurationError: the drive's units contradict rig or settings.
    """
    profile, why = choose_profile(
        settings.device, settings.profile, identity.vendor_id, lambda item: table.has(item, _MEASURED)
    )
    table.note("object profile", Need.REQUIRED, "identity", True, f"{profile.name}: {why}; profile in [drive] sets another")
    units = read_units(table, settings, joint.counts_per_turn)
    rated_a = _rated_current_a(table, settings, profile)
    scale = DriveScale(joint, rated_a, units.velocity_rad_s, units.acceleration_rad_s2)
    measured = (profile.current, profile.duty, profile.supply, profile.temperature, TORQUE, VELOCITY)
    asked = [*(item for item in measured if item is not None), TORQUE_OFFSET, VELOCITY_OFFSET]
    present = frozenset(item for item in asked if table.has(item, _MEASURED))
    currents = tuple(item for item in (profile.current, TORQUE) if item in present and scale.tells(item))
    rows = (*units.rows, UnitRow("motor current of 1000 permille torque in A", _told(table, profile), rated_a))
    choice = ModeChoice(table, settings, scale)
    modes = choice.choose()
    tells = not currents and any(item in present for item in (profile.current, TORQUE))
    no_homing = why_not(table, scale, VELOCITY in present) if settings.homing else "no way of homing was configured"
    untold = _untold(tells, choice.lacks_rated_current)
    return Capabilities(identity, profile, present, currents, modes, scale, rows, units.told_counts, no_homing, untold)


def _untold(tells: bool, takes: bool) -> Untold | None:
    remedy = (
        "the drive does not tell its motor rated current; set rated_current_a in [drive] to it [A], by the drive's own "
        "tool or data sheet"
    )
    return Untold(remedy, tells, takes) if tells or takes else None


def _rated_current_a(table: ObjectTable, settings: CanopenSettings, profile: ObjectProfile) -> float:
    """Motor current of 1000 permille torque [A]; NaN where neither drive nor settings tell."""
    if settings.rated_current_a is not None:
        return settings.rated_current_a
    told_a = _rated_by_drive_a(table, profile)
    if told_a is not None:
        return told_a
    torque = table.ask(profile.rated_torque or RATED_TORQUE, _RATED)
    if torque and settings.torque_constant_n_m_a is not None:
        return torque * (profile.rated_torque or RATED_TORQUE).scale / settings.torque_constant_n_m_a
    table.note(_RATED, Need.WISHED, "current", False, "told by neither the drive nor rated_current_a [A]")
    return nan


def _rated_by_drive_a(table: ObjectTable, profile: ObjectProfile) -> float | None:
    """As the drive's own objects have it [A]; None where they do not."""
    objects = [
        item for item in (profile.rated_current, profile.rated_torque, profile.torque_constant) if item is not None
    ]
    values = [(table.ask(item, _RATED) or 0) * item.scale for item in objects]
    if not values or not all(values):
        return None
    return values[0] if profile.rated_current is not None else values[0] / values[1]


def _told(table: ObjectTable, profile: ObjectProfile) -> str:
    told_a = _rated_by_drive_a(table, profile)
    return "" if told_a is None else f"{told_a:.6g}"
