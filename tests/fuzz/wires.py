"""`python -m tests.fuzz.wires COUNT [KIND ...]`: hostile bytes on the wire of each kind of drive, in virtual time.

Each driver is opened, enabled, moved, stopped and closed while its device's answers are spoilt: bits, lengths, ids,
numbers, some with their checksums put right. It answers each call, or raises a `DriveError`; afterwards it opens again,
and the power is off. Then the device gets as many spoilt questions: it goes on, and answers a sound one.
"""

from tests.commission.virtual_time import TIME  # first: the drivers read its clock

# isort: split
import sys
import traceback
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from random import Random
from typing import Any
from unittest import mock

import can

from bench.control.drive_factory import make_equipment
from drivers.contract import Command, Drive, Mode
from drivers.errors import DriveError
from sim_backend.devices.can.frame import Frame
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.roboclaw.device import MEASURED, RoboClaw
from tests.commission.wires import CanWire, SerialWire, VirtualWire, plugged_in
from tests.drivers.hidden import on_bench
from tests.drivers.virtual_devices import KINDS as ACTUATORS
from tests.drivers.virtual_devices import USB_BYTE_S, device_of
from tests.fuzz.edits import spoilt_by
from tests.fuzz.seals import SEALS
from tests.queue.over_wires import WIRES, wired

KINDS = ("roboclaw", *WIRES, *ACTUATORS)
PERIOD_S, LONGEST_WATCHDOG_S = 0.005, 2.0
CALLS = 25  # between opening and closing
GARBAGE = (Command(Mode.OFF), *(Command(mode, value) for mode in Mode for value in (0.0, 0.01, -0.01)))


class Spoiler:
    """What happens on the way.

    Args:
        kind: of the drive.
        chance: what is drawn.
    """

    def __init__(self, kind: str, chance: Random) -> None:
        self._seal, self._chance = SEALS.get(kind), chance
        self.share = 0.0
        self.count = 0

    @property
    def strikes(self) -> bool:
        """Whether something happens to this one."""
        struck = self._chance.random() < self.share
        self.count += struck
        return struck

    def data(self, question: bytes, data: bytes) -> bytes:
        """Spoilt bytes; half of them with a checksum that is right."""
        found = spoilt_by(self._chance, data)
        return self._seal(question, found) if self._seal and self._chance.random() < 0.5 else found

    def frame(self, frame: Frame) -> Frame:
        """A spoilt frame: its data, its identifier, or what kind of frame it is."""
        chance, most = self._chance, 64 if frame.fd else 8
        draw = chance.random()
        if draw < 0.7:
            return frame._replace(data=spoilt_by(chance, frame.data)[:most])
        if draw < 0.9:
            return frame._replace(can_id=frame.can_id ^ 1 << chance.randrange(29 if frame.extended else 11))
        return frame._replace(remote=not frame.remote, data=b"")


class HostileSerial(SerialWire):
    """A line that spoils answers."""

    def __init__(self, wire: VirtualWire, answer: Any, spoiler: Spoiler) -> None:
        def hostile(data: bytes, now_s: float) -> bytes:
            if len(self.heard) < 2000:
                self.heard.append(data)
            reply = answer(data, now_s)
            return spoiler.data(data, reply) if spoiler.strikes else reply

        super().__init__(wire, hostile)
        self.heard: list[bytes] = []


class HostileCan(CanWire):
    """A bus that spoils answers."""

    def __init__(self, wire: VirtualWire, spoiler: Spoiler) -> None:
        super().__init__(wire)
        self._spoiler, self.heard = spoiler, list[Frame]()

    def send(self, message: can.Message, timeout_s: float | None = None) -> None:
        if len(self.heard) < 2000:
            self.heard.append(
                Frame(message.arbitration_id, bytes(message.data), message.is_remote_frame, message.is_extended_id)
            )
        super().send(message, timeout_s)

    def recv(self, timeout_s: float | None = None) -> can.Message | None:
        message = super().recv(timeout_s)
        if message is None or not self._spoiler.strikes:
            return message
        sound = Frame(message.arbitration_id, bytes(message.data), message.is_remote_frame, message.is_extended_id)
        frame = self._spoiler.frame(sound)
        return can.Message(
            arbitration_id=frame.can_id, data=frame.data, is_remote_frame=frame.remote,
            is_extended_id=frame.extended, is_rx=True, timestamp=TIME.now(),
        )  # fmt: skip


