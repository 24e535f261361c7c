"""What the drive measures and demands, in the units of its objects."""

from collections.abc import Callable
from math import exp, pi

from drivers.contract import Sample
from sim_backend.devices.axis import TICK_S, Axis
from sim_backend.devices.canopen.dictionary import Dictionary, Place
from sim_backend.devices.canopen.objects.family import Family, Rating

_AVERAGED_OVER_S = 0.01
_SHARE = 1.0 - exp(-TICK_S / _AVERAGED_OVER_S)  # of the last tick in an average


class Measured:
    """Numbers of the axis as objects tell them."""

    def __init__(self, axis: Axis, dictionary: Dictionary, family: Family, rating: Rating) -> None:
        self._axis = axis
        self._dictionary = dictionary
        self._torque_unit_n_m = family.torque_unit_n_m
        self._constant_n_m_a = rating.torque_constant_n_m_a
        counts_per_rad = rating.counts_per_turn / (2.0 * pi)
        self._unit_counts_per_s = family.velocity_rad_s(rating.counts_per_turn) * counts_per_rad
        self._unit_counts_per_s2 = family.acceleration_rad_s2(rating.counts_per_turn) * counts_per_rad
        self._unit_counts = family.position_rad(rating.counts_per_turn) * counts_per_rad
        self._own = family.own_objects
        self._current_a = 0.0  # averaged
        self._counts_per_s = 0.0  # averaged
        self.demand_a = 0.0

    def tick(self) -> None:
        """Average over the last tick."""
        self._current_a += _SHARE * (self._axis.current_a - self._current_a)
        self._counts_per_s += _SHARE * (self._axis.counts_per_s() - self._counts_per_s)

    def counts_per_s(self, velocity: float) -> float:
        """Return the speed of a number in the drive's unit of velocity."""
        return velocity * self._unit_counts_per_s

    def counts_per_s2(self, acceleration: float) -> float:
        """Return the acceleration of a number in the drive's unit of acceleration."""
        return acceleration * self._unit_counts_per_s2

    def counts(self, position: float) -> float:
        """Return the encoder's counts of a number in the drive's unit of position."""
        return position * self._unit_counts

    def position(self, counts: float) -> int:
        """Return counts of the encoder in the drive's unit of position."""
        return round(counts / self._unit_counts)

    def current_of_torque(self, permille: float) -> float:
        """Return the current [A] that makes a torque in permille of the rated."""
        return permille * 1e-3 * self._rated_n_m() / self._constant_n_m_a

    def torque_of_current(self, current_a: float) -> float:
        """Return the torque in permille of the rated that a current makes."""
        return current_a * self._constant_n_m_a / self._rated_n_m() * 1e3

    def live(self) -> dict[Place, Callable[[], int]]:
        """Return how each object comes by its value; standard ones that a family has not do no harm."""
        axis = self._axis

        def seen() -> Sample:
            return axis.seen

        own = {
            (0x2001, 0): lambda: round(seen().duty * 1e3),
            (0x2002, 0): lambda: round(self._axis.temperature_c * 10.0),
            (0x2200, 1): lambda: round(seen().supply_v * 10.0),
            (0x30D0, 0): lambda: round(self.demand_a * 1e3),
            (0x30D1, 1): lambda: round(self._current_a * 1e3),
            (0x30D1, 2): lambda: round(self._axis.current_a * 1e3),
            (0x30D2, 1): lambda: round(self.torque_of_current(self._current_a)),
            (0x30D3, 1): lambda: self._velocity(self._counts_per_s),
            (0x3201, 1): lambda: round(self._axis.temperature_c * 10.0),
            (0x3203, 1): lambda: round(abs(seen().duty) * 1e3),
        }
        standard = {
            (0x6064, 0): lambda: self.position(axis.counts()),
            (0x606C, 0): lambda: self._velocity(axis.counts_per_s()),
            (0x6074, 0): lambda: round(self.torque_of_current(self.demand_a)),
            (0x6077, 0): lambda: round(self.torque_of_current(self._axis.current_a)),
            (0x6078, 0): lambda: round(self._axis.current_a * 1e6 / max(self._dictionary.number(0x6075), 1)),
            (0x6079, 0): lambda: round(seen().supply_v * 1e3),
        }
        return standard | {place: source for place, source in own.items() if place in self._own}

    def _velocity(self, counts_per_s: float) -> int:
        return round(counts_per_s / self._unit_counts_per_s)

    def _rated_n_m(self) -> float:
        return max(self._dictionary.number(0x6076), 1) * self._torque_unit_n_m
