"""A CiA 402 drive on a CANopen stack that nobody here wrote: durand (MIT licence), with our plant behind it.

SDO server, NMT, SYNC, PDOs and the drive's heartbeat are durand's. It has no heartbeat consumer, no state machine of
drives and no modes: those are here, written from CiA 301 and 402, and share nothing with `sim_backend/devices/canopen`.
"""

import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Self

import can
from durand import Record, Variable, set_scheduler
from durand.datatypes import DatatypeEnum as Type
from durand.network import NetworkABC
from durand.node import MinimalNode
from durand.scheduler import VirtualScheduler

from drivers.contract import Sample
from sim_backend.devices.axis import CURRENT, OFF, Axis, Demand
from sim_backend.devices.joint_tables import behind_a_drive

CST = 10
RATED_A = 1.0
DISABLED, READY, SWITCHED_ON, ENABLED, FAULT = 0x40, 0x21, 0x23, 0x27, 0x08  # of 0x6041
HOST_LOST = 0x8130
_TICK_S = 0.002
_OBJECTS = (
    (0x1001, Type.UNSIGNED8, "ro", 0),
    (0x603F, Type.UNSIGNED16, "ro", 0),
    (0x6040, Type.UNSIGNED16, "rw", 0),
    (0x6041, Type.UNSIGNED16, "ro", DISABLED),
    (0x6060, Type.INTEGER8, "rw", 0),
    (0x6061, Type.INTEGER8, "ro", 0),
    (0x6064, Type.INTEGER32, "ro", 0),
    (0x606C, Type.INTEGER32, "ro", 0),
    (0x6071, Type.INTEGER16, "rw", 0),
    (0x6075, Type.UNSIGNED32, "ro", round(1000 * RATED_A)),
    (0x6078, Type.INTEGER16, "ro", 0),
    (0x6079, Type.UNSIGNED32, "ro", 24_000),
    (0x6502, Type.UNSIGNED32, "ro", 1 << (CST - 1)),
)


class Network(NetworkABC):
    """durand's way to the bus, received from in the thread of the drive: nothing of it needs a lock."""

    def __init__(self, channel: str) -> None:
        self.bus = can.Bus(interface="virtual", channel=channel, ignore_config=True)
        self._subscriptions: dict[int, Callable[[int, bytes], None]] = {}

    def add_subscription(self, cob_id: int, callback: Callable[[int, bytes], None]) -> None:
        self._subscriptions[cob_id] = callback

    def remove_subscription(self, cob_id: int) -> None:
        self._subscriptions.pop(cob_id)

    def send(self, cob_id: int, msg: bytes) -> None:
        self.bus.send(can.Message(arbitration_id=cob_id, data=msg, is_extended_id=False))

    def receive(self, timeout_s: float) -> None:
        """Hand out what comes in for so long."""
        end_s = time.perf_counter() + timeout_s
        while (remaining_s := end_s - time.perf_counter()) > 0.0:
            message = self.bus.recv(remaining_s)
            if message is not None and not message.is_remote_frame and message.arbitration_id in self._subscriptions:
                self._subscriptions[message.arbitration_id](message.arbitration_id, bytes(message.data))


class DurandDrive:
    """The drive at work, on a virtual bus of this process.

    Args:
        channel: of the bus.
        node_id: of the drive.
    """

    def __init__(self, channel: str, node_id: int = 5) -> None:
        self._network = Network(channel)
        self._timers = VirtualScheduler()
        set_scheduler(self._timers)  # durand has one for all nodes of a process
        self.axis = Axis(behind_a_drive(), self)
        self.state = DISABLED
        self._word = 0
        self._heard_s: float | None = None
        self._watched_id = 0
        self._node = MinimalNode(self._network, node_id)
        self._fill()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._live, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._over.set()
        self._thread.join()
        self._network.bus.shutdown()

    def demand(self, _seen: Sample) -> Demand:
        """The current of the coming tick, as the axis asks for it."""
        if self.state != ENABLED:
            return OFF
        return Demand(CURRENT, self._get(0x6071) * 1e-3 * RATED_A)

    def _fill(self) -> None:
        """Add what durand's node does not bring itself."""
        book = self._node.object_dictionary
        book[0x1000] = Variable(Type.UNSIGNED32, "ro", 0x0002_0192)
        for index, kind, access, value in _OBJECTS:
            book[index] = Variable(kind, access, value)
        book[0x6007] = Variable(Type.INTEGER16, "rw", 1, minimum=1, maximum=1)  # a fault, and nothing else
        consumer = Record()
        consumer[1] = Variable(Type.UNSIGNED32, "rw", 0)
        book[0x1016] = consumer
        book.download_callbacks[0x1016, 1].add(self._watch)
        book.download_callbacks[0x6040, 0].add(self._obey)
        book.download_callbacks[0x6060, 0].add(lambda mode: self._put(0x6061, mode))

    def _get(self, index: int) -> int:
        return int(self._node.object_dictionary.read(index, 0))

    def _put(self, index: int, value: int) -> None:
        self._node.object_dictionary.write(index, 0, value)

    def _watch(self, entry: int) -> None:
        """0x1016:01 was written: node ID and time; the time counts from the first heartbeat."""
        if self._watched_id:
            self._network.remove_subscription(0x700 + self._watched_id)
        self._watched_id, self._heard_s = (entry >> 16 & 0x7F if entry & 0xFFFF else 0), None
        if self._watched_id:
            self._network.add_subscription(0x700 + self._watched_id, self._hear)

    def _hear(self, _cob_id: int, _data: bytes) -> None:
        self._heard_s = time.perf_counter()

    def _obey(self, word: int) -> None:
        """The controlword was written, by SDO or by RPDO (CiA 402-2, table of commands)."""
        before, self._word = self._word, word
        if self.state == FAULT:
            if word & 0x80 and not before & 0x80:
                self._put(0x603F, 0)
                self._go(DISABLED)
        elif not word & 0x02 or not word & 0x04:  # disable voltage; quick stop, here without a ramp
            self._go(DISABLED)
        elif word & 0x07 == 0x06:
            self._go(READY)
        elif word & 0x0F == 0x07 and self.state in (READY, ENABLED):
            self._go(SWITCHED_ON)
        elif word & 0x0F == 0x0F and self.state in (READY, SWITCHED_ON):
            self._go(ENABLED)

    def _go(self, state: int) -> None:
        self.state = state
        self._put(0x6041, state | (0x10 if state != FAULT else 0))

    def _live(self) -> None:
        began_s = last_s = time.perf_counter()
        while not self._over.is_set():
            self._network.receive(_TICK_S)
            now_s = time.perf_counter()
            self._timers.run(now_s - last_s)
            last_s = now_s
            self._look_for_host(now_s)
            self.axis.advance_to(now_s - began_s)
            self._put(0x6064, self.axis.counts())
            self._put(0x606C, round(self.axis.counts_per_s()))
            self._put(0x6078, round(1000 * (self.axis.applied.value if self.state == ENABLED else 0.0) / RATED_A))
            self._put(0x6079, round(1000 * self.axis.seen.supply_v))

    def _look_for_host(self, now_s: float) -> None:
        limit_s = (int(self._node.object_dictionary.read(0x1016, 1)) & 0xFFFF) * 1e-3
        if self._watched_id and self._heard_s is not None and now_s - self._heard_s > limit_s:
            self._heard_s = None
            if self.state in (SWITCHED_ON, ENABLED):
                self._put(0x603F, HOST_LOST)
                self._go(FAULT)
