"""The friction of a joint at any speed, from the curve that its present load selects (paper, section 3.2.1).

One curve per load was calibrated; between two loads, friction at a speed is interpolated. What selects the curve is the
load itself where it is known, or F_load of eq. (10), which is there without knowing the load.

    I_friction(w)                                      of the balanced joint, selected
    d_friction(w) = (R I_friction(w) + Ke w) / Vs      the same as duty, with the back-EMF share
"""

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from compensator.errors import CalibrationError, LookupRangeError
from compensator.motion.kinetic_friction import FloatArray, KineticFriction
from compensator.motor import dc_motor as motor
from compensator.motor.dc_motor import MotorConstants

MARGIN = 0.1  # of the calibrated span


@dataclass(frozen=True)
class FrictionLookup:
    """Friction curves in the order of what selects them; made by `over_load` or `over_friction`.

    Attributes:
        quantity, unit: what selects the curve: "load" [kg] or "F_load" [A].
        selectors: its value for each curve, rising; two or more.
        curves: one each; speeds of the motor shaft.
        margin: how far beyond the first and the last one may ask, as a share of the span; the curves next to the end
            are then extended in a straight line.

    Raises:
        CalibrationError: fewer than two curves, selectors that do not rise, or a margin below 0.
    """

    quantity: str
    unit: str
    selectors: tuple[float, ...]
    curves: tuple[KineticFriction, ...]
    margin: float = MARGIN

    def __post_init__(self) -> None:
        if len(self.curves) < 2 or len(self.curves) != len(self.selectors):
            raise CalibrationError(
                f"the look-up has {len(self.curves)} curves for {len(self.selectors)} values of {self.quantity}; "
                "allowed is one for each, two or more. Calibrate at more loads"
            )
        if not all(low < high for low, high in pairwise(self.selectors)):
            values = ", ".join(f"{value:.4g}" for value in self.selectors)
            raise CalibrationError(
                f"{self.quantity} of the curves is {values} {self.unit}; allowed is rising from curve to curve"
            )
        if not 0.0 <= self.margin < float("inf"):
            raise CalibrationError(f"margin of the look-up is {self.margin}; allowed is 0 or more")

    @classmethod
    def over_load(cls, curves: Mapping[float, KineticFriction], margin: float = MARGIN) -> "FrictionLookup":
        """From the curve at each load [kg]."""
        return cls("load", "kg", tuple(sorted(curves)), tuple(curves[load] for load in sorted(curves)), margin)

    @classmethod
    def over_friction(cls, curves: Mapping[float, KineticFriction], margin: float = MARGIN) -> "FrictionLookup":
        """From the curve at each F_load [A], as the zero-speed search gives it under the load of the curve."""
        return cls("F_load", "A", tuple(sorted(curves)), tuple(curves[friction] for friction in sorted(curves)), margin)

    def allowed(self) -> tuple[float, float]:
        """The lowest and the highest selector that one may ask for."""
        reach = self.margin * (self.selectors[-1] - self.selectors[0])
        return self.selectors[0] - reach, self.selectors[-1] + reach

    def current_a(self, speed_rad_s: FloatArray | float, selector: float) -> FloatArray:
        """I_friction [A] at speeds other than 0, any shape; its sign is that of the speed.

        Args:
            speed_rad_s: of the motor shaft.
            selector: the present load or F_load, after `quantity`.

        Raises:
            LookupRangeError: the selector lies further outside the calibrated ones than the margin allows.
        """
        below, share = self.place(selector)
        speed = np.abs(np.asarray(speed_rad_s, dtype=np.float64))
        lower_a, upper_a = self.curves[below].sliding_a(speed), self.curves[below + 1].sliding_a(speed)
        # extended beyond the ends, a straight line could pass 0; friction does not
        friction_a = np.maximum(lower_a + share * (upper_a - lower_a), 0.0)
        return np.asarray(np.sign(speed_rad_s) * friction_a)

    def place(self, selector: float) -> tuple[int, float]:
        """The curve below a selector, and how far the selector is from there to the next, as a share.

        Raises:
            LookupRangeError: as `current_a`.
        """
        low, high = self.allowed()
        if not low <= selector <= high:
            raise LookupRangeError(
                f"{self.quantity} is {selector:.4g} {self.unit}; allowed is {low:.4g} .. {high:.4g} {self.unit}: "
                f"calibrated are {self.selectors[0]:.4g} .. {self.selectors[-1]:.4g} {self.unit}, with a margin of "
                f"{self.margin:.0%} of that. Calibrate there"
            )
        below = min(max(bisect_right(self.selectors, selector) - 1, 0), len(self.selectors) - 2)
        lower, upper = self.selectors[below], self.selectors[below + 1]
        return below, (selector - lower) / (upper - lower)

    def duty(
        self, speed_rad_s: FloatArray | float, selector: float, constants: MotorConstants, supply_v: float
    ) -> FloatArray:
        """d_friction [1] at speeds other than 0: the duty that turns the balanced joint at that speed.

        Raises:
            LookupRangeError: as `current_a`.
            CalibrationError: the supply is not above 0 V.
        """
        if not 0.0 < supply_v < float("inf"):
            raise CalibrationError(f"supply is {supply_v} V; allowed is above 0 V")
        speed = np.asarray(speed_rad_s, dtype=np.float64)
        return motor.friction_duty(constants, self.current_a(speed, selector), speed, supply_v)
