"""`python -m tests.commission.draws N [SEED] [FIRST] [WAIT_S]`: commission N rigs drawn at random, say how each ended.

Every rig is a simulated device behind its real driver, in virtual time: RoboClaw, Modbus and CANopen in turn. Printed
are the time of the bench, the answers that were asked for, and the first load beside what hung there.
"""

import sys
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from math import isnan, nan, pi, radians
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.commission.virtual_time import TIME  # first: the drivers read its clock

# isort: split
from bench.commission.bench_file import write_bench
from bench.commission.bench_table import BenchTable
from bench.commission.evidence import Evidence
from bench.commission.flow import Commission
from bench.commission.motions import Motions
from bench.commission.questions import Question
from bench.config.configuration import read_configuration
from bench.control.recorder import Recorder
from bench.errors import BenchError
from bench.runs.runner import Runner
from bench.store import Store
from drivers.errors import DriveError
from sim_backend.devices.axis import TICK_S, Axis
from sim_backend.devices.canopen.drive import ServoDrive
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.devices.joint_tables import behind_a_drive, fault_by_name
from sim_backend.devices.modbus.own_drive import OwnDrive
from sim_backend.devices.roboclaw.device import MEASURED, RoboClaw
from tests.commission.rigs import DrawnRig, draw_rig
from tests.commission.wires import CanWire, SerialWire, VirtualWire, plugged_in, rtu_answer

ALLOWED_KG, ALLOWED_S, ALLOWED_ANSWERS = 2e-3, 900.0, 12
TRAVEL_RAD = radians(120.0)
Recorder.BLOCK_S = 1.0  # of virtual time: a transaction for every eight rows would take a third of it all
ANSWER_S = 15  # that a person takes to read, to do and to answer; it counts as time of the bench


class Owner:
    """Plays the person at the bench, by what was drawn of him."""

    def __init__(self, rig: DrawnRig, wire: VirtualWire, wait_s: int) -> None:
        self._rig, self._wire, self._wait_s, self.answers = rig, wire, wait_s, 0

    @property
    def _axis(self) -> Axis:
        TIME.advance(2.0 * TICK_S)  # a power stage that was told to be off takes a tick
        self._wire.catch_up()
        axis: Axis = self._wire.device.axis
        return axis

    def _take_time(self) -> None:
        self.answers += 1
        TIME.advance(self._wait_s)

    def number(self, question: Question) -> float | None:
        self._take_time()
        if question.key == "hand_angle_deg":
            self._axis.hold_arm(pi / 2.0 + self._rig.seen_rad)
        if question.key == "first_load_kg":
            self._axis.hang_load(self._rig.first_kg, balanced=False)
            return self._rig.first_kg
        return self._rig.answers[question.key]

    def done(self, key: str, sentence: str) -> bool:
        self._take_time()
        if key == "down":
            self._axis.hold_arm(self._rig.down_rad)
        elif key == "clear":
            self._axis.hang_load(0.0, balanced=False)
            self._axis.hold_arm(self._rig.down_rad)
            self._axis.release_arm()
        else:
            words = sentence.split()
            load_kg = float(words[1]) / 1000.0 if words[0] == "Hang" else 0.0
            self._axis.hang_load(load_kg, "balanced," in words)
        return True


@dataclass(frozen=True)
class Ending:
    """How a commissioning ended.

    Attributes:
        rig: that was drawn.
        refusal: why it did not get through; "" where it did.
        bench_s: time of the bench.
        answers: that were asked for.
        first_kg, found_kg: what hung there as a trial, and what was found.
        evidence: findings up to the end.
        took_s: of the computer.
    """

    rig: DrawnRig
    refusal: str
    bench_s: float
    answers: int
    first_kg: float
    found_kg: float
    evidence: Evidence
    took_s: float

    @property
    def is_right(self) -> bool:
        """The load within 2 g on a sound rig, or a refusal that names what is wrong on one that is not."""
        if self.bench_s > ALLOWED_S or self.answers > ALLOWED_ANSWERS:
            return False
        if self.refusal:
            return names(self.rig.fault, self.refusal)
        return not self.rig.fault and abs(self.found_kg - self.first_kg) <= ALLOWED_KG


NAMED = {
    "encoder unplugged": ("encoder", "count"),
    "motor unplugged": ("motor connected", "motor"),
    "angle misjudged": ("turned by the angle",),
}


def names(fault: str, refusal: str) -> bool:
    """Whether a refusal names the fault that is there."""
    return any(word in refusal for word in NAMED.get(fault, ()))


