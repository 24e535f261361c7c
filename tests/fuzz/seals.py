"""Checksums of serial protocols put right again, so that what is spoilt gets past them."""

from collections.abc import Callable

from pymodbus.framer import FramerRTU

from drivers.dynamixel.frames import crc16 as dynamixel_crc
from drivers.feetech.frames import checksum as feetech_sum
from drivers.roboclaw.link import crc16 as roboclaw_crc

Seal = Callable[[bytes, bytes], bytes]
"""From a question and its spoilt answer to an answer whose checksum is right; a question itself has an empty one."""


def _roboclaw(question: bytes, data: bytes) -> bytes:
    return data[:-2] + roboclaw_crc(question + data[:-2]).to_bytes(2, "big")


def _modbus(_question: bytes, data: bytes) -> bytes:
    return data[:-2] + FramerRTU.compute_CRC(data[:-2]).to_bytes(2)


def _dynamixel(_question: bytes, data: bytes) -> bytes:
    return data[:-2] + dynamixel_crc(data[:-2]).to_bytes(2, "little")


def _feetech(_question: bytes, data: bytes) -> bytes:
    return data[:-1] + bytes((feetech_sum(data[2:-1]),))


SEALS: dict[str, Seal] = {
    "roboclaw": _roboclaw, "modbus": _modbus, "dynamixel": _dynamixel, "feetech": _feetech,
}  # fmt: skip
"""Of those kinds that have a checksum of packets; the frames of a CAN bus have none that a program sees."""
