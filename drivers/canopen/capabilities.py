"""What the drive can do and measure, found by asking it: absent is NaN, and is said."""

from dataclasses import dataclass
from math import nan

from drivers.canopen.cia301.object_access import ObjectAccess
from drivers.canopen.cia301.objects import (
    ENCODER_INCREMENTS,
    ENCODER_REVOLUTIONS,
    SUPPORTED_MODES,
    TORQUE,
    TORQUE_OFFSET,
    VELOCITY,
    VELOCITY_UNIT,
    DriveObject,
)
from drivers.canopen.cia402.profiles import ObjectProfile, choose_profile
from drivers.canopen.cia402.scale import DriveScale
from drivers.canopen.cia402.units import velocity_unit_code, velocity_unit_name, velocity_unit_rad_s
from drivers.canopen.identity import Identity
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale

CYCLIC_TORQUE, CYCLIC_POSITION, PROFILE_POSITION = 10, 8, 1  # 0x6060
_BITS = {PROFILE_POSITION: 0, CYCLIC_POSITION: 7, CYCLIC_TORQUE: 9}  # 0x6502


@dataclass(frozen=True, slots=True)
class Capabilities:
    """What was found.

    Attributes:
        identity: of the drive.
        profile: chosen for it.
        present: optional objects that it has.
        current: the object that tells the motor current; None where there is none.
        modes: the code of 0x6060 for each mode.
        scale: of drive and joint.
    """

    identity: Identity
    profile: ObjectProfile
    present: frozenset[DriveObject]
    current: DriveObject | None
    modes: dict[Mode, int]
    scale: DriveScale


def probe(access: ObjectAccess, settings: CanopenSettings, joint: JointScale, identity: Identity) -> Capabilities:
    """Ask for every optional object.

    Raises:
        DriveConfigurationError: units or rated current contradict the settings, or are told by neither.
    """
    profile = choose_profile(settings.device, settings.profile, identity.vendor_id)
    asked = (profile.current, profile.duty, profile.supply, profile.temperature, TORQUE, TORQUE_OFFSET, VELOCITY)
    present = frozenset(item for item in asked if item is not None and access.read_if_present(item) is not None)
    current = next((item for item in (profile.current, TORQUE) if item in present), None)
    rated_current_a = _rated_current_a(access, settings, profile)
    scale = DriveScale(joint, rated_current_a, _velocity_unit(access, settings, joint))
    _check_encoder(access, settings, joint)
    return Capabilities(identity, profile, present, current, _modes(access, settings), scale)


def _modes(access: ObjectAccess, settings: CanopenSettings) -> dict[Mode, int]:
    position = CYCLIC_POSITION if settings.position_mode == "cyclic" else PROFILE_POSITION
    supported = access.read_if_present(SUPPORTED_MODES)
    wanted = {Mode.CURRENT: CYCLIC_TORQUE, Mode.POSITION: position}
    # a drive that does not list its modes is asked when one is switched to
    return {mode: code for mode, code in wanted.items() if supported is None or supported >> _BITS[code] & 1}


def _rated_current_a(access: ObjectAccess, settings: CanopenSettings, profile: ObjectProfile) -> float:
    """Motor current of 1000 permille torque [A]."""
    if settings.rated_current_a is not None:
        return settings.rated_current_a
    objects = tuple(
        item for item in (profile.rated_current, profile.rated_torque, profile.torque_constant) if item is not None
    )
    values = [(access.read_if_present(item) or 0) * item.scale for item in objects]
    if not all(values):
        names = " and ".join(map(str, objects))
        raise DriveConfigurationError(
            settings.device,
            f"the drive does not tell its rated current: {names} is absent or 0. Set rated_current_a [A]",
        )
    return values[0] if profile.rated_current is not None else values[0] / values[1]


def _velocity_unit(access: ObjectAccess, settings: CanopenSettings, joint: JointScale) -> float:
    """One count of velocity at the motor [rad/s]; NaN where neither drive nor settings tell."""
    code = access.read_if_present(VELOCITY_UNIT)
    if settings.velocity_unit is not None:
        wanted = velocity_unit_code(settings.velocity_unit)
        if code not in (None, 0, wanted):
            raise DriveConfigurationError(
                settings.device,
                f"{VELOCITY_UNIT} is {velocity_unit_name(code or 0)}; the settings say {settings.velocity_unit}. "
                "Correct velocity_unit, or leave it out to use the drive's",
            )
        code = wanted
    if not code:
        return nan
    unit_rad_s = velocity_unit_rad_s(code, joint.counts_per_turn)
    if unit_rad_s is None:
        raise DriveConfigurationError(
            settings.device,
            f"{VELOCITY_UNIT} is 0x{code:08X}: no angle per time that is known. Set it to rpm in the drive",
        )
    return unit_rad_s


def _check_encoder(access: ObjectAccess, settings: CanopenSettings, joint: JointScale) -> None:
    increments = access.read_if_present(ENCODER_INCREMENTS)
    turns = access.read_if_present(ENCODER_REVOLUTIONS)
    if increments and turns and increments != joint.counts_per_turn * turns:
        raise DriveConfigurationError(
            settings.device,
            f"counts per motor turn are {increments / turns:g} by {ENCODER_INCREMENTS}; the rig says "
            f"{joint.counts_per_turn:g}. Correct sensor.counts_per_turn of the rig",
        )
