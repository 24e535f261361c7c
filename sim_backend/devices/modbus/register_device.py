"""What a Modbus server asks of a device."""

from typing import Protocol

from sim_backend.devices.device import Device


class RegisterDevice(Device, Protocol):
    """A device with registers. Both calls raise `Refused` or `Unanswered`, and then have done nothing."""

    def read(self, function: int, address: int, count: int) -> list[int]:
        """Return registers."""

    def write(self, function: int, address: int, words: list[int]) -> None:
        """Write registers."""
