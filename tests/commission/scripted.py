"""A commissioning of which nothing moves: it asks as the real one does, and finds what stands here."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

from bench.commission import guide
from bench.commission.bench_table import BenchTable
from bench.commission.drive_section import bench_of
from bench.commission.evidence import Evidence
from bench.commission.flow import Commissioned
from bench.commission.motions import Motions
from bench.commission.questions import FIRST_LOAD, HAND_ANGLE, Person, ask_all, need
from bench.config.configuration import default_configuration
from compensator.line_fit import Interval
from tests.service.running_service import RunningService, running_service

NOWHERE = {"kind": "roboclaw", "port": "nowhere"}


class Scripted:
    """In place of `bench.commission.flow.Commission`."""

    def __init__(
        self, _table: BenchTable, person: Person, motions: Motions, evidence: Evidence, on_step: Callable[[str], None]
    ) -> None:
        self._person, self._motions, self._evidence, self._on_step = person, motions, evidence, on_step

    def run(self) -> Commissioned:
        add = self._evidence.add_interval
        self._evidence.add("drive", "USB Roboclaw 2x15a v4.2.4", "", "what the drive says of itself")
        self._on_step("know")
        known = ask_all(self._person, frozenset({"current_a", "supply_v"}), closes_current=False)
        self._on_step("scale")
        self._person.done("down", "Take every load off, and let the arm hang straight down. Nothing is powered yet.")
        angle_deg = need(self._person, HAND_ANGLE)
        how = f"the arm turned by hand to {angle_deg:g} degrees"
        add("counts of a joint turn", Interval(40000.0, 38700.0, 41400.0), "", how)
        self._on_step("push")
        self._person.done("clear", "Let the arm hang straight down again, free to turn, and stand clear.")
        add("resistance_ohm", Interval(0.61, 0.58, 0.64), "ohm", "pushes of the unloaded joint")
        self._on_step("first-load")
        first_kg = need(self._person, FIRST_LOAD)
        return Commissioned(default_configuration(), known, first_kg, first_kg + 3e-4)


@contextmanager
def scripted_service(folder: Path) -> Iterator[RunningService]:
    """A service on a drive that is not there; nothing is asked of it."""
    with patch.object(guide, "Commission", Scripted), running_service(folder, configuration=bench_of(NOWHERE)) as found:
        yield found
