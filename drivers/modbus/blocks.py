"""Registers that are read or written in one request."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from struct import Struct

from drivers.modbus.register import Register, Space, as_bytes

LONGEST_READ = 125  # words in one request (Modbus Application Protocol V1.1b3, 6.3)
LONGEST_WRITE = 121  # of function 23 (6.17)


@dataclass(frozen=True, slots=True)
class Block:
    """Words at consecutive addresses."""

    space: Space
    address: int
    words: int
    registers: tuple[Register, ...]
    _layout: Struct | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_layout", _layout(self) if all(one.is_plain for one in self.registers) else None)

    def decode(self, words: Sequence[int]) -> dict[str, float]:
        """Scaled values by name."""
        data, start, layout = as_bytes(words), self.address, self._layout
        if layout is not None:
            found = layout.unpack(data)
            return {
                register.name: number * register.scale + register.offset
                for register, number in zip(self.registers, found, strict=True)
            }
        return {
            register.name: register.decode_bytes(data, 2 * (register.address - start)) for register in self.registers
        }

    def encode(self, values: Mapping[str, float]) -> list[int]:
        """The words of scaled values; 0 for the registers that are left out.

        Raises:
            ValueError: a value that its register does not hold.
        """
        words = [0] * self.words
        for register in self.registers:
            if register.name in values:
                at = register.address - self.address
                words[at : at + register.words] = register.encode(values[register.name])
        return words


def blocks(registers: Iterable[Register], longest_gap: int = 0, longest: int = LONGEST_READ) -> list[Block]:
    """The fewest blocks that hold all registers.

    Args:
        registers: in any order.
        longest_gap: words without a meaning that a request may span; not every drive answers for those.
        longest: most words in a request.
    """
    found: list[Block] = []
    group: list[Register] = []
    for register in sorted(registers, key=lambda one: (one.space.value, one.address)):
        if group and not _fits(group, register, longest_gap, longest):
            found.append(_block(group))
            group = []
        group.append(register)
    return [*found, _block(group)] if group else found


def _layout(block: Block) -> Struct:
    """All of its registers at once, where each has the standard's order of bytes."""
    formats, end = [], block.address
    for register in block.registers:
        formats.append(f"{2 * (register.address - end)}x{register.number.value.removeprefix('>')}")
        end = register.end
    return Struct(f">{''.join(formats)}{2 * (block.address + block.words - end)}x")


def _fits(group: list[Register], register: Register, longest_gap: int, longest: int) -> bool:
    last = group[-1]
    return (
        register.space is last.space
        and register.address - last.end <= longest_gap
        and register.end - group[0].address <= longest
    )


def _block(group: list[Register]) -> Block:
    first, last = group[0], group[-1]
    return Block(first.space, first.address, last.end - first.address, tuple(group))
