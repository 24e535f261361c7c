"""What every rival offers, and what every rival knows."""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, inf, isnan, nan, pi
from typing import Any

import numpy as np

from compensator.motion.friction_lookup import FrictionLookup
from compensator.motion.joint_model import JointModel
from compensator.motion.kinetic_friction import FloatArray, KineticFriction
from compensator.motion.load_estimate import Branch, EstimatorSettings, LoadEstimate, Observation

BANDWIDTH_RAD_S = 2.0 * pi * 5.0
"""Of the observers: fast enough for a master arm, slow enough for speeds from encoder counts."""


@dataclass(frozen=True)
class Knowledge:
    """What one calibration told, the same for all.

    Attributes:
        lookup: friction curves, selected by F_load.
        fixed: the one curve of those who know of no load: that of the load in the middle.
        ratio: motor turns per joint turn.
        inertia_a_s2_rad: current per acceleration of the joint, under the load in the middle.
        breakaway_rad: way of the joint in which friction builds up from nothing; dynamic models need it.
        settings: of the loop, sensor and servo.
        model: what `load_estimator` takes.
    """

    lookup: FrictionLookup
    fixed: KineticFriction
    ratio: float
    inertia_a_s2_rad: float
    breakaway_rad: float
    settings: EstimatorSettings
    model: JointModel


@dataclass(frozen=True)
class Rival:
    """One way.

    Attributes:
        name, title: for programs, for people.
        source: who proposed it.
        begin: the state before the first observation.
        advance: one control cycle.
        searches: whether it uses the results of zero-speed searches.
        filters: whether it smooths by itself; the others are smoothed as the observers are, see `smoothed`.
    """

    name: str
    title: str
    source: str
    begin: Callable[[Knowledge], Any]
    advance: Callable[[Knowledge, Any, Observation], tuple[Any, LoadEstimate]]
    searches: bool = False
    filters: bool = False


def smoothed(given_a: FloatArray, period_s: float) -> FloatArray:
    """A first-order low-pass at the observers' bandwidth, over samples of shape (n,); begins anew after a gap (NaN)."""
    kept, share, last = np.array(given_a), 1.0 - exp(-BANDWIDTH_RAD_S * period_s), nan
    for row, value in enumerate(given_a.tolist()):
        last = value if isnan(last) or isnan(value) else last + share * (value - last)
        kept[row] = last
    return kept


def estimate(observation: Observation, friction_a: float, moving: bool) -> LoadEstimate:
    """Eq. (5): what is left of the motor current; without an interval, since these ways give none."""
    branch = Branch.MOVING if moving else Branch.REST
    return LoadEstimate(observation.current_a - friction_a, inf, branch, friction_a)
