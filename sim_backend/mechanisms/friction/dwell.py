"""Static friction that rises while the contact rests."""

from dataclasses import dataclass
from math import exp

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Dwell(Component):
    """Static friction grows with the age t of the contact: Fs (1 + r t / (t + t0)) (Armstrong-Helouvry et al. 1994).

        dt/dtime = 1 - |w| t / d     (ageing law, Dieterich 1979)

    At rest the contact ages as the clock does; sliding by d renews it. d is much longer than the bristles bend, so
    creep does not make a contact young. Values at the shaft where the friction acts.
    """

    rise_fraction: float = quantity("1", at_least=0, default=0.0)
    time_s: float = quantity("s", above=0, default=1.0)
    slip_rad: float = quantity("rad", above=0, default=0.01)


@jitted
def rest_scale(dwell: Dwell, age_s: float) -> float:
    """Return static friction at an age of the contact over that of a fresh one."""
    if dwell.rise_fraction == 0.0:
        return 1.0
    return 1.0 + dwell.rise_fraction * age_s / (age_s + dwell.time_s)


@jitted
def aged(dwell: Dwell, age_s: float, speed_rad_s: float, step_s: float) -> float:
    """Return the contact's age after a step at a mean speed; exact at constant speed."""
    if dwell.rise_fraction == 0.0:
        return 0.0
    renewed = abs(speed_rad_s) / dwell.slip_rad * step_s
    if renewed < 1e-6:
        return age_s * (1.0 - renewed) + step_s
    kept = exp(-renewed)
    return age_s * kept + step_s * (1.0 - kept) / renewed