@contextmanager
def hostile_wire(kind: str, spoiler: Spoiler) -> Iterator[tuple[VirtualWire, Any, Drive]]:
    """A device, its port and its driver, not yet open."""
    answer: Any = None
    if kind == "roboclaw":
        wire = VirtualWire(RoboClaw(behind_a_drive("paper", MEASURED, {})))
        section: dict[str, Any] = {"port": "virtual"}
    elif kind in WIRES:
        wire, plain, section = wired(kind)
        answer = getattr(plain, "_answer", None)
    else:
        device, section = device_of(kind, {})
        wire = VirtualWire(device)
    is_on_can = "interface" in section
    answer = answer or (None if is_on_can else wire.device.receive)
    port: Any = HostileCan(wire, spoiler) if is_on_can else HostileSerial(wire, answer, spoiler)
    with ExitStack() as stack:
        stack.enter_context(plugged_in(port))
        stack.enter_context(mock.patch("tests.commission.wires._BYTE_S", USB_BYTE_S))
        if is_on_can:
            stack.enter_context(mock.patch("drivers.can_bus.port.open_bus", return_value=port))
        yield wire, port, make_equipment(on_bench({"kind": kind} | section), lambda _sentence: True).drive


def call(drive: Drive, chance: Random) -> None:
    """One call of the contract."""
    draw = chance.random()
    if draw < 0.6:
        drive.exchange(chance.choice(GARBAGE))
    elif draw < 0.8:
        drive.enable(chance.choice(list(Mode)))
    else:
        chance.choice((drive.disable, drive.quick_stop, drive.clear_fault, drive.inspect, drive.describe))()
    TIME.advance(PERIOD_S)


def attack_driver(drive: Drive, spoiler: Spoiler, count: int, chance: Random) -> None:
    """Open it and call it until so many answers were spoilt."""
    while spoiler.count < count:
        spoiler.share = chance.choice((0.0, 0.02, 0.3))
        with suppress(DriveError):
            drive.open(PERIOD_S)
        spoiler.share = 0.2
        for _ in range(CALLS):
            with suppress(DriveError):
                call(drive, chance)
        drive.close()
    spoiler.share = 0.0


def is_well(wire: VirtualWire, drive: Drive) -> bool:
    """Whether it opens and answers afterwards, with the power off."""
    TIME.advance(LONGEST_WATCHDOG_S)
    drive.open(PERIOD_S)
    drive.clear_fault()
    drive.exchange(Command(Mode.OFF))
    wire.catch_up()
    off = not wire.device.axis.power.on
    drive.close()
    return off


def attack_device(wire: VirtualWire, port: Any, spoiler: Spoiler, count: int, chance: Random) -> None:
    """Send it as many questions, each spoilt."""
    asked = list(port.heard)
    for _ in range(count):
        one = chance.choice(asked)
        now_s = wire.catch_up()
        if isinstance(one, Frame):
            wire.device.receive(spoiler.frame(one), now_s)
        elif hasattr(wire.device, "receive"):
            wire.device.receive(spoiler.data(b"", one), now_s)
        TIME.advance(1e-3)
    TIME.advance(1.0)  # half a packet is forgotten by then
    port.shutdown() if isinstance(port, HostileCan) else port.close()  # and nobody waits for the answers


def report(kind: str, count: int) -> bool:
    """Attack both ends of a wire, and print how that ended; whether all is as it should be."""
    chance = Random(f"{kind} {count}")
    spoiler = Spoiler(kind, chance)
    with hostile_wire(kind, spoiler) as (wire, port, drive):
        try:
            attack_driver(drive, spoiler, count, chance)
            well = is_well(wire, drive)
            attack_device(wire, port, spoiler, count, chance)
            drive.open(PERIOD_S)
            drive.close()
        except Exception:
            print(f"{kind:<10} {spoiler.count:7} answers spoilt, then NOT MET:\n{traceback.format_exc()}", flush=True)
            return False
    ending = "sound" if well else "NOT MET: the power is on"
    print(f"{kind:<10} {spoiler.count:7} answers and {count} questions spoilt: {ending}", flush=True)
    return well


if __name__ == "__main__":
    failed = [kind for kind in sys.argv[2:] or KINDS if not report(kind, int(sys.argv[1]))]
    sys.exit(f"not met: {', '.join(failed)}" if failed else 0)
