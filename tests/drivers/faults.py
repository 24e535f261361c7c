"""What happens when something goes wrong on the bus of each kind of servo and actuator, and why. Not a test.

    python -m tests.drivers.faults [KIND ...]

The joint is pushed through the real driver and the bytes or frames of its protocol, in virtual time. Then the cable is
cut, bits are flipped (on a serial line) or frames lost (on a CAN bus, whose controllers throw away what is garbled),
the supply fails, or it gets too hot. Or the bench has the wrong id from the start, or there are two of one id. The last
column is what the bench says. The tests of the same, in real time, are in `tests/drivers/conformance`.
"""

from tests.drivers.virtual_devices import KINDS, TIME, device_of, reached  # first: the drivers read its clock

# isort: split
import random
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any, NamedTuple

from bench.control.drive_factory import make_equipment
from drivers.contract import Command, Drive, Mode, Status
from drivers.errors import DriveError
from sim_backend.devices.joint_tables import fault_by_name
from tests.commission.wires import CanWire, VirtualWire
from tests.drivers.hidden import on_bench

PERIOD_S = 0.01
BEFORE, AFTER = 30, 400  # cycles
LATER_S = 2.0  # longer than any watchdog here
BIT_FLIPPED, FRAME_LOST = 2e-3, 0.02  # of a byte; of a frame
PUSHES = {Mode.TORQUE: 0.015, Mode.CURRENT: 0.3, Mode.DUTY: 0.15}
WRONG_ID = {"odrive": "node_id", "damiao": "motor_id", "cubemars": "motor_id", "robstride": "motor_id"}
FAULTS = ("cut", "noise", "wrong id", "two of one id", "low voltage", "overheating")
OF_THE_DEVICE = {"low voltage": "supply-lost", "overheating": "over-temperature"}


STAYS_ON = "stays on"


class Line:
    """What the line does to what is on it."""

    def __init__(self) -> None:
        self.is_cut = self.is_noisy = False
        self._chance = random.Random(1)

    def passes(self) -> bool:
        """Whether a frame gets through."""
        return not self.is_cut and not (self.is_noisy and self._chance.random() < FRAME_LOST)

    def carried(self, data: bytes) -> bytes:
        """What comes of bytes."""
        if self.is_cut:
            return b""
        return bytes(byte ^ self._flip() for byte in data) if self.is_noisy else data

    def _flip(self) -> int:
        return 1 << self._chance.randrange(8) if self._chance.random() < BIT_FLIPPED else 0


class FaultyCan(CanWire):
    """A CAN bus on which frames get lost."""

    def __init__(self, wire: VirtualWire, line: Line) -> None:
        super().__init__(wire)
        self._line = line

    def send(self, message: Any, timeout_s: float | None = None) -> None:
        if self._line.passes():
            super().send(message, timeout_s)

    def recv(self, timeout_s: float | None = None) -> Any:
        message = super().recv(timeout_s)
        return message if message is None or self._line.passes() else None


class Met(NamedTuple):
    """What a fault led to.

    Attributes:
        motor: what became of it.
        reason: what the bench says.
    """

    motor: str
    reason: str


def met(kind: str, fault: str) -> Met:
    """Let it happen."""
    device, section = device_of(kind, {}, 2 if fault == "two of one id" else 1)
    if fault == "wrong id":
        section = section | {WRONG_ID.get(kind, "servo_id"): 33}
    wire, line = VirtualWire(device), Line()
    drive = make_equipment(on_bench({"kind": kind, **section})).drive

    def answer(data: bytes, now_s: float) -> bytes:
        return line.carried(device.receive(line.carried(data), now_s))

    def happen() -> None:
        line.is_cut, line.is_noisy = fault == "cut", fault == "noise"
        if fault in OF_THE_DEVICE:
            device.axis.meet(fault_by_name(OF_THE_DEVICE[fault], device.axis.time_s))

    with reached(wire, section, lambda one: FaultyCan(one, line), answer):
        reason, at_s = _pushed(drive, happen, wire)
        drive.close()
        TIME.advance(LATER_S)
        wire.catch_up()
    return Met(_motor(device, at_s, reason, drive.describe().watchdog_s), reason or "-")


def _pushed(drive: Drive, happen: Callable[[], None], wire: VirtualWire) -> tuple[str, float | None]:
    """Push; what the bench says, and when the fault happened in the device's time [s], None: it never moved."""
    at_s = None
    with suppress(DriveError):
        try:
            drive.open(PERIOD_S)
            mode = next(one for one in PUSHES if one in drive.describe().modes)
            drive.enable(mode)
            for cycle in range(BEFORE + AFTER):
                if cycle == BEFORE:
                    happen()
                    at_s = wire.catch_up()
                TIME.advance(PERIOD_S)
                # to and fro: it stays within its range
                push = PUSHES[mode] if cycle // 20 % 2 == 0 else -PUSHES[mode]
                if drive.exchange(Command(mode, push)).status is Status.FAULT:
                    drive.exchange(Command(mode, push))  # says which
        except DriveError as error:
            return str(error), at_s
    return "", at_s


def _motor(device: Any, at_s: float | None, reason: str, watchdog_s: float | None) -> str:
    if device.axis.power.on:
        return f"{STAYS_ON}: {'it has no watchdog' if watchdog_s is None else 'WRONG'}"
    if at_s is None:
        return "never on"
    if not reason:
        return "goes on; off when closed"
    after_s = device.axis.power.since_s - at_s
    by = ", by its watchdog" if device.report().get("watchdog_trips") else ""
    return f"off after {max(after_s, 0.0):.2f} s{by}"


def report(kinds: list[str]) -> bool:
    """Print a row for each kind and fault; whether none drives on unless it has no watchdog."""
    sound = True
    for kind in kinds:
        print(f"{kind}")
        for fault in FAULTS:
            found = met(kind, fault)
            sound = sound and not found.motor.endswith("WRONG")
            print(f"  {fault:<15}{found.motor:<38}{found.reason}", flush=True)
    return sound


if __name__ == "__main__":
    sys.exit(0 if report(sys.argv[1:] or list(KINDS)) else 1)
