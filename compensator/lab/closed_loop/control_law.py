"""The control law that a trial ran under, as far as its set point tells it.

A servo's effort is a sum of position error, its integral, and speed; where a regression on these explains nearly all of
the effort, its gains are the servo's. Otherwise a servo of our own stands in, and is called so.
"""

from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np

from compensator.lab.model.linear import Bounds, solve
from compensator.lab.recordings.differentiation import rate_of_change
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.low_pass import low_pass
from compensator.lab.recordings.processing import Signals
from compensator.lab.recordings.recording import FloatArray

EXPLAINED = 0.95  # of the effort's variance: less is no linear law
DAMPING_RATIO = 0.7  # of a stand-in
FREQUENCY_SHARE = 0.5  # of the final cut-off: natural frequency of a stand-in, twice the motion's bandwidth
FEWEST_SAMPLES = 100

LawSource = Literal["bench", "recording", "stand-in"]


@dataclass(frozen=True, slots=True)
class ControlLaw:
    """Gains of a position servo, in the study's unit of effort.

    Attributes:
        stiffness: per unit of position error; integral: per unit and second of it; damping: per unit of speed.
        source: who tells them: the bench, the recording's set point and effort, or nobody.
        dead_band: position error that counts as none.
    """

    stiffness: float
    integral: float
    damping: float
    source: LawSource
    dead_band: float = 0.0


def law_of(
    signals: Signals, target: FloatArray | None, cutoff_hz: float, inertia: float, told: ControlLaw | None = None
) -> ControlLaw:
    """The law of one trial; a stand-in where the trial has no set point, or no linear law explains its effort.

    Args:
        signals: of the trial.
        target: its set point, as `target_of`.
        cutoff_hz: of the final low-pass: effort and law are compared below it.
        inertia: effort per acceleration, for a stand-in.
        told: what the bench says of its own servo; holds where there is a set point.
    """
    if target is None:
        return stand_in(cutoff_hz, inertia)
    return told or _identified(signals, target, cutoff_hz) or stand_in(cutoff_hz, inertia)


def stand_in(cutoff_hz: float, inertia: float) -> ControlLaw:
    """A servo of proportion and damping that takes the joint along the motion that was measured."""
    frequency_rad_s = 2.0 * pi * FREQUENCY_SHARE * cutoff_hz
    return ControlLaw(inertia * frequency_rad_s**2, 0.0, 2.0 * DAMPING_RATIO * inertia * frequency_rad_s, "stand-in")


def target_of(signals: Signals, facts: Facts) -> FloatArray | None:
    """The set point on the trial's grid; None where it is not there all along while the trial can be used."""
    raw = signals.recording.channels.get(f"target_{facts.position_unit}")
    if raw is None or not np.isfinite(raw).any():
        return None
    raw_s, there = signals.recording.channels["time_s"], np.isfinite(raw)
    if np.interp(signals.time_s, raw_s, there)[signals.usable].min(initial=1.0) < 1.0:
        return None
    return np.interp(signals.time_s, raw_s[there], raw[there])


def _identified(signals: Signals, target: FloatArray, cutoff_hz: float) -> ControlLaw | None:
    """The gains by least squares, each at least 0; None where they explain too little, or do not pull back."""
    error, rate_hz = target - signals.position, signals.rate_hz
    shared = [np.cumsum(error) / rate_hz, rate_of_change(target, rate_hz), np.ones(len(error))]
    rows = np.array([error, -signals.velocity, *shared])
    columns, effort = low_pass(rows, cutoff_hz, rate_hz).T, low_pass(signals.effort, cutoff_hz, rate_hz)
    inside = signals.usable
    if int(inside.sum()) < FEWEST_SAMPLES:
        return None
    bounds = Bounds(np.array([0.0, 0.0, 0.0, -np.inf, -np.inf]), np.full(5, np.inf))
    gains = solve(columns[inside], effort[inside], bounds).coefficients
    left = effort[inside] - columns[inside] @ gains
    power = float(np.var(effort[inside]))
    explained = 1.0 - float(np.mean(left**2)) / power if power > 0.0 else 0.0
    if explained < EXPLAINED or gains[0] <= 0.0:
        return None
    return ControlLaw(float(gains[0]), float(gains[2]), float(gains[1]), "recording")