def made(rig: DrawnRig) -> tuple[VirtualWire, Any, dict[str, Any]]:
    """The device of a rig on its wire: the wire, its port, and the section of the drive."""
    tables = {name: dict(table) for name, table in rig.tables.items()}
    if rig.fault == "motor unplugged":  # no torque whatever flows
        tables["motor"] |= {"torque_constant_n_m_a": 1e-9, "resistance_ohm": 1e9}
    if rig.wire == "roboclaw":
        wire = VirtualWire(RoboClaw(behind_a_drive("paper", MEASURED, tables)))
        return wire, SerialWire(wire, wire.device.receive), {"kind": "roboclaw", "port": "virtual"}
    if rig.wire == "modbus":
        wire = VirtualWire(OwnDrive(behind_a_drive("paper", None, tables)))
        return wire, SerialWire(wire, rtu_answer(wire.device)), {
            "kind": "modbus", "map": "friction-bench", "transport": "rtu", "port": "virtual",
        }  # fmt: skip
    wire = VirtualWire(ServoDrive(behind_a_drive("paper", None, tables), GENERIC, 5))
    return wire, CanWire(wire), {"kind": "canopen", "interface": "slcan", "channel": "virtual", "node_id": 5}


@contextmanager
def store() -> Iterator[tuple[Store, Path]]:
    """A store in a folder of its own."""
    with (
        TemporaryDirectory(prefix="friction-bench-") as folder,
        Store.open(f"sqlite:///{folder}/trials.sqlite") as opened,
    ):
        yield opened, Path(folder)


def commission(rig: DrawnRig, wait_s: int = ANSWER_S) -> Ending:
    """Commission a rig; its owner answers after some seconds, and the rest of `ANSWER_S` only counts."""
    wire, port, drive = made(rig)
    if rig.fault == "encoder unplugged":
        wire.device.axis.meet(fault_by_name("encoder-stuck", 0.0, duration_s=1e9))
    owner, evidence, began = Owner(rig, wire, wait_s), Evidence(), datetime.now()
    refusal, first_kg, found_kg, start_s = "", nan, nan, TIME.now()
    table = BenchTable("drawn", drive, TRAVEL_RAD)
    with plugged_in(port), store() as (trials, folder), closing(Runner(table.looking(), trials)) as runner:
        motions = Motions(runner, trials, partial(owner.done, "hang"))
        try:
            ended = Commission(table, owner, motions, evidence).run()
            first_kg, found_kg = rig.first_kg, ended.found_kg
            write_bench(folder / "bench.toml", ended.bench, evidence)
            read_configuration(folder / "bench.toml")
        except (BenchError, DriveError) as error:
            refusal = str(error)
    took_s = (datetime.now() - began).total_seconds()
    bench_s = TIME.now() - start_s + owner.answers * (ANSWER_S - wait_s)
    return Ending(rig, refusal, bench_s, owner.answers, first_kg, found_kg, evidence, took_s)


def main(count: int, seed: int, first: int = 0, wait_s: int = ANSWER_S) -> int:
    """Commission so many rigs; returns how many did not end as they should."""
    endings = []
    print(f"{'rig':>3} {'wire':8} {'bench':>6} {'answers':>7} {'hung':>7} {'found':>7}  fault, and the refusal")
    for number in range(first, first + count):
        ending = commission(draw_rig(number, seed), wait_s)
        endings.append(ending)
        found = "" if isnan(ending.found_kg) else f"{1e3 * ending.found_kg:.1f} g"
        hung = f"{1e3 * ending.rig.first_kg:.1f} g"
        mark = "" if ending.is_right else "WRONG "
        print(
            f"{number:3} {ending.rig.wire:8} {ending.bench_s:4.0f} s {ending.answers:7} {hung:>7} {found:>7}  "
            f"{mark}{ending.rig.fault}{': ' if ending.rig.fault else ''}{ending.refusal}",
            flush=True,
        )
    right = sum(one.is_right for one in endings)
    slowest_s, most = max(one.bench_s for one in endings), max(one.answers for one in endings)
    print(f"{right} of {count} end with the load within 2 g, or with a refusal that names what is wrong")
    print(f"bench time at most {slowest_s:.0f} s of {ALLOWED_S:.0f}; answers at most {most} of {ALLOWED_ANSWERS}")
    return count - right


if __name__ == "__main__":
    sys.exit(min(main(*(int(word) for word in sys.argv[1:])), 1))
