"""The static data types of CiA 301 that this node uses. Numbers are little-endian on the wire."""

from dataclasses import dataclass
from struct import calcsize, pack, unpack


@dataclass(frozen=True, slots=True)
class DataType:
    """One type.

    Attributes:
        layout: of `struct`; "" is text. A real number is kept as the integer of its bytes: this drive has none.
    """

    code: int
    layout: str

    @property
    def length(self) -> int | None:
        """Bytes on the wire; None for text."""
        return calcsize("<" + self.layout) if self.layout else None

    @property
    def range(self) -> tuple[int, int]:
        """Smallest and largest integer."""
        bits = 8 * calcsize("<" + self.layout)
        return (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if self.layout.islower() else (0, (1 << bits) - 1)

    def encode(self, value: int | str) -> bytes:
        """Return the bytes of a value; an integer beyond the type's range becomes the nearest that is not."""
        if isinstance(value, str):
            return value.encode("ascii", "replace")
        low, high = self.range
        return pack("<" + self.layout, max(low, min(high, value)))

    def decode(self, data: bytes) -> int:
        """Return the integer of some bytes."""
        value: int = unpack("<" + self.layout, data)[0]
        return value


I8, I16, I32 = DataType(0x02, "b"), DataType(0x03, "h"), DataType(0x04, "i")
U8, U16, U32 = DataType(0x05, "B"), DataType(0x06, "H"), DataType(0x07, "I")
TEXT = DataType(0x09, "")
_OTHERS = (
    DataType(0x01, "B"), DataType(0x08, "I"), DataType(0x11, "Q"), DataType(0x15, "q"), DataType(0x1B, "Q"),
    DataType(0x0A, ""), DataType(0x0B, ""), DataType(0x0F, ""),
)  # fmt: skip
TYPES = {kind.code: kind for kind in (I8, I16, I32, U8, U16, U32, TEXT, *_OTHERS)}
"""By their number in an EDS; those that are not here have lengths that no object of a drive has."""
