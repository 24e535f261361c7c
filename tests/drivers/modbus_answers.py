"""A drive on Modbus TCP in a few lines, for tests of the driver: registers in two dicts, frames taken apart by hand."""

import socketserver
import threading
from struct import pack, unpack

MAP = """
name = "test drive"
source = "this file"
read_write = true

[identity]
vendor = "tests"
product = "registers"
firmware = "firmware"
family = {register = "family", is = 0x4242}

[control]
register = "control"
off = 0
duty = 1
current = 1
position = 1
quick_stop = 2
clear_fault = 8

[mode]
register = "mode"
duty = 1
current = 2
position = 3

[demand]
duty = "duty_demand"
current_a = "current_demand"
position_counts = "position_demand"

[measured]
position_counts = "position"
velocity_counts_s = "velocity"
duty = "duty"
current_a = "current"
supply_v = "supply"
temperature_c = "temperature"

[status]
register = "status"
mask = 0x0F
enabled = 1
quick_stop = 2
fault = 4

[fault]
register = "fault"
[fault.names]
0x2310 = "over-current"

[watchdog]
register = "watchdog"
fault = 0x8130

[[register]]
name = "control"
space = "holding"
address = 10
type = "uint16"
[[register]]
name = "mode"
space = "holding"
address = 11
type = "uint16"
[[register]]
name = "duty_demand"
space = "holding"
address = 12
type = "int16"
scale = 1e-4
[[register]]
name = "current_demand"
space = "holding"
address = 13
type = "int16"
scale = 1e-3
unit = "A"
[[register]]
name = "position_demand"
space = "holding"
address = 14
type = "int32"
unit = "counts"
[[register]]
name = "status"
space = "holding"
address = 20
type = "uint16"
[[register]]
name = "fault"
space = "holding"
address = 21
type = "uint16"
[[register]]
name = "position"
space = "holding"
address = 22
type = "int32"
unit = "counts"
[[register]]
name = "velocity"
space = "holding"
address = 24
type = "float32"
low_word_first = true
unit = "counts/s"
[[register]]
name = "duty"
space = "holding"
address = 26
type = "int16"
scale = 1e-4
[[register]]
name = "current"
space = "holding"
address = 27
type = "int16"
scale = 1e-3
unit = "A"
[[register]]
name = "supply"
space = "input"
address = 5
type = "uint16"
scale = 0.1
unit = "V"
[[register]]
name = "temperature"
space = "input"
address = 6
type = "int16"
scale = 0.1
offset = -40.0
unit = "degC"
[[register]]
name = "watchdog"
space = "holding"
address = 100
type = "uint16"
scale = 1e-3
unit = "s"
[[register]]
name = "family"
space = "input"
address = 0
type = "uint16"
[[register]]
name = "firmware"
space = "input"
address = 1
type = "uint16"
scale = 0.01
"""


class Answers(socketserver.ThreadingTCPServer):
    """Unit 1 on a free port of this machine. `obeys` makes the status word follow the control word."""

    allow_reuse_address = True
    daemon_threads = True
    block_on_close = False

    def __init__(self):
        super().__init__(("127.0.0.1", 0), _Request)
        self.input = {0: 0x4242, 1: 207, 5: 240, 6: 650}
        self.holding = dict.fromkeys([*range(10, 16), *range(20, 28), 100], 0)
        self.coils = {0: 0, 1: 0}
        self.discrete = {8: 0, 9: 0, 10: 0}
        self.unknown = frozenset()  # functions that this drive does not have
        self.sent = []  # PDUs
        self.obeys = True
        self.silent = False
        self.corrupt = 0
        self.slips_at = {}  # what a register reads back too much, by address
        threading.Thread(target=self.serve_forever, args=(0.02,), daemon=True).start()

    @property
    def port(self):
        return str(self.socket.getsockname()[1])

    def answer(self, pdu):
        self.sent.append(pdu)
        function = pdu[0]
        if function in self.unknown:
            return bytes([function | 0x80, 1])
        try:
            if function in (1, 2, 5, 15):
                return self._answer_bits(function, pdu)
            if function == 4:
                return self._words(self.input, function, *unpack(">HH", pdu[1:5]))
            if function == 3:
                return self._words(self.holding, function, *unpack(">HH", pdu[1:5]))
            if function == 6:
                self._store(*unpack(">H", pdu[1:3]), [unpack(">H", pdu[3:5])[0]])
                return pdu
            if function == 16:
                address, count = unpack(">HH", pdu[1:5])
                self._store(address, unpack(f">{count}H", pdu[6:]))
                return pdu[:5]
            if function == 23:
                read_at, read_count, address, count = unpack(">HHHH", pdu[1:9])
                self._store(address, unpack(f">{count}H", pdu[10:]))
                return self._words(self.holding, function, read_at, read_count)
        except KeyError:
            return bytes([function | 0x80, 2])
        return bytes([function | 0x80, 1])

    def _words(self, table, function, address, count):
        words = [table[place] for place in range(address, address + count)]
        if table is self.holding:
            words[0] += self.slips_at.get(address, 0)
        return pack(f">BB{count}H", function, 2 * count, *words)

    def _answer_bits(self, function, pdu):
        address, count = unpack(">HH", pdu[1:5])
        if function in (1, 2):
            return self._bits(self.coils if function == 1 else self.discrete, function, address, count)
        if function == 5:
            self._switch(address, [count == 0xFF00])
            return pdu
        self._switch(address, [pdu[6] >> place & 1 for place in range(count)])
        return pdu[:5]

    def _bits(self, table, function, address, count):
        packed = sum(table[place] << at for at, place in enumerate(range(address, address + count)))
        return bytes([function, (count + 7) // 8]) + packed.to_bytes((count + 7) // 8, "little")

    def _switch(self, address, bits):
        for place, bit in enumerate(bits, address):
            if place not in self.coils:
                raise KeyError(place)
            self.coils[place] = int(bit)
        self.discrete[8] = self.coils[0]  # it says that it is on

    def _store(self, address, words):
        for place, word in enumerate(words, address):
            if place not in self.holding:
                raise KeyError(place)
            self.holding[place] = word
        if self.obeys and self.holding[20] != 4:
            self.holding[20] = self.holding[10] & 3


class _Request(socketserver.StreamRequestHandler):
    def handle(self):
        while len(head := self.rfile.read(7)) == 7:
            transaction, protocol, length, unit = unpack(">HHHB", head)
            pdu = self.rfile.read(length - 1)
            if self.server.silent or unit != 1:
                continue
            answer = self.server.answer(pdu)
            if self.server.corrupt:
                self.server.corrupt -= 1
                protocol = 0x5A5A  # no Modbus: the client has to drop it
            self.wfile.write(pack(">HHHB", transaction, protocol, len(answer) + 1, unit) + answer)
