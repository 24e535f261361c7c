"""The X models by their number: name, step of the current, and where the indirect data begin.

Numbers, items and the move of the indirect data with firmware 52 are those of the tables that come with
`dynamixel-sdk` 4.1; the steps of the current are those of the e-Manual, and are not in these tables.
"""

from typing import NamedTuple

_INDIRECT_DATA, _INDIRECT_DATA_LATER = 224, 208
_LATER_FIRMWARE = 52  # of the 330 models


class Model(NamedTuple):
    """What differs from model to model.

    Attributes:
        name: of the model.
        current_a: step of Present Current and Goal Current [A]; None where it measures no current.
        indirect_moves: whether firmware 52 and later have the indirect data elsewhere.
    """

    name: str
    current_a: float | None
    indirect_moves: bool = False

    def indirect_data(self, firmware: int) -> int:
        """Address of the first byte of indirect data."""
        return _INDIRECT_DATA_LATER if self.indirect_moves and firmware >= _LATER_FIRMWARE else _INDIRECT_DATA


MODELS: dict[int, Model] = {
    1000: Model("XH430-W350", 2.69e-3),
    1001: Model("XD430-T350", 2.69e-3),
    1010: Model("XH430-W210", 2.69e-3),
    1011: Model("XD430-T210", 2.69e-3),
    1020: Model("XM430-W350", 2.69e-3),
    1030: Model("XM430-W210", 2.69e-3),
    1040: Model("XH430-V350", 1.34e-3),
    1050: Model("XH430-V210", 1.34e-3),
    1060: Model("XL430-W250", None),
    1070: Model("XC430-W150", None),
    1080: Model("XC430-W240", None),
    1090: Model("2XL430-W250", None),
    1100: Model("XH540-W270", 2.69e-3),
    1101: Model("XD540-T270", 2.69e-3),
    1110: Model("XH540-W150", 2.69e-3),
    1111: Model("XD540-T150", 2.69e-3),
    1120: Model("XM540-W270", 2.69e-3),
    1130: Model("XM540-W150", 2.69e-3),
    1140: Model("XH540-V270", 2.69e-3),
    1150: Model("XH540-V150", 2.69e-3),
    1160: Model("2XC430-W250", None),
    1170: Model("XW540-T260", 2.69e-3),
    1180: Model("XW540-T140", 2.69e-3),
    1190: Model("XL330-M077", 1e-3, indirect_moves=True),
    1200: Model("XL330-M288", 1e-3, indirect_moves=True),
    1210: Model("XC330-T181", 1e-3, indirect_moves=True),
    1220: Model("XC330-T288", 1e-3, indirect_moves=True),
    1230: Model("XC330-M181", 1e-3, indirect_moves=True),
    1240: Model("XC330-M288", 1e-3, indirect_moves=True),
    1270: Model("XW430-T333", 2.69e-3),
    1310: Model("XW540-H260", 2.69e-3),
}
