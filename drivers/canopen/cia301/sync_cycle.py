"""One control cycle on the bus: RPDO and SYNC out, TPDOs in (CiA 301, 7.2.2 and 7.2.5).

Drives on one bus answer the same SYNC. The first drive that is asked in a cycle sends it. The others take what they
measured at that SYNC; their demand goes out at once, and acts at the next one.
"""

from collections import deque
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

    TPDOs carry no count. So a SYNC is sent only when the one before has been answered by every drive of the bus, or has
    been given up after a second wait: then whatever comes in is taken for the answer to the latest one.

    A line on which all comes late looks the same as one that has lost as many answers. Answers come in the order in
    which they were asked for: so `values` may be as old as the first SYNC whose answer may still be under way.

    Args:
        link: open.
        tpdos: what the drive sends at each SYNC.
        wait_s: longest wait for them in a cycle [s].
        period_s: control period: a SYNC for another drive is used for half of it [s].
        lost_s: an answer that takes longer does not come [s].

    Attributes:
        values: of each TPDO, as last received.
        sync_s: when the SYNC was sent that `values` answer, as far as is known [s].
        earliest_s: when the earliest SYNC was sent that they may answer [s].
        number: of the SYNC that `values` answer.
    """

    def __init__(self, link: CanLink, tpdos: tuple[Pdo, ...], wait_s: float, period_s: float, lost_s: float) -> None:
        self.values: list[tuple[int, ...]] = [() for _ in tpdos]
        self.sync_s = self.earliest_s = perf_counter()
        self.number = 0
        self.counts = CycleCounts()
        self._link = link
        self._places = frozenset(range(len(tpdos)))
        self._wait_s = wait_s
        self._usable_s = 0.5 * period_s  # longer, and every cycle would begin with the SYNC of the one before
        self._is_new = False  # a SYNC of another drive's, which this one has not been asked about yet
        self._is_late = False  # the present SYNC has been waited for in vain
        self._missing: set[int] = set()
        self._in_doubt = False  # the last SYNC has been given up: its answer may still come
        self._lost_s = lost_s
        self._under_way: deque[float] = deque()  # when each SYNC was sent whose answer may still come
        self._asked_at = 0  # the SYNC before the last request of another kind
        self._arrived: dict[int, tuple[int, ...]] = {}
        self._sent_s = 0.0
        self._listened_s = 0.0
        for place, pdo in enumerate(tpdos):
            link.subscribe(pdo.cob_id, self._receiver(place, pdo))
        link.cycle = self

    def run(self, cob_id: int, payload: bytes) -> bool:
        """Send a command and SYNC, and wait for the answer; tell whether it came."""
        link = self._link
        if self._is_new and perf_counter() - self._sent_s < self._usable_s:
            self._is_new = False
            link.send_message(cob_id, payload)
            return self._await_answer()
        cycles = [other.cycle for other in link.port.links if other.cycle is not None]
        for cycle in cycles:
            cycle.finish()
        link.send_message(cob_id, payload)
        link.send_prepared(_SYNC)
        sent_s = perf_counter()
        for cycle in cycles:
            cycle.begin(sent_s)
        self._is_new = False
        return self._await_answer()

    def finish(self) -> None:
        """Before the next SYNC: give the last one a second chance to be answered, or take in what has come since."""
        if self._missing:
            self._is_late = True
            self._link.drain()
            if not self._await_answer():
                self.counts.missed += 1
        elif self._in_doubt or perf_counter() - self._sent_s > _PAUSE_S:
            self._link.drain()

    def begin(self, sent_s: float) -> None:
        """A SYNC has been sent."""
        self._in_doubt = bool(self._missing)
        while self._under_way and sent_s - self._under_way[0] > self._lost_s:
            self._under_way.popleft()
        self._under_way.append(sent_s)
        self._missing = set(self._places)
        self._arrived.clear()
        self._sent_s = sent_s
        self._is_new, self._is_late = True, False
        self.counts.sent += 1

    def asked(self) -> None:
        """A request has been sent whose answer comes after those to every SYNC so far."""
        self._asked_at = self.counts.sent

    def overtaken(self) -> None:
        """It has been answered: what has not come of the SYNC frames before it is lost."""
        while len(self._under_way) > self.counts.sent - self._asked_at:
            self._under_way.popleft()

    @property
    def silence_s(self) -> float:
        """How long answers have been listened for in vain [s]; 0 where the last SYNC was answered.

        Time in which the host was held up does not count: it is no silence of the drive.
        """
        return self._listened_s

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
        if self._is_late:
            self.counts.late += 1
        else:
            self.counts.answered += 1
        self.sync_s = self._sent_s
        self.earliest_s = self._under_way.popleft() if self._under_way else self._sent_s
        self.number = self.counts.sent
        self._listened_s = 0.0

    @property
    def idle_s(self) -> float:
        """Time since the last SYNC was sent [s]."""
        return perf_counter() - self._sent_s

    def value(self, place: tuple[int, int]) -> int:
        """What a TPDO told last."""
        return self.values[place[0]][place[1]]


def answer_wait_s(period_s: float) -> float:
    """How long a cycle waits for its answer [s]: a period, and no less than a busy host is late now and then."""
    return max(period_s, 0.01)
