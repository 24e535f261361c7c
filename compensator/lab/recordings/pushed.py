"""A joint that was pushed in every trial and never slid: what it bore, how stiff it is, how wide its loop.

Before friction lets go, teeth, shaft and the contacts between surfaces give by some thousandths of a radian and spring
back (pre-sliding: Armstrong-Helouvry, Dupont, Canudas de Wit 1994). No model of sliding can be fitted to that, but it
bounds the breakaway from below on either side.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.recording import FloatArray, Recording
from compensator.lab.recordings.reversals import slider, strokes_of

MOST_GIVEN = {"rad": 0.02, "m": 5e-4}  # what joints give before they slide: a degree at the most
SPRINGS_BACK = 0.8  # of the effort's power that the position alone explains; sliding friction goes by its sign
BORNE_SHARE = 0.001  # of the samples, on either side, that may be spikes
PARTS = 4  # of a single trial, for an interval
LOOP_SHARES = (0.02, 0.1, 0.3)  # of the travel, over which a loop may open
CONFIDENCE = 0.90


@dataclass(frozen=True)
class Pushed:
    """What such trials tell.

    Attributes:
        lowest, highest: effort that was borne; breakaway lies beyond, on either side.
        span: of the position, rad or m.
        stiffness: effort per rad or m before sliding; NaN where the position never changes.
        stiffness_low, stiffness_high: 90 % interval, over trials.
        loop: half the width of the loop, in effort; NaN where the position never changes.
        effort_unit, position_unit: of these.
    """

    lowest: float
    highest: float
    span: float
    stiffness: float
    stiffness_low: float
    stiffness_high: float
    loop: float
    effort_unit: str
    position_unit: str

    def in_words(self) -> str:
        """One sentence that ends in what to record."""
        effort, position = self.effort_unit, self.position_unit
        borne = f"{self.lowest:.3g} .. {self.highest:.3g} {effort}"
        gives = "does not move"
        if np.isfinite(self.stiffness):
            gives = (
                f"gives by {self.span:.2g} {position} and springs back, with {self.stiffness:.3g} {effort}/{position} "
                f"({self.stiffness_low:.3g} to {self.stiffness_high:.3g}) and a loop of +-{self.loop:.2g} {effort}, "
                "but does not slide"
            )
        return (
            f"the joint {gives} in any trial, under {borne}; breakaway lies beyond that on either side; record trials "
            "with more effort and motion in both directions: sines or triangles of several speeds"
        )


def pushed(recordings: Sequence[Recording], effort: Effort, facts: Facts) -> Pushed | None:
    """What trials tell in which nothing slides; None where the joint slides, or may.

    Args:
        recordings: all trials.
        effort: the quantity that pushes.
        facts: of the joint.
    """
    name = f"position_{facts.position_unit}"
    trials = [_known(one.channels[name], effort.of(one)) for one in recordings]
    positions, efforts = (np.concatenate(parts) for parts in zip(*trials, strict=True))
    if not len(positions):
        return None
    span = float(np.ptp(positions))
    if span > MOST_GIVEN[facts.position_unit]:
        return None
    lowest, highest = np.quantile(efforts, [BORNE_SHARE, 1.0 - BORNE_SHARE]).tolist()
    units = effort.unit, facts.position_unit
    moving = [(q, u) for q, u in trials if np.ptp(q) > 0.0]
    if not moving:
        return Pushed(lowest, highest, span, np.nan, np.nan, np.nan, np.nan, *units)
    fits = [_spring(q, u) for q, u in _parts(moving)]
    stiffness = np.array([one[0] for one in fits])
    if float(np.median([one[2] for one in fits])) < SPRINGS_BACK or float(np.median(stiffness)) <= 0.0:
        return None
    mean, half = float(stiffness.mean()), _half_interval(stiffness)
    loop = float(np.mean([one[1] for one in fits]))
    return Pushed(lowest, highest, span, mean, mean - half, mean + half, loop, *units)


def _known(position: FloatArray, effort: FloatArray) -> tuple[FloatArray, FloatArray]:
    known = np.isfinite(position) & np.isfinite(effort)
    return position[known], effort[known]


def _parts(trials: list[tuple[FloatArray, FloatArray]]) -> list[tuple[FloatArray, FloatArray]]:
    """The trials; a single one in parts."""
    if len(trials) > 1:
        return trials
    ((position, effort),) = trials
    parts = zip(np.array_split(position, PARTS), np.array_split(effort, PARTS), strict=True)
    return [(q, u) for q, u in parts if len(q) and np.ptp(q) > 0.0]


def _spring(position: FloatArray, effort: FloatArray) -> tuple[float, float, float]:
    """Stiffness, half width of the loop, and the share of the effort's power that the position alone explains."""
    centred = position - position.mean()
    force = effort - effort.mean()
    power = float(centred @ centred) * float(force @ force)
    share = float(centred @ force) ** 2 / power if power > 0.0 else 0.0
    strokes, fits = strokes_of(position), []
    for loop_share in LOOP_SHARES:
        bent = slider(strokes, loop_share * float(np.ptp(position)))
        columns = np.column_stack([centred, bent, np.ones(len(force))])
        found = np.linalg.lstsq(columns, force, rcond=None)[0]
        fits.append((float(np.sum((force - columns @ found) ** 2)), float(found[0]), abs(float(found[1]))))
    _, stiffness, loop = min(fits)
    return stiffness, loop, share


def _half_interval(values: FloatArray) -> float:
    """Half the interval of their mean; inf of a single one."""
    if len(values) < 2:
        return float("inf")
    spread = float(np.std(values, ddof=1)) / np.sqrt(len(values))
    factor: float = student.ppf(0.5 + 0.5 * CONFIDENCE, len(values) - 1)
    return float(factor * spread)
