"""The drive's position controller."""

from dataclasses import dataclass
from math import pi

from sim_backend.devices.axis import TICK_S
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.mode import Seen
from sim_backend.plant.parameters import PlantParameters

_BANDWIDTH_RAD_S = 40.0
_DAMPING = 0.6
_INTEGRATION = 6.0  # times slower than the loop itself


@dataclass(frozen=True)
class Gains:
    """Of a PID controller, in permille of the rated torque."""

    proportional: float  # per count
    integral: float  # per count second
    derivative: float  # second per count

    @classmethod
    def tuned(cls, parameters: PlantParameters, rated_n_m: float) -> "Gains":
        """Return the gains that make the unloaded joint a second-order system of 40 rad/s, as auto-tuning would."""
        ratio = parameters.gear.ratio
        inertia = parameters.motor.rotor_inertia_kg_m2 + parameters.arm.inertia_kg_m2 / ratio**2
        permille_per_unit = inertia * 2.0 * pi / parameters.encoder.counts_per_turn / rated_n_m * 1000.0
        proportional = permille_per_unit * _BANDWIDTH_RAD_S**2
        return cls(
            proportional,
            proportional * _BANDWIDTH_RAD_S / _INTEGRATION,
            permille_per_unit * 2.0 * _DAMPING * _BANDWIDTH_RAD_S,
        )


class PositionLoop:
    """PID on the position, the derivative on the error of speed; the integral stops at the torque limit.

    Attributes:
        limit_permille: largest torque; set by the drive.
        applied_permille: torque of the last tick, whoever asked for it; set by the drive.
    """

    def __init__(self, gains: Gains) -> None:
        self._gains = gains
        self._integral = 0.0
        self.limit_permille = 0.0
        self.applied_permille = 0.0

    def start(self) -> None:
        """Begin with the torque that there is, so that a load does not drop."""
        self._integral = self.applied_permille

    def torque(self, counts: float, counts_per_s: float, seen: Seen) -> float:
        """Return the torque [permille] that takes the motor to a position moving at a speed."""
        error = counts - seen.counts
        integral = self._integral + self._gains.integral * error * TICK_S
        self._integral = max(-self.limit_permille, min(self.limit_permille, integral))
        damped = self._gains.derivative * (counts_per_s - seen.counts_per_s)
        return self._gains.proportional * error + damped + self._integral


def within_limits(target: float, dictionary: Dictionary) -> float:
    """Return a target in the drive's unit of position, kept to the software position limits (0x607D)."""
    low, high = dictionary.number(0x607D, 1), dictionary.number(0x607D, 2)
    return min(max(target, low), high) if low < high else target
