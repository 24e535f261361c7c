"""The control table of an X servo: defaults, what may be written when, and the indirect addresses."""

from struct import pack_into, unpack_from
from typing import NamedTuple

_SIZE = 256
READ_ONLY = (range(7), range(69, 71), range(120, 147))
EEPROM = range(64)
GOALS = range(100, 120)
INDIRECT_ADDRESSES = range(168, 208)  # of the twenty that all models have
RAM = range(64, _SIZE)


class Kind(NamedTuple):
    """A model, as far as it matters here.

    Attributes:
        current_a: one step of the current [A]; 0: it measures the load instead, in 0.1 %.
        indirect_data: where the data of the indirect addresses begin.
    """

    number: int
    current_a: float
    indirect_data: int
    modes: frozenset[int]


_ALL = frozenset({0, 1, 3, 4, 5, 16})
KINDS: dict[str, Kind] = {
    "XM430-W350": Kind(1020, 0.00269, 224, _ALL),
    "XL330-M288": Kind(1200, 0.001, 208, _ALL),
    "XL430-W250": Kind(1060, 0.0, 224, frozenset({1, 3, 4, 16})),
}

# address: (struct letter, value) of what is not 0
_DEFAULTS = {
    8: ("B", 1), 9: ("B", 250), 11: ("B", 3), 12: ("B", 255), 13: ("B", 2), 24: ("I", 10), 31: ("B", 80),
    32: ("H", 260), 34: ("H", 95), 36: ("H", 885), 38: ("H", 1193), 44: ("I", 200), 48: ("I", 4095), 63: ("B", 52),
    68: ("B", 2), 76: ("H", 1920), 78: ("H", 100), 84: ("H", 800), 100: ("h", 885), 102: ("h", 1193),
}  # fmt: skip


class Memory:
    """The bytes.

    Args:
        kind: of model.
        servo_id: 0 .. 252.
        firmware: its version.
    """

    def __init__(self, kind: Kind, servo_id: int, firmware: int) -> None:
        self._kind = kind
        self._bytes = bytearray(_SIZE)
        for address, (letter, value) in _DEFAULTS.items():
            self.put(address, letter, value)
        self.put(0, "H", kind.number)
        self.put(6, "B", firmware)
        self.put(7, "B", servo_id)
        self._power_up = bytes(self._bytes)
        self.restart()

    def restart(self) -> None:
        """Forget everything that is not kept beyond power-off."""
        self._bytes[RAM.start :] = self._power_up[RAM.start :]
        for place in range(len(INDIRECT_ADDRESSES) // 2):
            self.put(INDIRECT_ADDRESSES.start + 2 * place, "H", self._kind.indirect_data + place)

    def put(self, address: int, letter: str, value: int) -> None:
        """Set an item."""
        pack_into("<" + letter, self._bytes, address, value)

    def get(self, address: int, letter: str = "B") -> int:
        """Return an item."""
        return int(unpack_from("<" + letter, self._bytes, address)[0])

    def read(self, address: int, size: int) -> bytes:
        """Return bytes as a host reads them."""
        return bytes(self._bytes[self._place(one)] for one in range(address, address + size))

    def write(self, address: int, data: bytes) -> None:
        """Set bytes as a host writes them."""
        for offset, byte in enumerate(data):
            self._bytes[self._place(address + offset)] = byte

    def places(self, address: int, size: int) -> list[int]:
        """Return where bytes truly are, the indirect data followed."""
        return [self._place(one) for one in range(address, address + size)]

    def _place(self, address: int) -> int:
        index = address - self._kind.indirect_data
        if not 0 <= index < len(INDIRECT_ADDRESSES) // 2:
            return address
        return self.get(INDIRECT_ADDRESSES.start + 2 * index, "H") % _SIZE

    @staticmethod
    def holds(address: int, size: int) -> bool:
        """Tell whether a piece is inside the table."""
        return size > 0 and address + size <= _SIZE
