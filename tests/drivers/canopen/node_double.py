"""A CiA 402 node small enough to be checked by eye, written in bytes: it shares nothing with the driver.

It lives on a virtual bus in a thread of its own. Its joint is a mass without friction: torque changes speed.
"""

import struct
import threading
import time

import can

ABSENT, READ_ONLY = 0x06020000, 0x06010002
EPOS_LIKE = {(0x1018, 1): ("<I", 0xFB)}


class NodeDouble:
    """A drive at node 5. `objects` may be changed before use; the flags make it fail."""

    def __init__(self, channel: str, node_id: int = 5, interface: str = "virtual", **bus: object) -> None:
        self.bus = can.Bus(interface=interface, channel=channel, ignore_config=True, **bus)
        self.node_id = node_id
        self.objects: dict[tuple[int, int], list] = {
            key: list(value)
            for key, value in {
                (0x1000, 0): ("<I", 0x00020192), (0x1005, 0): ("<I", 0x80),
                (0x1008, 0): (None, b"Simulated servo drive"), (0x100A, 0): (None, b"1.2.3"), (0x1016, 1): ("<I", 0),
                (0x1017, 0): ("<H", 0), (0x1018, 1): ("<I", 0x12345), (0x1018, 2): ("<I", 0x77),
                (0x1018, 3): ("<I", 1), (0x1018, 4): ("<I", 0xBEEF), (0x1029, 1): ("<B", 0), (0x6007, 0): ("<h", 1),
                (0x603F, 0): ("<H", 0), (0x6040, 0): ("<H", 0), (0x6041, 0): ("<H", 0x0240), (0x605A, 0): ("<h", 6),
                (0x6060, 0): ("<b", 0), (0x6061, 0): ("<b", 0), (0x6064, 0): ("<i", 1000), (0x606C, 0): ("<i", 0),
                (0x6071, 0): ("<h", 0), (0x6073, 0): ("<H", 3000), (0x6075, 0): ("<I", 2000), (0x6077, 0): ("<h", 0),
                (0x6078, 0): ("<h", 0), (0x6079, 0): ("<I", 24050), (0x607A, 0): ("<i", 0),
                (0x6085, 0): ("<I", 60_000), (0x60A9, 0): ("<I", 0x00B44700), (0x60AA, 0): ("<I", 0x00C00300),
                (0x60B2, 0): ("<h", 0), (0x60C2, 1): ("<B", 1), (0x60C2, 2): ("<b", -3),
                (0x6502, 0): ("<I", 1 << 0 | 1 << 7 | 1 << 9),
            }.items()
        }  # fmt: skip
        for number in range(4):
            for base in (0x1400, 0x1800):
                self.objects[(base + number, 1)] = ["<I", 0x80000000 | 0x80 + number]
                self.objects[(base + number, 2)] = ["<B", 255]
            for base in (0x1600, 0x1A00):
                for sub in range(5):
                    self.objects[(base + number, sub)] = ["<I" if sub else "<B", 0]
        self.absent: set[tuple[int, int]] = set()
        self.read_only: set[tuple[int, int]] = set()
        self.stuck: set[tuple[int, int]] = set()  # written without effect
        self.sent: list[tuple[int, bytes]] = []
        self.received: list[tuple[int, bytes]] = []
        self.syncs = 0
        self.silent = self.mute_heartbeat = self.refuse_mode = False
        self.drop_answers = 0
        self.delay_s = 0.0
        self.nmt = 0x7F
        self.off_at_s: float | None = None
        self.supports_1029 = True
        self._heard_host_s: float | None = None
        self._beat_s = 0.0
        self._pending: dict[int, bytes] = {}
        self._edge = False
        self._text = b""
        self._running = True
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> "NodeDouble":
        self._thread.start()
        return self

    def __exit__(self, *_exc: object) -> None:
        self._running = False
        self._thread.join()
        self.bus.shutdown()

    # what a test looks at --------------------------------------------------------------------------

    def get(self, index: int, sub: int = 0) -> int:
        return self.objects[(index, sub)][1]

    def put(self, index: int, sub: int, value: int) -> None:
        self.objects[(index, sub)][1] = value

    @property
    def enabled(self) -> bool:
        return self.get(0x6041) & 0x6F == 0x27

    def fail(self, code: int) -> None:
        """Trip: FAULT, error code, EMCY."""
        self.put(0x603F, 0, code)
        self._become(0x0208)
        self._send(0x80 + self.node_id, struct.pack("<HB5x", code, 0x21))

    def restart(self) -> None:
        self.nmt = 0x7F
        self._become(0x0240)
        self._send(0x700 + self.node_id, b"\0")

    @property
    def _host_heartbeat(self) -> int:
        """COB-ID of the heartbeat that it watches."""
        return 0x700 + (self.get(0x1016, 1) >> 16 & 0x7F)

    # the inside ----------------------------------------------------------------------------------------

    def _send(self, cob: int, data: bytes) -> None:
        if not self.silent:
            self.sent.append((cob, data))
            self.bus.send(can.Message(arbitration_id=cob, data=data, is_extended_id=False))

    def _become(self, statusword: int) -> None:
        if self.enabled and statusword & 0x6F != 0x27:
            self.off_at_s = time.perf_counter()
        self.put(0x6041, 0, statusword)

    def _run(self) -> None:
        while self._running:
            message = self.bus.recv(0.002)
            if message is not None and not self.silent:
                self.received.append((message.arbitration_id, bytes(message.data)))
                self._take(message.arbitration_id, bytes(message.data))
            elif message is not None and message.arbitration_id == self._host_heartbeat:
                self._heard_host_s = time.perf_counter()
            self._watch()

    def _watch(self) -> None:
        now = time.perf_counter()
        if self.get(0x1017) and now - self._beat_s >= self.get(0x1017) / 1000 and not self.mute_heartbeat:
            self._beat_s = now
            self._send(0x700 + self.node_id, bytes([self.nmt]))
        limit_s = (self.get(0x1016, 1) & 0xFFFF) / 1000
        if limit_s and self._heard_host_s is not None and now - self._heard_host_s > limit_s:
            self._heard_host_s = None
            self.fail(0x8130)
            if not self.get(0x1029, 1):
                self.nmt = 0x7F

    def _take(self, cob: int, data: bytes) -> None:
        if cob == 0 and data[1] in (0, self.node_id):
            self.nmt = {1: 5, 2: 4, 0x80: 0x7F}.get(data[0], self.nmt)
            self._beat_s = 0.0
        elif cob == 0x600 + self.node_id:
            self._sdo(data)
        elif cob == self._host_heartbeat:
            self._heard_host_s = time.perf_counter()
        elif cob == 0x80 and self.nmt == 5:
            self._sync()
        elif self.nmt == 5:
            for number in range(4):
                if self.get(0x1400 + number, 1) == cob:
                    self._pending[number] = data

    def _sdo(self, data: bytes) -> None:
        command, index, sub = struct.unpack_from("<BHB", data)
        key, head = (index, sub), struct.pack("<HB", index, sub)
        entry = None if key in self.absent else self.objects.get(key)
        if command & 0xE0 == 0x60:
            toggle, part, self._text = command & 0x10, self._text[:7], self._text[7:]
            last = 0 if self._text else 1
            return self._answer(bytes([toggle | (7 - len(part)) << 1 | last]) + part.ljust(7, b"\0"))
        if command == 0x80:
            return None
        if entry is None:
            return self._answer(b"\x80" + head + struct.pack("<I", ABSENT))
        if command == 0x40:
            return self._upload(entry, head)
        if key in self.read_only:
            return self._answer(b"\x80" + head + struct.pack("<I", READ_ONLY))
        if key not in self.stuck:
            entry[1] = struct.unpack_from(entry[0], data, 4)[0]
        self._written(key)
        return self._answer(b"\x60" + head + bytes(4))

    def _upload(self, entry: list, head: bytes) -> None:
        if entry[0] is None:
            self._text = entry[1]
            return self._answer(b"\x41" + head + struct.pack("<I", len(entry[1])))
        value = struct.pack(entry[0], entry[1])
        return self._answer(bytes([0x43 | (4 - len(value)) << 2]) + head + value.ljust(4, b"\0"))

    def _answer(self, data: bytes) -> None:
        self._send(0x580 + self.node_id, data)

    def _written(self, key: tuple[int, int]) -> None:
        if key == (0x1016, 1):
            self._heard_host_s = None  # it counts from the first heartbeat after this
        if key == (0x6060, 0) and not self.refuse_mode:
            self.put(0x6061, 0, self.get(0x6060))
        if key == (0x6040, 0):
            self._control()

    def _control(self) -> None:
        word, status = self.get(0x6040), self.get(0x6041)
        reset = bool(word & 0x80) and not self._edge
        self._edge = bool(word & 0x80)
        if status & 0x4F == 0x08:
            if reset:
                self.put(0x603F, 0, 0)
                self._become(0x0240)
        elif word & 0x82 == 0x00:
            self._become(0x0240)
        elif word & 0x86 == 0x02:
            self._become(0x0217 if status & 0x6F == 0x27 else status)
        elif word & 0x8F == 0x06:
            self._become(0x0231)
        elif word & 0x8F == 0x07 and status & 0x6F in (0x21, 0x23):
            self._become(0x0233)
        elif word & 0x8F == 0x0F and status & 0x6F in (0x23, 0x27):
            self._become(0x0237 | (0x1000 if word & 0x10 and self.get(0x6061) == 1 else 0))

    def _sync(self) -> None:
        self.syncs += 1
        answers = [self._tpdo(number) for number in range(4) if not self.get(0x1800 + number, 1) & 0x80000000]
        for number, data in self._pending.items():
            self._rpdo(number, data)
        self._pending.clear()
        self._move()
        if self.drop_answers:
            self.drop_answers -= 1
            return
        if self.delay_s:
            time.sleep(self.delay_s)
        for cob, data in answers:
            self._send(cob, data)

    def _mapped(self, index: int) -> list[tuple[int, int]]:
        words = [self.get(index, sub) for sub in range(1, self.get(index) + 1)]
        return [(word >> 16, word >> 8 & 0xFF) for word in words]

    def _tpdo(self, number: int) -> tuple[int, bytes]:
        data = b"".join(struct.pack(*self.objects[key]) for key in self._mapped(0x1A00 + number))
        return self.get(0x1800 + number, 1) & 0x7FF, data

    def _rpdo(self, number: int, data: bytes) -> None:
        for key in self._mapped(0x1600 + number):
            form = self.objects[key][0]
            self.objects[key][1] = struct.unpack_from(form, data)[0]
            data = data[struct.calcsize(form) :]
            self._written(key)

    def _move(self) -> None:
        if self.get(0x6041) & 0x6F == 0x07:  # brakes to rest at once, then off
            self.put(0x606C, 0, 0)
            self._become(0x0240 if self.get(0x605A) == 2 else 0x0217)
        if self.enabled and self.get(0x6061) == 10:
            torque = self.get(0x6071)
            self.put(0x6077, 0, torque)
            self.put(0x6078, 0, torque)
            self.put(0x606C, 0, self.get(0x606C) + torque // 10)
        elif self.enabled:
            self.put(0x6064, 0, self.get(0x607A))
            self.put(0x6077, 0, self.get(0x60B2))
        else:
            self.put(0x606C, 0, 0)
            self.put(0x6078, 0, 0)
        self.put(0x6064, 0, self.get(0x6064) + self.get(0x606C))
