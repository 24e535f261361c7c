"""What may go wrong on a line."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

from sim_backend.errors import ParameterError
from sim_backend.faults.script import FOR_GOOD_S
from sim_backend.plant.component import Component, quantity


class Direction(Enum):
    """Which way bytes go."""

    TO_DEVICE = "to-device"
    FROM_DEVICE = "from-device"


class LinkFaultKind(Enum):
    """What happens to a packet. A packet is what one side wrote at a time."""

    DROP = "drop"  # it is gone
    DELAY = "delay"  # it comes late by `amount_s`, and all after it
    CORRUPT = "corrupt"  # one bit of it is flipped
    DUPLICATE = "duplicate"  # it comes twice
    SPLIT = "split"  # it comes in two halves, `amount_s` apart
    SILENT = "silent"  # nothing passes, either way
    DISCONNECT = "disconnect"  # the port itself is gone


@dataclass(frozen=True, kw_only=True)
class LinkFault(Component):
    """One thing that goes wrong on a line, for a time or for a number of packets.

    Attributes:
        direction: which way; None is both.
        packets: how many packets it strikes; None is every one while it lasts.
        probability: of striking a packet.
    """

    kind: LinkFaultKind
    direction: Direction | None = None
    packets: int | None = None
    start_s: float = quantity("s, the device's time", at_least=0)
    duration_s: float = quantity("s", above=0, default=FOR_GOOD_S)
    amount_s: float = quantity("s", at_least=0, at_most=10, default=0.02)
    probability: float = quantity("1", above=0, at_most=1, default=1.0)

    def holds(self, time_s: float) -> bool:
        """Tell whether it is there at a time."""
        return self.packets != 0 and 0.0 <= time_s - self.start_s < self.duration_s

    def strikes(self, direction: Direction, time_s: float) -> bool:
        """Tell whether it is there for a packet, chance aside."""
        return self.holds(time_s) and self.direction in (None, direction)


@dataclass
class LinkFaults:
    """The faults of a line."""

    faults: list[LinkFault] = field(default_factory=list)

    def add(self, faults: Iterable[LinkFault]) -> None:
        """Let something more go wrong."""
        self.faults.extend(faults)

    def lift(self) -> None:
        """Put everything right, now and to come."""
        self.faults.clear()

    def holds(self, kind: LinkFaultKind, time_s: float) -> bool:
        """Tell whether a kind is there."""
        return any(fault.kind is kind and fault.holds(time_s) for fault in self.faults)

    def strike(self, direction: Direction, time_s: float, chance: float) -> LinkFault | None:
        """Return the fault that strikes a packet, and count it.

        Args:
            direction: of the packet.
            time_s: now [s].
            chance: a random number, 0 .. 1.
        """
        for place, fault in enumerate(self.faults):
            if fault.strikes(direction, time_s) and chance <= fault.probability:
                if fault.packets is not None:
                    self.faults[place] = replace(fault, packets=fault.packets - 1)
                return fault
        return None


def link_fault(name: str, start_s: float, **values: Any) -> LinkFault:
    """Return a fault by the name of its kind.

    Raises:
        ParameterError: the kind, the direction or another value is not known or not possible.
    """
    try:
        kind = LinkFaultKind(name)
        direction = Direction(values.pop("direction")) if "direction" in values else None
        return LinkFault(kind=kind, direction=direction, start_s=start_s, **values)
    except (ValueError, TypeError) as error:
        kinds = ", ".join(one.value for one in LinkFaultKind)
        ways = ", ".join(one.value for one in Direction)
        raise ParameterError(f"link fault '{name}': {error}; kinds are {kinds}; directions are {ways}") from error
