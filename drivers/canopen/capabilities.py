"""What the drive can do and measure, found by asking it: absent is NaN, and is said."""

from dataclasses import dataclass
from math import isnan, nan

from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import RATED_TORQUE, TORQUE, TORQUE_OFFSET, VELOCITY, VELOCITY_OFFSET, DriveObject
from drivers.canopen.cia402.drive_units import UnitRow, read_units
from drivers.canopen.cia402.homing import why_not
from drivers.canopen.cia402.modes import ModeChoice
from drivers.canopen.cia402.profiles import ObjectProfile, choose_profile
from drivers.canopen.cia402.scale import DriveScale
from drivers.canopen.meeting import Identity
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Mode
from drivers.joint import JointScale

_MEASURED = "measured"
_RATED = "what 1000 permille of torque are in A"


@dataclass(frozen=True, slots=True)
class Capabilities:
    """What was found.

    Attributes:
        present: optional objects that it has.
        currents: the objects that tell the motor current, the best first; not each can be put into a PDO, and of one
            that is relative nobody may know to what.
        modes: the code of 0x6060 for each mode.
        units: by the drive and by the configuration.
        told_counts: encoder counts of a motor turn, by the drive; NaN where it tells none.
        no_homing: why it does not home by itself; "" where it does.
        lacks_rated_current: a torque mode is there, and only its unit keeps it from being used.
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
    lacks_rated_current: bool

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
    chosen = f"{profile.name}: {why}; profile in [drive] sets another"
    table.note("object profile", Need.REQUIRED, "identity", True, chosen)
    units = read_units(table, settings, joint.counts_per_turn)
    rated = _rated_current(table, settings, profile)
    scale = DriveScale(joint, rated.configuration, units.velocity_rad_s, units.acceleration_rad_s2)
    measured = (profile.current, profile.duty, profile.supply, profile.temperature, TORQUE, VELOCITY)
    asked = [*(item for item in measured if item is not None), TORQUE_OFFSET, VELOCITY_OFFSET]
    present = frozenset(item for item in asked if table.has(item, _MEASURED))
    there = (item for item in (profile.current, TORQUE) if item in present)
    currents = tuple(sorted(there, key=lambda item: not scale.tells(item)))
    choice = ModeChoice(table, settings, scale)
    modes = choice.choose()
    no_homing = why_not(table, scale, VELOCITY in present) if settings.homing else "no way of homing was configured"
    return Capabilities(
        identity, profile, present, currents, modes, scale, (*units.rows, rated), units.told_counts, no_homing,
        choice.lacks_rated_current,
    )  # fmt: skip


def _rated_current(table: ObjectTable, settings: CanopenSettings, profile: ObjectProfile) -> UnitRow:
    """Motor current of 1000 permille torque [A], by the drive and as it is used."""
    told_a, source = _rated_by_drive(table, settings, profile)
    used_a = told_a if settings.rated_current_a is None else settings.rated_current_a
    if isnan(used_a):
        table.note(_RATED, Need.WISHED, "current", False, "told by neither the drive nor rated_current_a [A]")
    told = "" if isnan(told_a) else f"{told_a:.6g} by {source}"
    return UnitRow("motor current of 1000 permille torque in A", told, used_a)


def _rated_by_drive(table: ObjectTable, settings: CanopenSettings, profile: ObjectProfile) -> tuple[float, str]:
    """As the drive's own objects have it [A], and which; NaN where they do not."""
    if profile.rated_current is not None and (counts := table.ask(profile.rated_current, _RATED)):
        return counts * profile.rated_current.scale, str(profile.rated_current)
    torque_object = profile.rated_torque or RATED_TORQUE
    torque_n_m = (table.ask(torque_object, _RATED) or 0) * torque_object.scale
    constant, source = settings.torque_constant_n_m_a, "motor.torque_constant_n_m_a of the rig"
    if profile.torque_constant is not None and (counts := table.ask(profile.torque_constant, _RATED)):
        constant, source = counts * profile.torque_constant.scale, str(profile.torque_constant)
    if torque_n_m and constant is not None:
        return torque_n_m / constant, f"{torque_object} / {source}"
    return nan, ""
