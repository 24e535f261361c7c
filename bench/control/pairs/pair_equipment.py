"""What stands on a bench of two joints: both drives, who hangs the load, and who holds the master."""

from collections.abc import Callable
from dataclasses import dataclass
from math import nan

from bench.config.configuration import BenchConfiguration
from bench.config.drives.kind import Environment, Hand
from bench.config.drives.registry import drive_kind
from bench.control.cycle import Reach, Truth
from bench.control.drive_factory import Ask, Equipment, make_equipment, nobody, share_lines
from bench.errors import ExperimentError
from drivers.contract import Drive

HOLD = (
    "Take hold of the master's arm, let it hang straight down, and keep it there. It will pull at your hand, and the "
    "slave will do what it does."
)


class PersonHand:
    """A person at a real master: is asked to take hold, and moves it as he likes.

    Args:
        ask: shows a sentence and returns True when it is done, False when the person gives up.
    """

    def __init__(self, ask: Ask) -> None:
        self._ask = ask

    def take_hold(self) -> None:
        """Ask for it.

        Raises:
            ExperimentError: the person gave up.
        """
        if not self._ask(HOLD):
            raise ExperimentError("nobody took hold of the master; start again when somebody can")

    def reach(self, angle_rad: float, duration_s: float) -> None:
        """A person is free."""

    def torque_n_m(self) -> float:
        """Not known."""
        return nan


class PersonEnvironment:
    """Round a real slave: a person puts a wall there, and takes it away.

    Args:
        ask: as of `PersonHand`.
    """

    def __init__(self, ask: Ask) -> None:
        self._ask = ask
        self._stands: float | None = None

    def put_wall(self, angle_rad: float | None) -> None:
        """Ask for it, where something has to change.

        Raises:
            ExperimentError: the person gave up.
        """
        if angle_rad == self._stands:
            return
        wanted = "Take the wall away from the slave." if angle_rad is None else _wall(angle_rad)
        if not self._ask(wanted):
            raise ExperimentError("the slave's wall is not as the trial wants it; start again when it can be")
        self._stands = angle_rad

    def interaction_n_m(self) -> float:
        """Not known."""
        return nan


@dataclass(frozen=True)
class PairEquipment:
    """Both joints, and who stands beside them."""

    slave: Equipment
    master: Equipment
    hand: Hand
    environment: Environment

    def prepare(self, load_kg: float, balanced: bool, wall_rad: float | None) -> None:
        """Before a trial, with the power off: the slave's wall and load, the operator's hand on the master.

        Raises:
            ExperimentError: something of it was not done.
        """
        self.environment.put_wall(None)
        self.slave.technician.hang_load(load_kg, balanced)
        if wall_rad is not None:
            self.environment.put_wall(wall_rad)
        self.hand.take_hold()

    def operate(self, reach: Reach) -> None:
        """What the operator does from now on."""
        self.hand.reach(*reach)

    def truth(self) -> Truth:
        """What acts on the arms now."""
        return Truth(self.environment.interaction_n_m(), self.hand.torque_n_m())


def make_pair(configuration: BenchConfiguration, ask: Callable[[str], bool] = nobody) -> PairEquipment:
    """Both drives, not yet open, and who stands beside them.

    Raises:
        ConfigurationError: the bench has no master, or a joint is impossible.
    """
    master_bench = configuration.of_master()
    slave, master = make_equipment(configuration, ask), make_equipment(master_bench, ask)
    share_lines([(configuration, slave.drive), (master_bench, master.drive)])
    hand, environment = PersonHand(ask), PersonEnvironment(ask)
    return PairEquipment(
        slave,
        master,
        _beside(master_bench, master.drive, (hand, environment))[0],
        _beside(configuration, slave.drive, (hand, environment))[1],
    )


def _beside(bench: BenchConfiguration, drive: Drive, persons: tuple[Hand, Environment]) -> tuple[Hand, Environment]:
    """Who stands beside an arm: software beside a simulated one, else a person."""
    beside_arm = drive_kind(bench.drive.kind).beside_arm
    return persons if beside_arm is None else beside_arm(drive)


def _wall(angle_rad: float) -> str:
    return f"Put a wall in the way of the slave's arm, at {angle_rad:.3g} rad from straight down, and stand clear."
