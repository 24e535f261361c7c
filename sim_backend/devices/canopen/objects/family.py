"""A family of drives: which objects it has, and what their numbers mean."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import pi

from sim_backend.devices.canopen.objects.entry import Object
from sim_backend.plant.parameters import PlantParameters

Place = tuple[int, int]


@dataclass(frozen=True)
class Rating:
    """The motor as the drive was set up for it."""

    current_a: float
    peak_a: float
    torque_constant_n_m_a: float
    counts_per_turn: float

    @classmethod
    def of(cls, parameters: PlantParameters) -> "Rating":
        """Return the rating of a plant's motor and stage."""
        overload, motor = parameters.overload, parameters.motor
        return cls(
            overload.continuous_a, overload.peak_a, motor.torque_constant_n_m_a, parameters.encoder.counts_per_turn
        )

    @property
    def torque_n_m(self) -> float:
        """Rated torque [N m]."""
        return self.current_a * self.torque_constant_n_m_a


def increment(counts_per_turn: float) -> float:
    """Return the motor angle of one increment of the encoder [rad], the speed of one a second [rad/s], and so on."""
    return 2.0 * pi / counts_per_turn


@dataclass(frozen=True)
class Family:
    """What distinguishes drives.

    Attributes:
        name: as the command line has it.
        device_name: 0x1008.
        modes: numbers of 0x6060 that it has.
        velocity_rad_s: motor speed of one unit of velocity [rad/s], for the encoder's counts per turn.
        position_rad: motor angle of one unit of position [rad], for the encoder's counts per turn.
        acceleration_rad_s2: motor acceleration of one unit of acceleration [rad/s2], for the encoder's counts per turn.
        torque_unit_n_m: torque of one unit of 0x6076 [N m].
        peak: where the largest current is, and what its unit is in A, for a rating.
        own_objects: objects beyond CiA 402 that tell something, of those that `Measured` knows.
        node_id: node number that it is configured for; None: any.
    """

    name: str
    device_name: str
    modes: frozenset[int]
    objects: Callable[[Rating], list[Object]]
    velocity_rad_s: Callable[[float], float]
    acceleration_rad_s2: Callable[[float], float]
    torque_unit_n_m: float
    peak: tuple[tuple[Place, Callable[[Rating], float]], ...]
    position_rad: Callable[[float], float] = increment
    own_objects: frozenset[Place] = frozenset()
    node_id: int | None = None


def mode_bits(modes: frozenset[int]) -> int:
    """Return 0x6502: mode n is bit n - 1."""
    return sum(1 << (mode - 1) for mode in modes)


def with_defaults(objects: list[Object], defaults: dict[int, int]) -> list[Object]:
    """Return objects, some of them with another default."""
    return [
        replace(one, entries=(replace(one.entries[0], default=defaults[one.index]),)) if one.index in defaults else one
        for one in objects
    ]


def rpm(_counts_per_turn: float) -> float:
    """Return the motor speed of 1 rpm [rad/s], or the acceleration of 1 rpm a second [rad/s2]."""
    return 2.0 * pi / 60.0
