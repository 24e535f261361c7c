"""The node: NMT states, and who is asked when a frame comes (CiA 301)."""

from collections.abc import Callable
from enum import IntEnum

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.canopen.conduct import GOOD, Conduct
from sim_backend.devices.canopen.dictionary import COMMUNICATION, Dictionary
from sim_backend.devices.canopen.emergency import Emergency, ErrorCode
from sim_backend.devices.canopen.guarding import Deadline, LifeGuard
from sim_backend.devices.canopen.heartbeat import HeartbeatConsumer, HeartbeatProducer
from sim_backend.devices.canopen.objects.communication import MOST_PDOS
from sim_backend.devices.canopen.receive_pdo import ReceivePdo, Taken
from sim_backend.devices.canopen.sdo_server import SdoServer
from sim_backend.devices.canopen.transmit_pdo import TransmitPdo

NMT, HEARTBEATS = 0x000, range(0x701, 0x780)
_ALL_NODES = 0
_TAKEN_BADLY = {Taken.TOO_SHORT: ErrorCode.PDO_TOO_SHORT, Taken.TOO_LONG: ErrorCode.PDO_TOO_LONG}


class NmtState(IntEnum):
    """As a heartbeat tells it."""

    BOOT_UP = 0
    STOPPED = 4
    OPERATIONAL = 5
    PRE_OPERATIONAL = 127


class NmtCommand(IntEnum):
    """First byte of an NMT message."""

    START = 1
    STOP = 2
    PRE_OPERATIONAL = 128
    RESET_NODE = 129
    RESET_COMMUNICATION = 130


_TARGETS = {
    NmtCommand.START: NmtState.OPERATIONAL,
    NmtCommand.STOP: NmtState.STOPPED,
    NmtCommand.PRE_OPERATIONAL: NmtState.PRE_OPERATIONAL,
}


