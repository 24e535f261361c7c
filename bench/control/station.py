"""What an experiment moves: one joint or a master and a slave, their drives, their loop, and who hangs the load."""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from typing import Any

from bench.config.configuration import BenchConfiguration
from bench.control.clock import Clock
from bench.control.drive_factory import Ask, make_equipment
from bench.control.joint import ControlledJoint
from bench.control.joint_group import JointGroup, SingleJoint
from bench.control.limits import Guard
from bench.control.loop import ControlLoop
from bench.control.pairs.pair import JointPair
from bench.control.pairs.pair_equipment import make_pair
from bench.control.power.brake import brake_of
from bench.control.servo import check_modes, current_servo, torque_constant_n_m_a
from bench.control.technician import PersonTechnician, Technician
from bench.control.timing import check_pair_timing, check_timing
from drivers.contract import Drive


@dataclass(frozen=True)
class Station:
    """What stands there for one experiment.

    Attributes:
        drives: the joint's; or the slave's, and the master's. Not yet open.
        benches: of each drive, the joint as a bench of its own; the first one's period and servo count.
        names: of each joint, as messages say it; "" where there is one only.
        group: makes the loop's joints of those, in the order of `drives`.
        prepare: puts on the arm what a trial wants there, with the power off: load_kg, balanced, wall_rad. Raises
            `ExperimentError` where it is not there.
        assume: tells what hangs there already (load_kg, balanced): nobody is asked for it.
    """

    drives: tuple[Drive, ...]
    benches: tuple[BenchConfiguration, ...]
    names: tuple[str, ...]
    group: Callable[..., JointGroup[Any, Any]]
    clock: Clock
    prepare: Callable[[float, bool, float | None], None]
    assume: Callable[[float, bool], None]

    def open(self) -> ControlLoop[Any, Any]:
        """Connect every drive, the power stays off; the loop.

        Raises:
            DriveError: a drive cannot be opened.
            ConfigurationError: one does not fit the configuration.
        """
        period_s = self.benches[0].control.period_s
        for drive in self.drives:
            drive.open(period_s)
            check_timing(drive.describe(), period_s)
        check_pair_timing([drive.describe() for drive in self.drives], period_s)
        check_modes(self.benches[0].servo, self.drives[0].describe())
        joints = [
            ControlledJoint(
                drive,
                Guard(bench.limits),
                current_servo(bench.rig),
                name,
                torque_constant_n_m_a(bench.rig),
                brake_of(bench, drive),
            )
            for drive, bench, name in zip(self.drives, self.benches, self.names, strict=True)
        ]
        return ControlLoop(self.group(*joints), self.clock, period_s)

    def close(self) -> None:
        """Power off and disconnect every drive, whatever one of them says."""
        with ExitStack() as closing:
            for drive in reversed(self.drives):
                closing.callback(drive.close)


def make_station(configuration: BenchConfiguration, pair: bool, clock: Clock, ask: Ask) -> Station:
    """What an experiment moves, not yet open.

    Raises:
        ConfigurationError: it cannot be made of this configuration.
    """
    if pair:
        return _pair_station(configuration, clock, ask)
    drive, technician = make_equipment(configuration, ask)
    prepare, assume = _hanger(technician), _assumer(technician)
    return Station((drive,), (configuration,), ("",), SingleJoint, clock, prepare, assume)


def _pair_station(configuration: BenchConfiguration, clock: Clock, ask: Ask) -> Station:
    made = make_pair(configuration, ask)
    return Station(
        drives=(made.slave.drive, made.master.drive),
        benches=(configuration, configuration.of_master()),
        names=("slave", "master"),
        group=partial(JointPair, truth=made.truth, operate=made.operate),
        clock=clock,
        prepare=made.prepare,
        assume=lambda *_hung: None,  # who works with two arms is asked each time
    )


def _hanger(technician: Technician) -> Callable[[float, bool, float | None], None]:
    def prepare(load_kg: float, balanced: bool, _wall_rad: float | None) -> None:
        technician.hang_load(load_kg, balanced)

    return prepare


def _assumer(technician: Technician) -> Callable[[float, bool], None]:
    """Only a person is asked for a load."""
    return technician.assume if isinstance(technician, PersonTechnician) else lambda *_hung: None
