"""Which SYNC an answer may belong to, on a clock of its own: a line that is late looks like one that loses."""

from types import SimpleNamespace

import pytest

from drivers.canopen.cia301 import sync_cycle
from drivers.canopen.cia301.sync_cycle import SyncCycle

WAIT_S, PERIOD_S, LOST_S = 0.01, 0.01, 0.5
TPDO, SDO = 0x185, 0x585
UNPACK = SimpleNamespace(cob_id=TPDO, layout=SimpleNamespace(unpack=lambda data: (data[0],)))


class Line:
    """A drive that answers each SYNC with a count of its own, so late; `lose` answers are lost.

    It is clock, link, and port at once.
    """

    def __init__(self):
        self.now_s, self.delay_s, self.lose = 0.0, 0.001, 0
        self.cycle, self.links, self.port = None, [self], self
        self._measured, self._under_way = 0, []
        self._handlers = {SDO: lambda *_frame: self.cycle.overtaken()}

    def subscribe(self, cob_id, handler):
        self._handlers[cob_id] = handler

    def send_message(self, _cob_id, _payload):
        """The demand: the drive does nothing with it."""

    def send_prepared(self, _frame):
        self._measured = (self._measured + 1) % 256
        if self.lose:
            self.lose -= 1
        else:
            self._under_way.append((self.now_s + self.delay_s, TPDO, bytes([self._measured])))

    def ask(self):
        """For an object, whose answer comes after those to every SYNC so far."""
        self.cycle.asked()
        self._under_way.append((self.now_s + self.delay_s, SDO, b""))

    def receive(self, timeout_s):
        until_s = self.now_s + timeout_s
        if self._under_way and self._under_way[0][0] <= until_s:
            due_s, cob_id, data = self._under_way.pop(0)
            self.now_s = max(self.now_s, due_s)
            self._handlers[cob_id](cob_id, data, due_s)
        else:
            self.now_s = until_s + 1e-9

    def drain(self):
        while self._under_way and self._under_way[0][0] <= self.now_s:
            self.receive(0.0)


class Bench:
    """Cycles on a line; when each SYNC was sent is known, so that the true age of what was measured is."""

    def __init__(self):
        self.line = Line()
        self.cycle = SyncCycle(self.line, (UNPACK,), WAIT_S, PERIOD_S, LOST_S)
        self._sent_s = {}

    def run(self, count):
        """Several cycles; of each the age that is told and the true one [s]."""
        return [self._one() for _ in range(count)]

    def lose(self, count):
        """Cycles in time, then some whose answers are lost."""
        self.run(20)
        self.line.lose = count
        self.run(count)

    def tells_true_ages(self):
        return all(told == pytest.approx(true) for told, true in self.run(5))

    def _one(self):
        began_s = self.line.now_s
        self.cycle.run(0x205, b"")
        self._sent_s[self.cycle.counts.sent % 256] = self.cycle._sent_s
        ages = (self.line.now_s - self.cycle.earliest_s, self.line.now_s - self._sent_s[self.cycle.values[0][0]])
        self.line.now_s = max(self.line.now_s, began_s + PERIOD_S)
        return ages


@pytest.fixture
def bench(monkeypatch):
    made = Bench()
    monkeypatch.setattr(sync_cycle, "perf_counter", lambda: made.line.now_s)
    return made


def test_answers_in_time_are_as_old_as_their_sync(bench):
    assert all(told == pytest.approx(true) == pytest.approx(0.001) for told, true in bench.run(20))


def test_what_is_late_is_as_old_as_it_is_however_long_ago_the_delay_began(bench):
    bench.run(20)
    bench.line.delay_s = 0.15
    bench.run(40)
    told_s, true_s = zip(*bench.run(20), strict=True)
    assert min(true_s) > 0.14
    assert told_s == pytest.approx(true_s)


def test_after_a_lost_answer_the_age_is_at_least_the_true_one_until_another_answer_tells(bench):
    bench.lose(3)
    bench.run(3)
    assert all(told >= true + 2.0 * PERIOD_S for told, true in bench.run(5))
    bench.line.ask()
    assert bench.tells_true_ages()


def test_an_answer_of_another_kind_on_a_late_line_does_not_make_it_look_prompt(bench):
    bench.run(20)
    bench.line.delay_s = 0.15
    bench.run(40)
    bench.line.ask()
    told_s, true_s = zip(*bench.run(40), strict=True)  # the round trip, and more
    assert min(true_s) > 0.14
    assert told_s == pytest.approx(true_s)


def test_what_is_older_than_any_answer_is_lost(bench):
    bench.lose(3)
    bench.line.now_s += 2.0 * LOST_S
    bench.run(1)
    assert bench.tells_true_ages()