class Node:
    """A CANopen slave.

    Attributes:
        send: takes the frames that go out; set by whoever has the bus.
        on_reset: called after an application reset.
        on_lost: called when the master is gone, with the error that says how: its heartbeat or its requests stay away,
            an RPDO comes too late, or NMT has stopped or reset the node.
    """

    def __init__(self, dictionary: Dictionary, conduct: Conduct = GOOD) -> None:
        self.dictionary = dictionary
        self._conduct = conduct
        self.node_id = dictionary.node_id
        self.send: Callable[[Frame], None] = lambda _frame: None
        self.on_reset: Callable[[], None] = lambda: None
        self.on_lost: Callable[[ErrorCode], None] = lambda _code: None
        self.state = NmtState.BOOT_UP
        self.losses = 0
        self._sdo = SdoServer(dictionary)
        received, sent = ([n for n in range(MOST_PDOS) if base + n in dictionary.objects] for base in (0x1400, 0x1800))
        self._rpdos = [ReceivePdo(dictionary, number) for number in received]
        self._tpdos = [TransmitPdo(dictionary, number) for number in sent]
        self._producer = HeartbeatProducer(dictionary)
        self._consumer = HeartbeatConsumer(dictionary, conduct.deaf)
        self._guard = LifeGuard(dictionary, conduct.deaf)
        self._deadlines = [Deadline(dictionary, 0x1400 + number, conduct.deaf) for number in received]
        self._late_answers: list[tuple[float, Frame]] = []
        self._emergency = Emergency(dictionary)

    def boot(self) -> None:
        """Begin life on the bus: one boot-up message, then pre-operational."""
        self.send(Frame(0x700 + self.node_id, bytes([NmtState.BOOT_UP])))
        self.state = NmtState.PRE_OPERATIONAL

    def receive(self, frame: Frame, time_s: float) -> None:
        """Take a frame from the bus."""
        if frame.extended:
            return
        if frame.remote:
            self._answer_guard(frame.can_id, time_s)
            return
        can_id, data = frame.can_id, frame.data
        if can_id == self.dictionary.number(0x1005) & 0x7FF:
            self._sync(time_s)
        elif can_id == NMT:
            self._obey(data)
        elif can_id == 0x600 + self.node_id:
            self._serve(data, time_s)
        elif can_id in HEARTBEATS and data:
            self._hear(can_id - 0x700, time_s)
        elif self.state is NmtState.OPERATIONAL:
            self._receive_pdo(can_id, data, time_s)

    def poll(self, time_s: float) -> None:
        """Do what time asks for."""
        if self._producer.is_due(time_s):
            self.send(Frame(0x700 + self.node_id, bytes([self.state])))
        while self._late_answers and self._late_answers[0][0] <= time_s:
            self.send(self._late_answers.pop(0)[1])
        if self._consumer.loses(time_s) or self._guard.loses(time_s):
            self._lose(ErrorCode.HEARTBEAT)
        if self.state is NmtState.OPERATIONAL:
            late = [deadline for deadline in self._deadlines if deadline.passes(time_s)]  # each is asked
            if late:
                self._lose(ErrorCode.RPDO_TIMEOUT)
            for tpdo in self._tpdos:
                self._send(tpdo.poll(time_s))

    def raise_error(self, code: ErrorCode) -> None:
        """Note an error and tell of it, once while it is there."""
        self._send_emergency(self._emergency.raise_error(code))

    def clear_errors(self) -> None:
        """Take back what is over; a master that is missing still is."""
        missing = self._consumer.has_lost or self._guard.has_lost
        gone = [code for code in ErrorCode if code is not ErrorCode.HEARTBEAT or not missing]
        self._send_emergency(self._emergency.clear(*gone))

    # the inside -----------------------------------------------------------------------------------------

    def _obey(self, data: bytes) -> None:
        if len(data) != 2 or data[1] not in (_ALL_NODES, self.node_id):
            return
        if data[0] == NmtCommand.RESET_NODE:
            self._reset(range(0x10000))
        elif data[0] == NmtCommand.RESET_COMMUNICATION:
            self._reset(COMMUNICATION)
        elif data[0] in _TARGETS:
            self._go(_TARGETS[NmtCommand(data[0])])

    def _go(self, state: NmtState) -> None:
        if state is self.state:
            return
        self.state = state
        self._renew()
        if state is NmtState.STOPPED:
            self.on_lost(ErrorCode.HEARTBEAT)

    def _reset(self, indices: range) -> None:
        self.on_lost(ErrorCode.HEARTBEAT)
        self.dictionary.reset(indices)
        self._sdo.reset()
        self._late_answers.clear()
        self._consumer.reset()
        self._guard.reset()
        self._emergency.reset()
        self._renew()
        if 0x6040 in indices:
            self.on_reset()
        self.boot()

    def _renew(self) -> None:
        for rpdo in self._rpdos:
            rpdo.renew()
        for tpdo in self._tpdos:
            tpdo.renew()
        for deadline in self._deadlines:
            deadline.reset()

    def _serve(self, data: bytes, time_s: float) -> None:
        if self.state in (NmtState.PRE_OPERATIONAL, NmtState.OPERATIONAL):
            answer = self._sdo.answer(data)
            if answer is None:
                return
            frame = Frame(0x580 + self.node_id, answer)
            if self._conduct.answer_s:
                self._late_answers.append((time_s + self._conduct.answer_s, frame))
            else:
                self.send(frame)

    def _answer_guard(self, can_id: int, time_s: float) -> None:
        # a node that produces heartbeats does not guard
        if can_id != 0x700 + self.node_id or self.dictionary.number(0x1017):
            return
        data, was_lost = self._guard.answer(self.state, time_s)
        self.send(Frame(can_id, data))
        if was_lost:
            self._send_emergency(self._emergency.clear(ErrorCode.HEARTBEAT))

    def _sync(self, time_s: float) -> None:
        if self.state is not NmtState.OPERATIONAL:
            return
        for rpdo in self._rpdos:
            rpdo.sync()
        for tpdo in self._tpdos:
            self._send(tpdo.sync(time_s))

    def _receive_pdo(self, can_id: int, data: bytes, time_s: float) -> None:
        for rpdo, deadline in zip(self._rpdos, self._deadlines, strict=True):
            if rpdo.can_id == can_id:
                deadline.hear(time_s)
                taken = rpdo.receive(data)
                if taken in _TAKEN_BADLY:
                    self._send_emergency(self._emergency.tell(_TAKEN_BADLY[taken]))

    def _hear(self, node_id: int, time_s: float) -> None:
        if self._consumer.hear(node_id, time_s):
            self._send_emergency(self._emergency.clear(ErrorCode.HEARTBEAT))

    def _lose(self, code: ErrorCode) -> None:
        self.losses += 1
        if code is ErrorCode.HEARTBEAT:
            self.raise_error(code)  # it stays until the host is heard again
        else:
            self._send_emergency(self._emergency.tell(code))
        # 0x1029:01: pre-operational, no change, stopped; the last two only from operational
        behavior = self.dictionary.number(0x1029, 1)
        if behavior == 2:
            self.state = NmtState.STOPPED
        elif behavior == 0 and self.state is NmtState.OPERATIONAL:
            self.state = NmtState.PRE_OPERATIONAL
        self.on_lost(code)

    def _send(self, frame: Frame | None) -> None:
        if frame is not None:
            self.send(frame)

    def _send_emergency(self, data: bytes | None) -> None:
        if data is not None and self.state is not NmtState.STOPPED:
            self.send(Frame(self.dictionary.number(0x1014) & 0x7FF, data))
