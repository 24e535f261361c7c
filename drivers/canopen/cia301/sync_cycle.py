"""One control cycle on the bus: RPDO and SYNC out, TPDOs in (CiA 301, 7.2.2 and 7.2.5)."""

from dataclasses import dataclass
from time import perf_counter
from typing import Any, Final

from drivers.canopen.cia301.link import CanLink, prepare
from drivers.canopen.cia301.pdo import Pdo

SYNC_COB_ID: Final = 0x80
_SYNC: Final = prepare(SYNC_COB_ID, b"")
_PAUSE_S: Final = 0.1  # after that long, take in what has come meanwhile before anything is asked


@dataclass(slots=True)
class CycleCounts:
    """What became of the cycles since opening.

    Attributes:
        sent: SYNC frames sent.
        answered: of those, answered by every TPDO in time.
        late: answered after their cycle had ended.
        missed: never answered.
        surplus: TPDOs that no SYNC asked for.
    """

    sent: int = 0
    answered: int = 0
    late: int = 0
    missed: int = 0
    surplus: int = 0


class SyncCycle:
    """Sends SYNC, and knows which TPDOs answer it.

    TPDOs carry no count. So a SYNC is sent only when the one before has been answered, or has been given up after a
    second wait: then whatever comes in belongs to the latest one.

    Args:
        link: open.
        tpdos: what the drive sends at each SYNC.
        wait_s: longest wait for them in a cycle [s].

    Attributes:
        values: of each TPDO, as last received.
        sync_s: when the SYNC was sent that `values` answer [s].
        received_s: when the last of `values` came in [s].
        number: of the SYNC that `values` answer.
    """

    def __init__(self, link: CanLink, tpdos: tuple[Pdo, ...], wait_s: float) -> None:
        self.values: list[tuple[int, ...]] = [() for _ in tpdos]
        self.sync_s = self.received_s = perf_counter()
        self.number = 0
        self.counts = CycleCounts()
        self._link = link
        self._places = frozenset(range(len(tpdos)))
        self._wait_s = wait_s
        self._missing: set[int] = set()
        self._in_doubt = False  # the last SYNC has been given up: its answer may still come
        self._arrived: dict[int, tuple[int, ...]] = {}
        self._sent_s = 0.0
        self._listened_s = 0.0
        for place, pdo in enumerate(tpdos):
            link.subscribe(pdo.cob_id, self._receiver(place, pdo))

    def run(self, cob_id: int, payload: bytes) -> bool:
        """Send a command and SYNC, and wait for the answer; tell whether it came.

        Args:
            cob_id: of the RPDO.
            payload: of the RPDO.
        """
        link, counts = self._link, self.counts
        if self._missing:
            self._settle()
        elif self._in_doubt or perf_counter() - self._sent_s > _PAUSE_S:
            link.drain()
        self._in_doubt = bool(self._missing)
        self._missing = set(self._places)
        self._arrived.clear()
        link.send_message(cob_id, payload)
        link.send_prepared(_SYNC)
        self._sent_s = perf_counter()
        counts.sent += 1
        if self._await_answer():
            counts.answered += 1
            return True
        return False

    @property
    def silence_s(self) -> float:
        """How long answers have been listened for in vain [s]; 0 where the last SYNC was answered.

        Time in which the host was held up does not count: it is no silence of the drive.
        """
        return self._listened_s

    def _settle(self) -> None:
        """Give the previous SYNC a second chance to be answered."""
        self._link.drain()
        if self._await_answer():
            self.counts.late += 1
        else:
            self.counts.missed += 1

    def _await_answer(self) -> bool:
        deadline_s = perf_counter() + self._wait_s
        while self._missing:
            remaining_s = deadline_s - perf_counter()
            if remaining_s <= 0.0:
                self._link.drain()  # a host that was held up is no drive that is silent
                return not self._missing
            began_s = perf_counter()
            self._link.receive(remaining_s)
            if self._missing:
                self._listened_s += min(perf_counter() - began_s, remaining_s)
        return True

    def _receiver(self, place: int, pdo: Pdo) -> Any:
        """The handler of a TPDO. Values are shown when all of one SYNC are there: they belong together."""
        unpack = pdo.layout.unpack

        def receive(_cob_id: int, data: bytes, _timestamp: float) -> None:
            values = unpack(data)  # raises where there are more or fewer bytes than were mapped
            if place not in self._missing:
                self.counts.surplus += 1
                return
            self._arrived[place] = values
            self._missing.discard(place)
            if not self._missing:
                self._show()

        return receive

    def _show(self) -> None:
        for place, values in self._arrived.items():
            self.values[place] = values
        self._arrived.clear()
        self.received_s = perf_counter()
        self.sync_s = self._sent_s
        self.number = self.counts.sent
        self._listened_s = 0.0

    @property
    def idle_s(self) -> float:
        """Time since the last SYNC was sent [s]."""
        return perf_counter() - self._sent_s

    def value(self, place: tuple[int, int]) -> int:
        """What a TPDO told last.

        Args:
            place: number of the TPDO, place in it.
        """
        return self.values[place[0]][place[1]]


def answer_wait_s(period_s: float) -> float:
    """How long a cycle waits for its answer [s]: a period, and no less than a busy host is late now and then."""
    return max(period_s, 0.01)
