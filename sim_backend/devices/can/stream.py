"""One host's connection through an adapter: bytes to frames and back, at the line's pace and with its faults."""

import heapq
import itertools
import threading
from collections.abc import Callable

from sim_backend.devices.can.frame import Adapter, Frame
from sim_backend.devices.link.faults import Direction
from sim_backend.devices.link.line import Line, pause_until
from sim_backend.devices.wall_time import WallTime


class Stream:
    """The adapter's end.

    What the line holds back is sent later by a thread, so that the drive never waits for it.
    """

    def __init__(
        self, adapter: Adapter, line: Line, clock: WallTime, write: Callable[[bytes], None],
        deliver: Callable[[Frame], None],
    ) -> None:  # fmt: skip
        self._adapter = adapter
        self._line = line
        self._clock = clock
        self._write = write
        self._deliver = deliver
        self._order = itertools.count()
        self._held: list[tuple[float, int, bytes]] = []
        self._news = threading.Condition()
        self._closed = False
        self._sender = threading.Thread(target=self._send_held, name="device stream", daemon=True)
        self._sender.start()
        self._put(adapter.greet())

    def arrive(self, data: bytes) -> None:
        """Take bytes of the host."""
        self._clock.hear()
        for delivery in self._line.carry(Direction.TO_DEVICE, data, self._clock.now_s()):
            pause_until(self._clock, delivery.at_s)
            answer, frames = self._adapter.feed(delivery.data)
            self._put(answer)
            for frame in frames:
                self._deliver(frame)

    def tell(self, frame: Frame) -> None:
        """Tell the host of a frame on the bus."""
        self._put(self._adapter.tell(frame))

    def close(self) -> None:
        """End the thread; what is held back is lost."""
        with self._news:
            self._closed = True
            self._news.notify()
        self._sender.join()

    def _put(self, data: bytes) -> None:
        if not data:
            return
        now_s = self._clock.now_s()
        with self._news:
            for delivery in self._line.carry(Direction.FROM_DEVICE, data, now_s):
                if delivery.at_s <= now_s and not self._held:
                    self._write(delivery.data)
                else:
                    heapq.heappush(self._held, (delivery.at_s, next(self._order), delivery.data))
                    self._news.notify()

    def _send_held(self) -> None:
        with self._news:
            while not self._closed:
                left_s = self._held[0][0] - self._clock.now_s() if self._held else None
                if left_s is None or left_s > 0.0:
                    self._news.wait(left_s)
                else:
                    self._write(heapq.heappop(self._held)[2])
