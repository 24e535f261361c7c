"""The object dictionary: values by index and subindex, and what may be done with them."""

from collections.abc import Callable, Iterable

from sim_backend.devices.canopen.abort import Abort, AbortCode
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object

Place = tuple[int, int]
Value = int | str
COMMUNICATION = range(0x1000, 0x2000)


class Dictionary:
    """Values, live values, and the rules of writing.

    Args:
        objects: the tables.
        node_id: added to the defaults that ask for it.
        absent_code: abort code where an object is not there; None: what CiA 301 names.
        refused_code: abort code where an object may not be written; None: what CiA 301 names.

    Attributes:
        live: where a value comes from when it is read; for what the drive measures.
        checks: called with a value before it is written by SDO; may raise `Abort`.
        reactions: called after a value was written, however.
    """

    def __init__(
        self, objects: Iterable[Object], node_id: int, absent_code: int | None = None, refused_code: int | None = None
    ) -> None:
        self.objects = {one.index: one for one in objects}
        self._absent_code = absent_code
        self._refused_code = refused_code
        self.node_id = node_id
        self._entries = {(one.index, entry.subindex): entry for one in self.objects.values() for entry in one.entries}
        self._values: dict[Place, Value] = {}
        self.live: dict[Place, Callable[[], int]] = {}
        self.checks: dict[Place, Callable[[int], None]] = {}
        self.reactions: dict[Place, Callable[[], None]] = {}
        self.reset(range(0x10000))

    def reset(self, indices: range) -> None:
        """Bring back the defaults of some indices."""
        for place, entry in self._entries.items():
            if place[0] in indices:
                added = self.node_id if entry.with_node_id else 0
                self._values[place] = entry.default if isinstance(entry.default, str) else entry.default + added

    def __contains__(self, place: Place) -> bool:
        return place in self._entries

    def entry(self, index: int, subindex: int) -> Entry:
        """Return what is said of a value.

        Raises:
            Abort: there is no such object, or it has no such subindex.
        """
        entry = self._entries.get((index, subindex))
        if entry is None or entry.hidden:
            known = index in self.objects and not self.is_hidden(index)
            raise Abort(self._absent_code or (AbortCode.NO_SUBINDEX if known else AbortCode.NO_OBJECT))
        return entry

    def is_hidden(self, index: int) -> bool:
        """Tell whether no host can reach an object that the drive works with."""
        return all(entry.hidden for entry in self.objects[index].entries)

    def subindices(self, index: int) -> list[int]:
        """Return the subindices of an object but 0, hidden ones too."""
        return sorted(sub for (one, sub) in self._entries if one == index and sub)

    def number(self, index: int, subindex: int = 0) -> int:
        """Return an integer; of a live one, what it is now."""
        place = index, subindex
        live = self.live.get(place)
        value = live() if live else self._values[place]
        assert isinstance(value, int)
        return value

    def put(self, index: int, subindex: int, value: int) -> None:
        """Set a value from inside: no rule applies, nothing reacts."""
        self._values[index, subindex] = value

    def read(self, index: int, subindex: int) -> bytes:
        """Return the bytes of a value, as SDO and PDO carry them.

        Raises:
            Abort: it is not there.
        """
        if self.entry(index, subindex).access is Access.WO:
            raise Abort(AbortCode.WRITE_ONLY)
        return self.content(index, subindex)

    def content(self, index: int, subindex: int) -> bytes:
        """Return the bytes of a value as a PDO carries them, whoever may read it."""
        live = self.live.get((index, subindex))
        return self._entries[index, subindex].kind.encode(live() if live else self._values[index, subindex])

    def write(self, index: int, subindex: int, data: bytes) -> None:
        """Write by SDO.

        Raises:
            Abort: it is not there, may not be written, or not with this value.
        """
        entry = self.entry(index, subindex)
        if not entry.access.writable:
            raise Abort(self._refused_code or AbortCode.READ_ONLY)
        length = entry.kind.length
        if length is None:
            raise Abort(AbortCode.UNSUPPORTED_ACCESS)
        if len(data) != length:
            raise Abort(AbortCode.LENGTH_TOO_HIGH if len(data) > length else AbortCode.LENGTH_TOO_LOW)
        value = entry.kind.decode(data)
        self._check(entry, value)
        check = self.checks.get((index, subindex))
        if check:
            check(value)
        self._store((index, subindex), value)

    def write_by_pdo(self, index: int, subindex: int, data: bytes) -> None:
        """Write by PDO: a value that may not be is left out, and nobody is told."""
        entry = self._entries[index, subindex]
        value = entry.kind.decode(data)
        try:
            self._check(entry, value)
            check = self.checks.get((index, subindex))
            if check:
                check(value)
        except Abort:
            return
        self._store((index, subindex), value)

    def _store(self, place: Place, value: int) -> None:
        self._values[place] = value
        reaction = self.reactions.get(place)
        if reaction:
            reaction()

    @staticmethod
    def _check(entry: Entry, value: int) -> None:
        if entry.high is not None and value > entry.high:
            raise Abort(AbortCode.VALUE_TOO_HIGH)
        if entry.low is not None and value < entry.low:
            raise Abort(AbortCode.VALUE_TOO_LOW)
