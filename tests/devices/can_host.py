"""A host that talks to a CAN device in virtual time, in bytes."""

from struct import pack, unpack
from typing import Any

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.canopen.drive import ServoDrive
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.devices.joint_tables import behind_a_drive

NODE = 5
SIZES = {1: 0x2F, 2: 0x2B, 4: 0x23}


class CanHost:
    """Sends frames, keeps those that come back, and lets time pass."""

    def __init__(self, family: Any = GENERIC, **tables: dict[str, Any]) -> None:
        self.device = ServoDrive(behind_a_drive(changed=tables), family, NODE)
        self.frames: list[Frame] = []
        self.device.node.send = self.frames.append
        self.time_s = 0.0
        self.device.node.boot()

    def send(self, can_id: int, data: bytes | str = b"") -> list[Frame]:
        """Put a frame on the bus; return what comes back at once."""
        self.frames.clear()
        self.device.receive(Frame(can_id, bytes.fromhex(data) if isinstance(data, str) else data), self.time_s)
        return list(self.frames)

    def wait(self, duration_s: float) -> list[Frame]:
        """Let time pass; return what was sent meanwhile."""
        self.frames.clear()
        self.time_s += duration_s
        self.device.advance_to(self.time_s)
        return list(self.frames)

    def sdo(self, request: str) -> str:
        """Return the answer to an SDO request, both in hex."""
        (answer,) = self.send(0x600 + NODE, request)
        assert answer.can_id == 0x580 + NODE
        return answer.data.hex(" ")

    def write(self, index: int, subindex: int, value: int, length: int) -> int:
        """Write by expedited SDO; return the abort code, 0 for none."""
        data = (value % (1 << 8 * length)).to_bytes(length, "little").ljust(4, b"\0")
        return self._code(pack("<BHB", SIZES[length], index, subindex) + data, 0x60)

    def read(self, index: int, subindex: int = 0, layout: str = "i") -> int:
        """Read by expedited SDO."""
        (frame,) = self.send(0x600 + NODE, pack("<BHBI", 0x40, index, subindex, 0))
        assert frame.data[0] & 0xE3 == 0x43, frame.data.hex(" ")
        value: int = unpack_from("<" + layout, frame.data)
        return value

    def read_code(self, index: int, subindex: int = 0) -> int:
        """Return the abort code of reading."""
        return self._code(pack("<BHBI", 0x40, index, subindex, 0), 0x43)

    def control(self, *words: int) -> int:
        """Write controlwords, a control cycle each; return the statusword."""
        for word in words:
            assert self.write(0x6040, 0, word, 2) == 0
            self.wait(0.002)
        return self.read(0x6041, 0, "H")

    def enable(self, mode: int) -> int:
        """Go to operation enabled in a mode; return the statusword."""
        assert self.write(0x6060, 0, mode, 1) == 0
        return self.control(0x06, 0x07, 0x0F)

    def _code(self, request: bytes, good: int) -> int:
        (frame,) = self.send(0x600 + NODE, request)
        if frame.data[0] == 0x80:
            code: int = unpack("<I", frame.data[4:])[0]
            return code
        assert frame.data[0] & 0xE0 == good & 0xE0
        return 0


def unpack_from(layout: str, data: bytes) -> Any:
    """Unpack one value from the data bytes of an SDO answer."""
    from struct import unpack_from as unpack_at

    return unpack_at(layout, data, 4)[0]
