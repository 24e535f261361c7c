"""What an experiment moves: one joint with its control loop, or a master and a slave with theirs."""

from collections.abc import Sequence
from typing import Any, Protocol

from bench.config.configuration import BenchConfiguration
from bench.control.clock import Clock
from bench.control.drive_factory import Ask, make_equipment
from bench.control.limits import Guard
from bench.control.loop import ControlLoop, Outcome, Reading
from bench.control.pair.equipment import make_pair
from bench.control.pair.joint import PairJoint
from bench.control.pair.loop import PairLoop
from bench.control.recorder import Sink
from bench.control.servo import check_modes, current_servo
from bench.control.stop_request import StopRequest
from bench.control.technician import PersonTechnician
from bench.control.timing import check_pair_timing, check_timing
from bench.experiments.kind import TrialPlan
from drivers.contract import Drive


class TrialLoop(Protocol):
    """Runs the trials of one station."""

    @property
    def channels(self) -> tuple[str, ...]:
        """Of the rows that it records."""

    @property
    def last_reading(self) -> Reading | None:
        """Of the joint, or of the slave; None before the first."""

    def run(self, procedure: Any, sink: Sink, stop: StopRequest) -> Outcome:
        """Run one trial to its end; what it moves is off then."""


class Station(Protocol):
    """What stands there for one experiment."""

    @property
    def drives(self) -> Sequence[Drive]:
        """The joint's; or the slave's, and the master's."""

    @property
    def loop(self) -> TrialLoop:
        """Of what is open."""

    def open(self) -> None:
        """Connect; the power stays off.

        Raises:
            DriveError: a drive cannot be opened.
            ConfigurationError: one does not fit the configuration.
        """

    def assume(self, load_kg: float, balanced: bool) -> None:
        """What hangs there already: nobody is asked for it."""

    def prepare(self, plan: TrialPlan) -> None:
        """Put on the arm what a trial wants there, with the power off.

        Raises:
            ExperimentError: it is not there.
        """

    def close(self) -> None:
        """Power off and disconnect, whatever is open."""


class SingleStation:
    """One joint.

    Args:
        configuration: of the bench.
        clock: paces the loop.
        ask: asks the person at a real drive.
    """

    loop: ControlLoop  # once open

    def __init__(self, configuration: BenchConfiguration, clock: Clock, ask: Ask) -> None:
        drive, self._technician = make_equipment(configuration, ask)
        self.drives = (drive,)
        self._configuration, self._clock = configuration, clock

    def open(self) -> None:
        """Connect the drive, and make its loop."""
        configuration, (drive,) = self._configuration, self.drives
        _open(drive, configuration)
        check_modes(configuration.servo, drive.describe())
        self.loop = ControlLoop(
            drive, self._clock, Guard(configuration.limits), configuration.control.period_s,
            current_servo(configuration.rig),
        )  # fmt: skip

    def assume(self, load_kg: float, balanced: bool) -> None:
        """Ask no person for a load that hangs already."""
        if isinstance(self._technician, PersonTechnician):
            self._technician.assume(load_kg, balanced)

    def prepare(self, plan: TrialPlan) -> None:
        """Hang the load."""
        self._technician.hang_load(plan.load_kg, plan.balanced)

    def close(self) -> None:
        """Power off and disconnect."""
        self.drives[0].close()


class PairStation:
    """A master and a slave.

    Args:
        configuration: of the bench; with a master.
        clock: paces the loop.
        ask: asks the person at the drives.

    Raises:
        ConfigurationError: there is no master.
    """

    loop: PairLoop  # once open

    def __init__(self, configuration: BenchConfiguration, clock: Clock, ask: Ask) -> None:
        self._pair = make_pair(configuration, ask)
        self.drives = (self._pair.slave.drive, self._pair.master.drive)
        self._benches = (configuration, configuration.of_master())
        self._clock = clock

    def open(self) -> None:
        """Connect both drives, and make their loop."""
        for drive, bench in zip(self.drives, self._benches, strict=True):
            _open(drive, bench)
        check_modes(self._benches[0].servo, self.drives[0].describe())
        slave, master = (
            PairJoint(name, drive, Guard(bench.limits), current_servo(bench.rig))
            for name, drive, bench in zip(("slave", "master"), self.drives, self._benches, strict=True)
        )
        period_s = self._benches[0].control.period_s
        check_pair_timing([drive.describe() for drive in self.drives], period_s)
        self.loop = PairLoop(slave, master, self._clock, period_s, self._pair.truth, self._pair.operate)

    def assume(self, load_kg: float, balanced: bool) -> None:
        """Who works with two arms is asked each time."""

    def prepare(self, plan: TrialPlan) -> None:
        """Hang the slave's load, put its wall, and have the operator take hold of the master."""
        self._pair.prepare(plan.load_kg, plan.balanced, plan.wall_rad)

    def close(self) -> None:
        """Power off and disconnect both, whatever one of them says."""
        try:
            self.drives[0].close()
        finally:
            self.drives[1].close()


def make_station(configuration: BenchConfiguration, pair: bool, clock: Clock, ask: Ask) -> Station:
    """What an experiment moves, not yet open.

    Args:
        configuration: of the bench.
        pair: a master and a slave are wanted.
        clock: paces the loop.
        ask: asks the person at real drives.

    Raises:
        ConfigurationError: it cannot be made of this configuration.
    """
    return PairStation(configuration, clock, ask) if pair else SingleStation(configuration, clock, ask)


def _open(drive: Drive, configuration: BenchConfiguration) -> None:
    period_s = configuration.control.period_s
    drive.open(period_s)
    check_timing(drive.describe(), period_s)
