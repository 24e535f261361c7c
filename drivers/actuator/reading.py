"""What an actuator says of itself, in its own sense of turning."""

from math import nan
from typing import NamedTuple


class Identity(NamedTuple):
    """What an actuator says of itself; empty where it does not tell."""

    vendor: str
    product: str
    firmware: str = ""
    serial: str = ""
    simulated: bool = False


class Reading(NamedTuple):
    """One answer. Signs are the actuator's own; a quantity that is not measured is NaN.

    Attributes:
        asked_s: when it was asked for, of `perf_counter` [s].
        counts: position, in counts of `rig.sensor`, without wraps.
        counts_s: speed in these [1/s].
        duty: applied PWM duty, -1 .. 1.
        current_a: motor current [A].
        torque_n_m: torque at the actuator's output [N m].
        supply_v: supply voltage [V].
        temperature_c: highest that it tells [deg C].
        is_on: whether it says that its power stage is on.
        fault: what has switched it off, in words; "" where nothing has.
        time_s: when it was measured, by the actuator's own clock, without wraps [s]; NaN: it tells none.
        slow_s: when supply and temperature were asked for [s]; NaN: with the rest.
    """

    asked_s: float
    counts: float
    counts_s: float = nan
    duty: float = nan
    current_a: float = nan
    torque_n_m: float = nan
    supply_v: float = nan
    temperature_c: float = nan
    is_on: bool = False
    fault: str = ""
    time_s: float = nan
    slow_s: float = nan
