"""PDO mapping: the rules of changing it, and the bytes that follow from it."""

from collections.abc import Callable

from sim_backend.devices.canopen.abort import Abort, AbortCode, only
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.objects.communication import PDO_DOES_NOT_EXIST

_PLACES = 8
_LONGEST_BITS = 64
_EXTENDED = 1 << 29
_CAN_ID = 0x7FF
_TYPES = frozenset(range(241)) | {254, 255}

Mapped = tuple[tuple[int, int, int], ...]  # index, subindex, bytes


class PdoParameters:
    """Communication and mapping parameter of one PDO.

    A PDO is changed in this order: make it not exist (bit 31 of its COB-ID), number of mapped objects to 0, the mapped
    objects, their number, and the COB-ID without bit 31. One whose COB-ID cannot be written goes on existing.
    """

    def __init__(self, dictionary: Dictionary, link: int, mapping: int, received: bool) -> None:
        self._dictionary = dictionary
        self._link = link
        self._mapping = mapping
        self._received = received
        dictionary.checks[link, 1] = self._check_cob_id
        dictionary.checks[link, 2] = only(_TYPES)
        dictionary.checks[mapping, 0] = self._check_count
        for place in range(1, _PLACES + 1):
            dictionary.checks[mapping, place] = self._check_place

    def on_change(self, reaction: Callable[[], None]) -> None:
        """Call something after any of the parameters was written."""
        for place in ((self._link, 1), (self._link, 2), (self._mapping, 0)):
            self._dictionary.reactions[place] = reaction

    @property
    def exists(self) -> bool:
        """Whether the PDO is in use."""
        return not self._dictionary.number(self._link, 1) & PDO_DOES_NOT_EXIST

    @property
    def can_id(self) -> int:
        """Its identifier."""
        return self._dictionary.number(self._link, 1) & _CAN_ID

    @property
    def type(self) -> int:
        """Its transmission type."""
        return self._dictionary.number(self._link, 2)

    def mapped(self) -> Mapped:
        """Return what is in it."""
        count = self._dictionary.number(self._mapping, 0)
        places = [place for place in self._dictionary.subindices(self._mapping) if place <= count]
        entries = (self._dictionary.number(self._mapping, place) for place in places)
        mapped = ((entry >> 16, entry >> 8 & 0xFF, (entry & 0xFF) // 8) for entry in entries)
        # a data sheet may map by default what is not there
        return tuple((index, sub, size) for index, sub, size in mapped if (index, sub) in self._dictionary)

    def _check_cob_id(self, value: int) -> None:
        if value & _EXTENDED:
            raise Abort(AbortCode.INVALID_VALUE)
        exists_then = not value & PDO_DOES_NOT_EXIST
        if self.exists and exists_then and value & _CAN_ID != self.can_id:
            raise Abort(AbortCode.INVALID_VALUE)

    @property
    def _is_in_use(self) -> bool:
        return self.exists and self._dictionary.entry(self._link, 1).access.writable

    def _check_count(self, value: int) -> None:
        if self._is_in_use:
            raise Abort(AbortCode.UNSUPPORTED_ACCESS)
        if value > _PLACES:
            raise Abort(AbortCode.MAPPING_TOO_LONG)
        bits = 0
        for place in range(1, value + 1):
            entry = self._dictionary.number(self._mapping, place)
            self._check_mappable(entry)
            bits += entry & 0xFF
        if bits > _LONGEST_BITS:
            raise Abort(AbortCode.MAPPING_TOO_LONG)

    def _check_place(self, value: int) -> None:
        if self._is_in_use or self._dictionary.number(self._mapping, 0) != 0:
            raise Abort(AbortCode.UNSUPPORTED_ACCESS)
        if value:
            self._check_mappable(value)

    def _check_mappable(self, value: int) -> None:
        entry = self._dictionary.entry(value >> 16, value >> 8 & 0xFF)
        if not entry.fits(self._received) or 8 * (entry.kind.length or 0) != value & 0xFF:
            raise Abort(AbortCode.NOT_MAPPABLE)
