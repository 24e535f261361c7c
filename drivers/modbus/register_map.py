"""What a family of drives keeps in its registers, and what the driver does with them; read from TOML.

A map names its registers freely, and then says which of them plays which part:

    [demand]     duty, current_a, position_counts        what is written each cycle, by mode
    [measured]   time_s (the drive's own clock), position_counts, velocity_counts_s, duty, current_a, supply_v,
                 temperature_c
    [control]    register, and the words for off, quick_stop, clear_fault and each mode; left out where a demand of
                 zero is all that switches the motor off
    [status]     register, and the words that mean enabled, quick_stop and fault: after `mask`, or bit by bit (`bits`)
    [fault]      register, and names of its numbers
    [watchdog]   register (its unit is s), or `fixed_s` where it is set in the drive alone; the fault that it leaves;
                 `needs`: what other registers have to hold for it to act, by name, written and read back
    [limits]     current_a: register of the highest motor current, for drive.current_limit_a
    [identity]   vendor, product; registers of firmware and serial; register and word that tell the family; a text that
                 tells the product, and "simulated" where no hardware is behind it
    [mode]       register and the words of the modes, where it is not part of the control word
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from drivers.contract import Mode
from drivers.modbus.register import Register, Text

WRITE_ONE, WRITE_SEVERAL = 6, 16  # functions

DEMANDS = {Mode.DUTY: "duty", Mode.CURRENT: "current_a", Mode.POSITION: "position_counts"}
MEASURED = ("time_s", "position_counts", "velocity_counts_s", "duty", "current_a", "supply_v", "temperature_c")
SLOW = frozenset({"supply_v", "temperature_c"})


@dataclass(frozen=True, slots=True)
class Words:
    """A register, and which word in it means what.

    Attributes:
        mask: bits of the register that belong to the word.
        bits: True where several may hold at once: each is a bit, or some.
    """

    register: Register
    words: Mapping[str, int]
    mask: int = 0xFFFF
    bits: bool = False

    def holds(self, name: str, value: float) -> bool:
        """Whether a value of the register means this."""
        wanted = self.words.get(name)
        if wanted is None:
            return False
        found = int(value) & self.mask
        return found & wanted == wanted if self.bits else found == wanted


@dataclass(frozen=True, slots=True)
class Watchdog:
    """Where the drive is told how long it may be left alone.

    Attributes:
        register: None where it is set in the drive alone, with its own tools.
        fixed_s: that time [s].
        fault: what the fault register holds when the watchdog has stopped the motor, and nothing else is wrong; None
            where the drive does not tell.
        needs: scaled values that other registers have to hold for it to act.
    """

    register: Register | None
    fixed_s: float = 0.0
    fault: int | None = None
    needs: tuple[tuple[Register, float], ...] = ()


@dataclass(frozen=True, slots=True)
class Identity:
    """Who the drive is.

    Attributes:
        firmware, serial: registers; None where it does not tell.
        family: register and word by which the map and the drive recognise each other; None: not checked.
        product_text: what it calls itself, in place of `product`; None where it does not tell.
    """

    vendor: str
    product: str
    firmware: Register | None = None
    serial: Register | None = None
    family: Words | None = None
    product_text: Text | None = None


@dataclass(frozen=True, slots=True)
class RegisterMap:
    """A family of drives.

    Attributes:
        source: where the register table was published.
        demand: register of each mode's demand.
        measured: registers by quantity.
        read_write: whether one request may write and read (function 23).
        longest_gap: words without a meaning that a read may span.
        current_limit: register of the highest motor current [A]; None where the drive has none.
        write_function: WRITE_SEVERAL where every write is function 16, WRITE_ONE where it is function 6, word by word;
            None: 6 for a single word, 16 for several.
    """

    name: str
    source: str
    identity: Identity
    demand: Mapping[Mode, Register]
    measured: Mapping[str, Register]
    watchdog: Watchdog
    control: Words | None = None
    mode: Words | None = None
    status: Words | None = None
    fault: Register | None = None
    fault_names: Mapping[int, str] = field(default_factory=dict)
    fault_is_bits: bool = False
    read_write: bool = False
    longest_gap: int = 0
    current_limit: Register | None = None
    write_function: int | None = None

    @property
    def modes(self) -> frozenset[Mode]:
        """The modes that it has."""
        return frozenset(self.demand)

    def fault_name(self, number: int) -> str:
        """A fault in words."""
        if self.fault_is_bits:
            return ", ".join(name for bit, name in self.fault_names.items() if number & bit) or f"bits {number:#06x}"
        return self.fault_names.get(number, f"number {number:#06x}, which the map does not name")
