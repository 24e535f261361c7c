"""An actuator whose torque is its feed-forward term, and what its gains make of position and speed."""

from abc import ABC, abstractmethod
from threading import RLock
from typing import NamedTuple

from drivers.contract import Sample
from sim_backend.devices.axis import CURRENT, OFF, Axis, Demand, Device
from sim_backend.devices.can.frame import Frame, QuietNode
from sim_backend.faults.script import Trip
from sim_backend.plant.parameters import PlantParameters


class Command(NamedTuple):
    """What it is told: of its output [rad, rad/s, N m/rad, N m s/rad, N m]."""

    position_rad: float = 0.0
    speed_rad_s: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0
    torque_n_m: float = 0.0


class MitMotor(Device, ABC):
    """An actuator whose output is the motor's side of the joint.

    Args:
        parameters: the joint.
        torque_limit_n_m: largest torque that it gives.
        seed: of the plant.

    Attributes:
        watchdog_trips: how often silence has stopped it.
    """

    def __init__(self, parameters: PlantParameters, torque_limit_n_m: float, seed: int = 0) -> None:
        self.axis = Axis(parameters, self, seed)
        self.lock = RLock()
        self.node = QuietNode()
        self.is_on = False
        self.command = Command()
        self.watchdog_trips = 0
        self._heard_s = 0.0
        self._ratio = parameters.gear.ratio
        self._torque_constant_n_m_a = parameters.motor.torque_constant_n_m_a
        self._limit_n_m = torque_limit_n_m

    @property
    @abstractmethod
    def timeout_s(self) -> float:
        """Silence after which it stops [s]; 0: it never does."""

    @abstractmethod
    def take(self, frame: Frame) -> bool:
        """Obey a frame, and answer it; tell whether it was for this actuator."""

    @abstractmethod
    def trip(self, cause: Trip | None) -> None:
        """Note what has switched it off; None: a hand has cut its supply."""

    @abstractmethod
    def lost(self) -> None:
        """Note that nobody has talked to it for too long."""

    # what the threads around it call ------------------------------------------------------------------

    def receive(self, frame: Frame, time_s: float) -> None:  # noqa: ARG002
        """Take a frame from the bus."""
        if not frame.remote and len(frame.data) == 8 and self.take(frame):
            self._heard_s = self.axis.time_s

    @abstractmethod
    def report(self) -> dict[str, object]:
        """Say what the actuator is about."""

    # the real-time half ----------------------------------------------------------------------------------

    def demand(self, seen: Sample) -> Demand:
        """Return what the stage does for the coming tick."""
        cause = self.axis.trip()
        if cause is not None or self.axis.torque_is_disabled():
            self.is_on = False
            self.trip(cause)
        if self.is_on and self.timeout_s and self.axis.time_s - self._heard_s > self.timeout_s:
            self.is_on = False
            self.watchdog_trips += 1
            self.lost()
        if not self.is_on:
            return OFF
        told = self.command
        torque = told.torque_n_m
        torque += told.stiffness * (told.position_rad - seen.position_rad * self._ratio)
        torque += told.damping * (told.speed_rad_s - seen.velocity_rad_s * self._ratio)
        torque = max(-self._limit_n_m, min(self._limit_n_m, torque))
        return Demand(CURRENT, torque / self._torque_constant_n_m_a)

    # what its sensors say ----------------------------------------------------------------------------------

    @property
    def position_rad(self) -> float:
        """Of its output [rad]."""
        return self.axis.seen.position_rad * self._ratio

    @property
    def speed_rad_s(self) -> float:
        """Of its output [rad/s]."""
        return self.axis.seen.velocity_rad_s * self._ratio

    @property
    def torque_n_m(self) -> float:
        """By its current sensor [N m]; 0 without one."""
        return self.axis.current_a * self._torque_constant_n_m_a


def number(word: int, bits: int, low: float, high: float) -> float:
    """Return the value of a word over a range."""
    return low + word * (high - low) / ((1 << bits) - 1)


def word_of(value: float, bits: int, low: float, high: float) -> int:
    """Return the word of a value over a range."""
    return round((max(low, min(high, value)) - low) * ((1 << bits) - 1) / (high - low))
