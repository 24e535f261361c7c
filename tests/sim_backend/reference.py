"""One rotor on bristles, integrated by scipy to a tight tolerance: written apart from the plant, from the papers."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import cos, exp, pi

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class BristledRotor:
    """J dw/dt = T - b w - s0 z - s1(w) dz/dt."""

    inertia: float
    viscous: float
    coulomb: float
    static: float
    stribeck: float
    stiffness: float
    damping: float
    elastic: float = 0.0

    def limit(self, w: float) -> float:
        return self.coulomb + (self.static - self.coulomb) * exp(-((w / self.stribeck) ** 2))

    def bristle_speed(self, z: float, w: float) -> float:
        steady = self.limit(w) / self.stiffness
        share = 1.0
        if self.elastic > 0.0:
            bent = abs(z) / steady if z * w > 0.0 else 0.0
            if bent <= self.elastic:
                share = 0.0
            elif bent < 1.0:
                share = 0.5 * (1.0 - cos(pi * (bent - self.elastic) / (1.0 - self.elastic)))
        return w - share * abs(w) * z / steady

    def friction(self, z: float, w: float) -> float:
        fade = exp(-((w / self.stribeck) ** 2))
        return self.stiffness * z + self.damping * fade * self.bristle_speed(z, w) + self.viscous * w

    def run(self, torques: Iterable[float], period_s: float) -> NDArray[np.float64]:
        """Return angle, speed and deflection after each period of constant torque, shape (n, 3); from rest."""

        def slope(_: float, state: NDArray[np.float64], torque: float) -> list[float]:
            _, w, z = state
            return [w, (torque - self.friction(z, w)) / self.inertia, self.bristle_speed(z, w)]

        states = [np.zeros(3)]
        for torque in torques:
            piece = solve_ivp(slope, (0.0, period_s), states[-1], method="LSODA", rtol=1e-9, atol=1e-12, args=(torque,))
            states.append(piece.y[:, -1])
        return np.array(states[1:])
