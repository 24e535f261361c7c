"""What a port asks of a device that speaks in bytes."""

from typing import Protocol

from sim_backend.devices.device import Device


class ByteDevice(Device, Protocol):
    """A device on a serial line or a stream."""

    def receive(self, data: bytes, time_s: float) -> bytes:
        """Take bytes that have arrived at a time [s], and return what the device answers."""

    def connect(self) -> None:
        """Somebody has plugged in anew: forget half of a packet."""
