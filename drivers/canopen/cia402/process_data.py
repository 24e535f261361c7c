"""Which PDOs carry what: each demand with the controlword in one RPDO, measurements in as few TPDOs as will do."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from drivers.canopen.cia301.object_access import ObjectAccess, ObjectRefusedError
from drivers.canopen.cia301.objects import (
    CONTROLWORD,
    MODE,
    POSITION,
    STATUSWORD,
    TARGET_POSITION,
    TARGET_TORQUE,
    TARGET_VELOCITY,
    TORQUE_OFFSET,
    VELOCITY_OFFSET,
    DataType,
    DriveObject,
)
from drivers.canopen.cia301.pdo import Pdo, PdoLayout
from drivers.canopen.cia301.pdo_setup import Slot, configure, read_slots, release, switch_off
from drivers.errors import DriveConfigurationError

_DEMANDED = (CONTROLWORD, MODE, TARGET_TORQUE, TARGET_POSITION, TARGET_VELOCITY, TORQUE_OFFSET, VELOCITY_OFFSET)
_REQUIRED = (STATUSWORD, POSITION)
_COB_IDS = range(1, 5)  # how many PDOs of each direction have a COB-ID of their own (CiA 301, 7.3.5)
_KINDS = {8: DataType.U8, 16: DataType.U16, 32: DataType.U32}  # of what is mapped and not used, by its bits


@dataclass(frozen=True, slots=True)
class ProcessData:
    """The PDOs in use.

    Attributes:
        demands: the RPDO of each target that found room; the controlword travels with it, so that neither comes before
            the other. Of a drive without any target, that of the controlword alone.
        tpdos: what the drive tells at every SYNC.
        lost: objects that found no place: targets in an RPDO, what is measured in a TPDO; and why, by the drive.
    """

    demands: dict[DriveObject, Pdo]
    tpdos: tuple[Pdo, ...]
    lost: dict[DriveObject, str]

    @property
    def idle(self) -> Pdo:
        """The RPDO for cycles that demand nothing."""
        return next(iter(self.demands.values()))

    @staticmethod
    def nothing(pdo: Pdo, controlword: int, position: int) -> bytes:
        """Payload of an RPDO: no torque, no speed, the position where the drive stands [counts]."""
        return rest_payload(pdo.layout, controlword, position)

    def place(self, item: DriveObject) -> tuple[int, int] | None:
        """Which TPDO tells an object, and where in it; None where none does."""
        for number, pdo in enumerate(self.tpdos):
            if item in pdo.layout.entries:
                return number, pdo.layout.entries.index(item)
        return None

    @property
    def sizes(self) -> tuple[int, ...]:
        """Bytes of the frames of a cycle: SYNC, the longest RPDO, every TPDO."""
        demand = max(pdo.layout.size for pdo in self.demands.values())
        return (0, demand, *(pdo.layout.size for pdo in self.tpdos))


def rest_payload(layout: PdoLayout, controlword: int, position: int, mode: int = 0) -> bytes:
    """Payload of an RPDO that demands nothing.

    Args:
        layout: of the RPDO.
        controlword: of the cycle.
        position: where the drive stands [counts].
        mode: code of 0x6060, where the RPDO carries it.
    """
    values = {CONTROLWORD: controlword, TARGET_POSITION: position, MODE: mode}
    return layout.pack(*(values.get(entry, 0) for entry in layout.entries))


class Arrangement:
    """Finds room for demands and measurements in the PDOs that a drive has, and configures them.

    Each layout is tried where the drive has it already, then anywhere: drives differ in how many objects a PDO takes.
    Then what the drive has mapped by itself is taken, where it carries what is needed.
    """

    def __init__(self, access: ObjectAccess, device: str, node_id: int) -> None:
        self._access = access
        self._device = device
        self._node_id = node_id
        self._slots: list[Slot] = []
        self._used: list[Pdo] = []
        self._refusals: list[DriveConfigurationError] = []
        self._lost: dict[DriveObject, str] = {}

    def arrange(
        self, targets: Sequence[DriveObject], offsets: Sequence[DriveObject], groups: Sequence[Sequence[DriveObject]]
    ) -> ProcessData:
        """Have every PDO configured, and the others off.

        Args:
            targets: one for each mode that is used.
            offsets: what is added to a target, where the drive has it.
            groups: what is measured; objects of a group are to be in one TPDO.

        Raises:
            DriveConfigurationError: there is no room for any target, the statusword or the position; with each refusal.
        """
        self._slots = read_slots(self._access, transmit=False)
        placed = {target: self._place_demand(target, offsets) for target in targets or (CONTROLWORD,)}
        demands = {target: pdo for target, pdo in placed.items() if pdo is not None}
        if not demands:
            raise self._no_room(" and ".join(map(str, dict.fromkeys((CONTROLWORD, *targets)))), "RPDO")
        self._refusals.clear()
        self._slots = read_slots(self._access, transmit=True)
        self._place_measured(groups)
        release(self._access, self._used)
        return ProcessData(demands, tuple(pdo for pdo in self._used if pdo.transmit), self._lost)

    def _place_demand(self, target: DriveObject, offsets: Sequence[DriveObject]) -> Pdo | None:
        needed = list(dict.fromkeys((CONTROLWORD, target)))
        made = self._place([*needed, *offsets])
        before = len(self._refusals)
        made = made or self._place(needed) or self._take_fixed(needed, _DEMANDED)
        if made is None:
            self._lost[target] = self._why_not(before, "RPDO")
        return made

    def _place_measured(self, groups: Sequence[Sequence[DriveObject]]) -> None:
        """Place the groups, or first of all what is required in one TPDO."""
        targets = dict(self._lost)
        for tried in (groups, [_REQUIRED, *groups]):
            self._used, self._lost = [pdo for pdo in self._used if not pdo.transmit], dict(targets)
            self._place_groups(tried)
            missing = [item for item in _REQUIRED if not self._is_told(item)]
            if not missing:
                return
        raise self._no_room(" and ".join(map(str, missing)), "TPDO")

    def _place_groups(self, groups: Sequence[Sequence[DriveObject]]) -> None:
        """Place the groups, then alone what did not fit."""
        left = [item for group in groups for item in self._place_group([it for it in group if not self._is_told(it)])]
        for item in sorted(left, key=lambda item: item not in _REQUIRED):
            before = len(self._refusals)
            if not (self._is_told(item) or self._place([item]) or self._take_fixed((item,), None)):
                self._lost[item] = self._why_not(before, "TPDO")

    def _place_group(self, group: list[DriveObject]) -> list[DriveObject]:
        """Place as much of a group as fits; return the rest."""
        for count in range(len(group), 0, -1):
            if self._place(group[:count]):
                return group[count:]
        return group

    def _is_told(self, item: DriveObject) -> bool:
        return any(pdo.transmit and item in pdo.layout.entries for pdo in self._used)

    def _place(self, entries: list[DriveObject]) -> Pdo | None:
        try:
            layout = PdoLayout(entries)
        except ValueError:
            return None
        wanted = tuple(entry.mapping for entry in entries)
        ranked = sorted(self._free(), key=lambda slot: (slot.mapped != wanted, slot.number))
        return next(filter(None, (self._configure(slot, layout) for slot in ranked)), None)

    def _take_fixed(self, needed: Sequence[DriveObject], known: Sequence[DriveObject] | None) -> Pdo | None:
        """Take a PDO as the drive has mapped it.

        Args:
            needed: what it has to carry.
            known: what else it may carry; None: anything, for it is not looked at.
        """
        by_word = {item.mapping: item for item in (*(known or ()), *needed)}
        for slot in self._free():
            entries = [by_word.get(word) or _unknown(word) for word in slot.mapped]
            if not set(needed) <= set(entries) or None in entries:
                continue
            if known is not None and not set(entries) <= set(known):
                continue
            made = self._configure(slot, PdoLayout([entry for entry in entries if entry is not None]))
            if made is not None:
                return made
        return None

    def _free(self) -> Iterator[Slot]:
        used = {(pdo.number, pdo.transmit) for pdo in self._used}
        return (slot for slot in self._slots if (slot.number, slot.transmit) not in used)

    def _configure(self, slot: Slot, layout: PdoLayout) -> Pdo | None:
        taken = {pdo.cob_id for pdo in self._used if pdo.transmit == slot.transmit}
        cob_ids = {n: (0x80 if slot.transmit else 0x100) + 0x100 * n + self._node_id for n in _COB_IDS}
        free = [n for n in cob_ids if cob_ids[n] not in taken]
        if not free:
            return None
        owner = slot.number if slot.number in free else free[0]
        if owner != slot.number:
            switch_off(self._access, owner, slot.transmit)
        pdo = Pdo(slot.number, slot.transmit, cob_ids[owner], layout)
        try:
            configure(self._access, self._device, pdo, slot)
        except DriveConfigurationError as error:
            self._refusals.append(error)
            return None
        self._used.append(pdo)
        return pdo

    def _no_room(self, what: str, kind: str) -> DriveConfigurationError:
        why = "; ".join(dict.fromkeys(error.message for error in self._refusals)) or f"it has no {kind} of its own"
        return DriveConfigurationError(self._device, f"no {kind} of the drive takes {what}: {why}")

    def _why_not(self, before: int, kind: str) -> str:
        """What was refused since there were so many refusals, in the drive's words."""
        refusals = self._refusals[before:]
        words = [error.why if isinstance(error, ObjectRefusedError) else error.message for error in refusals]
        return "; ".join(dict.fromkeys(words)) or f"no {kind} is left"


def _unknown(word: int) -> DriveObject | None:
    """What is mapped and not used, by its length; None where it has none that is whole bytes."""
    kind = _KINDS.get(word & 0xFF)
    return None if kind is None else DriveObject(word >> 16, word >> 8 & 0xFF, kind, "mapped by the drive")
