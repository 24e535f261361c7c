"""Where each family of drives keeps what CiA 402 leaves open: data, not branches."""

from collections.abc import Callable
from dataclasses import dataclass

from drivers.canopen.cia301.objects import RATED_CURRENT, DataType, DriveObject
from drivers.errors import DriveConfigurationError


@dataclass(frozen=True, slots=True)
class ObjectProfile:
    """The objects of a family of drives. None where the family has none.

    Attributes:
        vendor_id: 0x1018:01 of the family; None for any.
        duty: magnitude of the applied PWM duty.
        supply: DC link voltage.
        rated_current: what 1000 permille of torque are in current; None where it follows from the next two.
        rated_torque, torque_constant: rated torque / torque constant = rated current.
    """

    name: str
    vendor_id: int | None
    current: DriveObject
    duty: DriveObject | None
    supply: DriveObject
    temperature: DriveObject | None
    rated_current: DriveObject | None
    rated_torque: DriveObject | None
    torque_constant: DriveObject | None
    current_limit: DriveObject


CIA402 = ObjectProfile(
    name="cia402",
    vendor_id=None,
    current=DriveObject(0x6078, 0, DataType.I16, "current actual value", 1e-3, "rated current", mappable=True),
    duty=None,
    supply=DriveObject(0x6079, 0, DataType.U32, "DC link circuit voltage", 1e-3, "V"),
    temperature=None,
    rated_current=RATED_CURRENT,
    rated_torque=None,
    torque_constant=None,
    current_limit=DriveObject(0x6073, 0, DataType.U16, "max current", 1e-3, "rated current"),
)
"""The objects of CiA 402 itself. Duty and temperature are manufacturer specific."""

EPOS4 = ObjectProfile(
    name="epos4",
    vendor_id=0xFB,
    current=DriveObject(0x30D1, 2, DataType.I32, "current actual value", 1e-3, "A", mappable=True),
    duty=DriveObject(0x3203, 1, DataType.U16, "PWM duty cycle actual value", 1e-3, "", mappable=True),
    supply=DriveObject(0x2200, 1, DataType.U16, "power supply voltage", 0.1, "V"),
    temperature=DriveObject(0x3201, 1, DataType.I16, "temperature power stage", 0.1, "degC"),
    rated_current=None,
    rated_torque=DriveObject(0x6076, 0, DataType.U32, "motor rated torque", 1e-6, "N m"),
    torque_constant=DriveObject(0x3001, 5, DataType.U32, "torque constant", 1e-6, "N m/A"),
    current_limit=DriveObject(0x3001, 2, DataType.U32, "output current limit", 1e-3, "A"),
)
"""maxon EPOS4. Places and types are those of its EDS (software 0x0170); the scales were not checked on a device."""

PROFILES = {profile.name: profile for profile in (CIA402, EPOS4)}


def choose_profile(
    device: str, wanted: str, vendor_id: int, has: Callable[[DriveObject], bool]
) -> tuple[ObjectProfile, str]:
    """The profile that the settings name, or with "auto" the one of the vendor whose object for the current is there.

    One vendor has families that share few objects: an EPOS2 tells its current by CiA 402, an EPOS4 does not.

    Args:
        device: name in messages.
        wanted: name of a profile, or "auto".
        vendor_id: 0x1018:01.
        has: whether the drive has an object.

    Returns:
        The profile, and why it is that one.

    Raises:
        DriveConfigurationError: the named profile belongs to another vendor.
    """
    if wanted == "auto":
        of_vendor = [profile for profile in PROFILES.values() if profile.vendor_id == vendor_id]
        found = next((profile for profile in of_vendor if has(profile.current)), None)
        if found is not None:
            return found, f"it is of vendor 0x{vendor_id:X} and has {found.current}"
        lacks = "".join(f"; it is no {profile.name}, for it has no {profile.current}" for profile in of_vendor)
        return CIA402, f"the objects of CiA 402 itself{lacks}"
    profile = PROFILES[wanted]
    if profile.vendor_id not in (None, vendor_id):
        raise DriveConfigurationError(
            device,
            f"vendor ID is 0x{vendor_id:X}; profile '{wanted}' is for 0x{profile.vendor_id:X}. "
            'Set profile = "auto" or "cia402"',
        )
    return profile, "the configuration says so"
