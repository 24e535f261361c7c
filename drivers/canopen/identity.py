"""Who is on the other end (CiA 301, 0x1000, 0x1008 to 0x100A, 0x1018), and whether it is the drive that is meant."""

from dataclasses import dataclass
from typing import Final

from drivers.canopen.cia301.object_access import ObjectAccess
from drivers.canopen.cia301.object_table import ObjectTable
from drivers.canopen.cia301.objects import DEVICE_TYPE, PRODUCT, REVISION, SERIAL, VENDOR
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConfigurationError

_DRIVE_PROFILE: Final = 402
_VENDORS: Final = {0xFB: "maxon"}
_NAME, _FIRMWARE = 0x1008, 0x100A
_PURPOSE: Final = "identity"


@dataclass(frozen=True, slots=True)
class Identity:
    """What the drive says of itself."""

    vendor_id: int
    product_code: int
    revision: int
    serial_number: int
    name: str
    firmware: str

    @property
    def vendor(self) -> str:
        """Name of the vendor, or its number."""
        return _VENDORS.get(self.vendor_id, f"0x{self.vendor_id:X}")

    @property
    def product(self) -> str:
        """Name of the product, and its code."""
        return f"{self.name} 0x{self.product_code:X}".strip()


def identify(table: ObjectTable, access: ObjectAccess, settings: CanopenSettings) -> Identity:
    """Read the identity, and compare it with the settings.

    Raises:
        DriveConfigurationError: it is no CiA 402 drive, or another one than the settings name.
    """
    device_type = table.read(DEVICE_TYPE, _PURPOSE)
    profile = device_type & 0xFFFF
    if profile != _DRIVE_PROFILE:
        raise DriveConfigurationError(
            settings.device,
            f"device profile is {profile}; {_DRIVE_PROFILE}, a drive, is wanted (0x1000 is 0x{device_type:X}). Correct "
            "node_id where another node is meant; a controller without that profile cannot be driven over CANopen",
        )
    found = Identity(
        vendor_id=table.ask(VENDOR, _PURPOSE) or 0,
        product_code=table.ask(PRODUCT, _PURPOSE) or 0,
        revision=table.ask(REVISION, _PURPOSE) or 0,
        serial_number=table.ask(SERIAL, _PURPOSE) or 0,
        name=access.read_text(_NAME),
        firmware=access.read_text(_FIRMWARE),
    )
    wanted_and_found = {
        "vendor_id": (settings.vendor_id, found.vendor_id),
        "product_code": (settings.product_code, found.product_code),
        "serial_number": (settings.serial_number, found.serial_number),
    }
    for name, (wanted, value) in wanted_and_found.items():
        if wanted not in (None, value):
            raise DriveConfigurationError(
                settings.device,
                f"{name} is 0x{value:X}; 0x{wanted:X} is wanted. This is another drive: correct node_id or {name}",
            )
    return found
