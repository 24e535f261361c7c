"""The General Kinetic Friction model (paper, section 2.2), expressed as motor current.

    F = F(v)          v != 0
        Fe            v = 0 and |Fe| < Fs        (1)
        Fs sgn(Fe)    otherwise
    F(v) = sgn(v) (Fc + (Fs - Fc) exp(-|v/vs|^ds) + b |v|)   (2)

The viscous term b |v| stands beside the terms of eq. (2).
"""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from compensator.errors import ModelParameterError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class KineticFriction:
    """One friction curve, at one load. Odd in speed: friction is taken as equal in both directions.

    Attributes:
        coulomb_a: Fc [A], 0 or more.
        static_a: Fs [A], at least Fc.
        stribeck_speed_rad_s: vs [rad/s], above 0.
        shape: ds, above 0.
        viscous_a_s_rad: b [A s/rad], 0 or more.
    """

    coulomb_a: float
    static_a: float
    stribeck_speed_rad_s: float
    shape: float = 2.0
    viscous_a_s_rad: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not 0.0 <= value < float("inf"):
                raise ModelParameterError(f"{field.name} is {value}; allowed is 0 or more")
        if self.static_a < self.coulomb_a:
            raise ModelParameterError(
                f"static_a is {self.static_a} A; allowed is at least coulomb_a, {self.coulomb_a} A (eq. 2)"
            )
        if self.stribeck_speed_rad_s == 0.0 or self.shape == 0.0:
            raise ModelParameterError("stribeck_speed_rad_s and shape must be above 0 (eq. 2)")

    def sliding_a(self, speed_rad_s: FloatArray | float) -> FloatArray:
        """Eq. (2): friction current [A] at speeds other than 0; its sign is that of the speed, 0 at 0."""
        speed = np.asarray(speed_rad_s, dtype=np.float64)
        magnitude = np.abs(speed)
        bump = (self.static_a - self.coulomb_a) * np.exp(-((magnitude / self.stribeck_speed_rad_s) ** self.shape))
        return np.sign(speed) * (self.coulomb_a + bump + self.viscous_a_s_rad * magnitude)
