"""What a cycle writes and reads, as blocks; made once from the map."""

from collections.abc import Mapping
from dataclasses import dataclass

from drivers.modbus.blocks import LONGEST_WRITE, Block, blocks
from drivers.modbus.link import Link
from drivers.modbus.power_stage import Values
from drivers.modbus.register import Space
from drivers.modbus.register_map import SLOW, RegisterMap


@dataclass(frozen=True, slots=True)
class Exchange:
    """The requests of a cycle.

    Attributes:
        written: control, mode and demands.
        read: what is asked for in every cycle.
        slow: what is asked for in turn, now and then.
        in_one: whether one request does it all.
    """

    written: list[Block]
    read: list[Block]
    slow: list[Block]
    in_one: bool

    def cycle(self, link: Link, values: Mapping[str, float]) -> Values:
        """Write values by register name, and return what was read, by register name.

        Raises:
            DriveConnectionError: no valid answer in time.
            ValueError: a value that its register does not hold; nothing was sent.
        """
        words = [block.encode(values) for block in self.written]
        if self.in_one:
            return self.read[0].decode(link.write_then_read(self.written[0], words[0], self.read[0]))
        for block, data in zip(self.written, words, strict=True):
            link.write(block, data)
        found: Values = {}
        for block in self.read:
            found |= block.decode(link.read(block))
        return found


def plan(register_map: RegisterMap) -> Exchange:
    """The fewest requests that a map allows."""
    written = list(register_map.demand.values())
    written += [part.register for part in (register_map.control, register_map.mode) if part is not None]
    fast = [register for name, register in register_map.measured.items() if name not in SLOW]
    fast += [register_map.status.register] if register_map.status is not None else []
    fast += [register_map.fault] if register_map.fault is not None else []
    slow = [register for name, register in register_map.measured.items() if name in SLOW]
    gap = register_map.longest_gap
    quick, everything = blocks(fast, gap), blocks([*fast, *slow], gap)
    if len(everything) <= len(quick):  # what is slow comes along for nothing
        quick, slow = everything, []
    write_blocks = blocks(written, longest=LONGEST_WRITE)
    in_one = (
        register_map.read_write
        and len(write_blocks) == len(quick) == 1
        and quick[0].space is write_blocks[0].space is Space.HOLDING
    )
    return Exchange(write_blocks, quick, blocks(slow, gap), in_one)
