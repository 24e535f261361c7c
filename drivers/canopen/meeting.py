"""Meeting a drive that somebody may have left as it was: first the power off, then everything else.

Who it is stands in its objects 0x1000, 0x1008 to 0x100A and 0x1018 (CiA 301).
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Final

from drivers.canopen.cia301.object_access import ObjectAccess, ObjectRefusedError
from drivers.canopen.cia301.object_table import Need, ObjectTable
from drivers.canopen.cia301.objects import CONTROLWORD, DEVICE_TYPE, PRODUCT, REVISION, SERIAL, STATUSWORD, VENDOR
from drivers.canopen.cia402.bits import OUTPUTS
from drivers.canopen.cia402.state_machine import DISABLE_VOLTAGE, QUICK_STOP, State, state_of
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConfigurationError, DriveConnectionError

_DRIVE_PROFILE: Final = 402
_VENDORS: Final = {0xFB: "maxon"}
_NAME, _FIRMWARE = 0x1008, 0x100A
_IDENTITY: Final = "identity"
_POWERED: Final = (State.ENABLED, State.QUICK_STOP, State.FAULT_REACTION)
_BRAKE_S: Final = 1.0
_OFF_S: Final = 0.5
_PAUSE_S: Final = 0.002
_PURPOSE: Final = "power"


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
    device_type = table.read(DEVICE_TYPE, _IDENTITY)
    profile = device_type & 0xFFFF
    if profile != _DRIVE_PROFILE:
        raise DriveConfigurationError(
            settings.device,
            f"device profile is {profile}; {_DRIVE_PROFILE}, a drive, is wanted (0x1000 is 0x{device_type:X}). Correct "
            "node_id where another node is meant; a controller without that profile cannot be driven over CANopen",
        )
    found = Identity(
        vendor_id=table.ask(VENDOR, _IDENTITY) or 0,
        product_code=table.ask(PRODUCT, _IDENTITY) or 0,
        revision=table.ask(REVISION, _IDENTITY) or 0,
        serial_number=table.ask(SERIAL, _IDENTITY) or 0,
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


def meet(
    table: ObjectTable, access: ObjectAccess, settings: CanopenSettings, pre_operational: Callable[[], None]
) -> tuple[State, Identity]:
    """Identity, power off, PRE-OPERATIONAL, in this order: a drive that leaves OPERATIONAL may go on turning.

    Returns:
        The state in which the drive was found, and who it is.

    Raises:
        DriveConnectionError: it does not answer, or does not switch off.
        DriveConfigurationError: it is no drive, or another one than the settings name.
    """
    try:
        access.read(STATUSWORD)
    except ObjectRefusedError:
        pass  # whatever it is, it answers: its identity says more
    except DriveConnectionError:
        pre_operational()  # a node that was stopped answers nothing else
    identity = identify(table, access, settings)
    found = state_of(table.read(STATUSWORD, _PURPOSE))
    if found in _POWERED:
        _switch_off(access, settings, found)
        table.note(
            "power", Need.REQUIRED, _PURPOSE, True, f"found in state '{found.value}', left by a host before: off"
        )
    pre_operational()
    access.write(CONTROLWORD, DISABLE_VOLTAGE)
    return found, identity


def _switch_off(access: ObjectAccess, settings: CanopenSettings, found: State) -> None:
    """Brake, then take the power away, by SDO alone; a holding brake on an output is set before."""
    outputs = None if settings.brake is None else access.read_if_present(OUTPUTS)
    if settings.brake is not None and outputs is not None:
        access.write(OUTPUTS, settings.brake.word(outputs, released=False))
    access.write(CONTROLWORD, QUICK_STOP)
    _await(access, lambda state: state not in _POWERED, _BRAKE_S)
    access.write(CONTROLWORD, DISABLE_VOLTAGE)
    if not _await(access, lambda state: state not in _POWERED, _OFF_S):
        raise DriveConnectionError(
            settings.device,
            f"was left in state '{found.value}' by a host before, and does not switch off; cut its power supply",
        )


def _await(access: ObjectAccess, condition: Callable[[State], bool], timeout_s: float) -> bool:
    deadline_s = perf_counter() + timeout_s
    while not condition(state_of(access.read(STATUSWORD))):
        if perf_counter() > deadline_s:
            return False
        time.sleep(_PAUSE_S)
    return True
