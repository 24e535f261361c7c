"""Which objects of the drive are used, what for, and what became of each: read first, written only where it differs."""

import struct
from dataclasses import dataclass
from enum import Enum

from drivers.canopen.cia301.object_access import ObjectAccess, ObjectRefusedError
from drivers.canopen.cia301.objects import DriveObject
from drivers.errors import DriveConfigurationError


class Need(Enum):
    """How much depends on an object."""

    REQUIRED = "required"
    WISHED = "wished"


@dataclass(frozen=True, slots=True)
class ObjectUse:
    """One row of the table.

    Attributes:
        need: without a required one the drive is not opened.
        found: whether the drive has it and it is as wanted; else it is done without.
        outcome: in words: the value, or why it is done without.
    """

    object: str
    need: Need
    purpose: str
    found: bool
    outcome: str


class ObjectTable:
    """Reads and writes objects, and keeps what came of it.

    Any refusal of a wished object counts as its absence, whatever the abort code: drives answer alike questions
    differently.
    """

    def __init__(self, access: ObjectAccess, device: str) -> None:
        self._access = access
        self._device = device
        self._rows: dict[tuple[str, str], ObjectUse] = {}

    @property
    def rows(self) -> tuple[ObjectUse, ...]:
        """In the order of first use."""
        return tuple(self._rows.values())

    def outcome(self, item: object, purpose: str) -> str:
        """What became of an object; "" where it was not used."""
        row = self._rows.get((str(item), purpose))
        return row.outcome if row is not None else ""

    def note(self, name: object, need: Need, purpose: str, found: bool, outcome: str) -> None:
        """Put down what became of an object, or of several."""
        self._rows[str(name), purpose] = ObjectUse(str(name), need, purpose, found, outcome)

    def read(self, item: DriveObject, purpose: str) -> int:
        """Value of a required object [counts].

        Raises:
            ObjectRefusedError: the drive does not tell it.
            DriveConnectionError: it does not answer.
        """
        value = self._access.read(item)
        self.note(item, Need.REQUIRED, purpose, True, item.words(value))
        return value

    def ask(self, item: DriveObject, purpose: str, need: Need = Need.WISHED) -> int | None:
        """Value of an object [counts], None where the drive does not tell it."""
        try:
            value = self._access.read(item)
        except ObjectRefusedError as refusal:
            self.note(item, need, purpose, False, _refused(refusal, "not told"))
            return None
        self.note(item, need, purpose, True, item.words(value))
        return value

    def has(self, item: DriveObject, purpose: str) -> bool:
        """Whether the drive has an object. One that may only be written is there, too."""
        try:
            value = self._access.read(item)
        except ObjectRefusedError as refusal:
            there = refusal.write_only
            self.note(item, Need.WISHED, purpose, there, "write only" if there else _refused(refusal, "absent"))
            return there
        self.note(item, Need.WISHED, purpose, True, item.words(value))
        return True

    def set(self, item: DriveObject, value: int, purpose: str) -> None:
        """Have an object at a value: read, written where it differs, read back.

        Raises:
            DriveConfigurationError: the drive refuses it, or reads back something else.
            DriveConnectionError: it does not answer.
        """
        try:
            outcome = self._set(item, value)
        except DriveConfigurationError as error:
            self.note(item, Need.REQUIRED, purpose, False, str(error))
            raise
        self.note(item, Need.REQUIRED, purpose, True, outcome)

    def try_set(self, item: DriveObject, value: int, purpose: str) -> bool:
        """As `set`, of a wished object; tell whether it is at the value now."""
        try:
            outcome = self._set(item, value)
        except DriveConfigurationError as error:
            why = error.why if isinstance(error, ObjectRefusedError) else str(error)
            self.note(item, Need.WISHED, purpose, False, f"stays as it is: {why}")
            return False
        self.note(item, Need.WISHED, purpose, True, outcome)
        return True

    def _set(self, item: DriveObject, value: int) -> str:
        before = self._value_if_told(item)
        if before == value:
            return f"{item.words(value)}, as it was"
        try:
            self._access.write(item, value)
        except struct.error as error:
            raise DriveConfigurationError(self._device, f"{item} cannot be {value}: {error}") from error
        if before is None:  # write only: nothing can be read back
            return f"{item.words(value)}, written; the drive does not tell it"
        after = self._access.read(item)
        if after != value:
            raise DriveConfigurationError(
                self._device,
                f"{item} reads back as 0x{after & 0xFFFFFFFF:X}; 0x{value & 0xFFFFFFFF:X} is wanted; unlock the object "
                "in the drive's own tool",
            )
        return f"{item.words(value)}, was {item.words(before)}"

    def _value_if_told(self, item: DriveObject) -> int | None:
        """Value of an object; None of one that may only be written."""
        try:
            return self._access.read(item)
        except ObjectRefusedError as refusal:
            if refusal.write_only:
                return None
            raise


def _refused(refusal: ObjectRefusedError, otherwise: str) -> str:
    return f"{'of another data type' if refusal.other_type else otherwise}: {refusal.why}"
