"""A slave that follows its master while its load is reflected: the parts that a teleoperation is composed of."""

from collections.abc import Generator
from dataclasses import dataclass
from math import ceil, nan
from typing import Literal, NamedTuple, TypeVar

from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import torque_n_m_a
from bench.control.cycle import OFF, Action, PairAction, PairReading, Reach
from bench.experiments.parts.joint import Joint, Part
from bench.experiments.parts.load_follower import LoadFollower
from compensator.reflection.reflection import Following, Reflection
from drivers.contract import Command, Mode

Way = Literal["compensated", "raw", "none"]
Result = TypeVar("Result")
PairPart = Generator[PairAction, PairReading, Result]

MARGIN_RAD = 0.1  # of the slave's set points to its limits
HELD = Action(OFF)


@dataclass(frozen=True, slots=True)
class Conveyed:
    """One cycle of teleoperation.

    Attributes:
        reflected_n_m: what the master's motor was asked to make of the load when this cycle began.
    """

    reading: PairReading
    reflected_n_m: float


def reflection_of(configuration: BenchConfiguration, force_scale: float, about_n_m: float = 0.0) -> Reflection:
    """The law of reflection, as bench.toml has it.

    Raises:
        ConfigurationError: there is no master.
    """
    settings = configuration.require_master().reflection
    return Reflection(
        force_scale=force_scale,
        torque_n_m=settings.torque_n_m,
        slew_n_m_s=settings.slew_n_m_s,
        damping_n_m_s_rad=settings.damping_n_m_s_rad,
        period_s=configuration.control.period_s,
        about_n_m=about_n_m,
    )


class Coupling(NamedTuple):
    """How the two are coupled.

    Attributes:
        force_scale, motion_scale: torque of the master per torque of the slave; way of the slave per way of the master.
    """

    way: Way
    force_scale: float
    motion_scale: float


class PairJoints:
    """Parts of a procedure that move both joints.

    Args:
        configuration: of the bench; with a master and friction curves.

    Raises:
        ConfigurationError: there is no master, or something that is needed is not known.
    """

    def __init__(self, configuration: BenchConfiguration, coupling: Coupling) -> None:
        self._configuration = configuration
        self._coupling = coupling
        self._joint = Joint(configuration)
        self._follower = LoadFollower(configuration)
        self._slave_n_m_a = torque_n_m_a(configuration.rig)
        master = configuration.of_master()
        self._master_n_m_a, self._master_limit_a = torque_n_m_a(master.rig), master.limits.current_a
        self._law = reflection_of(configuration, coupling.force_scale)
        self._reflected_n_m = 0.0
        self._reading: PairReading | None = None
        self._following: Following | None = None
        self._set_point_rad = nan

    def begin(self) -> PairPart[str]:
        """As `LoadFollower` does, with the slave; the hand holds the master, which is off."""
        return (yield from self._alone(self._follower.begin(self._joint)))

    def couple(self) -> None:
        """From here on the slave follows the master's way, and its load is reflected."""
        reading, limits = self._last(), self._configuration.limits
        self._set_point_rad = self._joint.reading.sample.position_rad
        self._following = Following(
            master_rad=reading.master.sample.position_rad,
            slave_rad=self._set_point_rad,
            scale=self._coupling.motion_scale,
            low_rad=limits.position_min_rad + MARGIN_RAD,
            high_rad=limits.position_max_rad - MARGIN_RAD,
            speed_rad_s=limits.speed_rad_s,
            period_s=self._configuration.control.period_s,
        )

    def convey(
        self,
        seconds: float,
        reach: Reach | None = None,
        force_scale: float | None = None,
        about_n_m: float = 0.0,
    ) -> PairPart[list[Conveyed]]:
        """Teleoperate for a while.

        Args:
            seconds: how long.
            reach: what the operator does from now on.
            force_scale: another than the coupling's.
            about_n_m: load of which only the changes are scaled by that.
        """
        law = self._law if force_scale is None else reflection_of(self._configuration, force_scale, about_n_m)
        conveyed = []
        for _ in range(ceil(seconds / self._configuration.control.period_s)):
            conveyed.append((yield from self._convey_cycle(law, reach)))
            reach = None
        return conveyed

    def end(self) -> PairPart[None]:
        """The master off, the slave back to angle 0, where it may be left without power."""
        yield from self._alone(self._joint.rest_at(0.0))

    def _convey_cycle(self, law: Reflection, reach: Reach | None) -> PairPart[Conveyed]:
        master = self._last().master
        self._reflected_n_m = law.reflected_n_m(self._reflected_n_m, self._load_n_m())
        motor_n_m = law.motor_n_m(self._reflected_n_m, master.velocity_rad_s)
        current_a = min(max(motor_n_m / self._master_n_m_a, -self._master_limit_a), self._master_limit_a)
        followed = self._coupled().set_point(self._set_point_rad, master.sample.position_rad, master.velocity_rad_s)
        self._set_point_rad = followed.position_rad
        given = self._follower.estimate
        step = self._joint.step(*followed, given.load_current_a, given.half_width_a)
        reading = yield from self._beside(step, Action(Command(Mode.CURRENT, current_a)), reach, self._reflected_n_m)
        self._follower.observe(reading, followed.position_rad)
        return Conveyed(self._last(), self._reflected_n_m)

    def _load_n_m(self) -> float:
        """What is to be reflected [N m], as the coupling says."""
        if self._coupling.way == "compensated":
            return self._follower.estimate.load_current_a * self._slave_n_m_a
        return self._last().slave.current_a * self._slave_n_m_a if self._coupling.way == "raw" else 0.0

    def _alone(self, part: Part[Result]) -> PairPart[Result]:
        """A part of the slave's, while the master is off."""
        return (yield from self._beside(part, HELD))

    def _beside(
        self, part: Part[Result], master: Action, reach: Reach | None = None, reflected_n_m: float = nan
    ) -> PairPart[Result]:
        """A part of the slave's, while the master does something."""
        try:
            slave = next(part)
            while True:
                self._reading = yield PairAction(slave, master, reflected_n_m, reach)
                slave = part.send(self._reading.slave)
        except StopIteration as end:
            result: Result = end.value
            return result

    def _last(self) -> PairReading:
        if self._reading is None:
            raise RuntimeError("a pair is coupled before its first reading; begin with begin()")
        return self._reading

    def _coupled(self) -> Following:
        if self._following is None:
            raise RuntimeError("the load is conveyed before the pair is coupled; call couple()")
        return self._following
