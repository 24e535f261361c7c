"""How far a mechanism stands out of recordings: what an ideal judge could know, who has both joints to compare.

The joint is recorded without noise, and led without the mechanism along the same motion (`led`). Of both efforts, the
base model over the motion that the encoder shows takes what it can; the difference D of what is left would be the
mechanism's evidence, did the recording hold it. Motion between two samples or two counts is in D, but no recording
shows it: a rigid joint that followed every blow of a backlash would need torques that nobody has measured. So of D
counts what the recording's own remainder R has of it, by least squares.

    s = rms that the base model leaves of the joint without the mechanism, with noise, in steady motion, near
        reversals, and where the current is commanded, each for itself
    a = R'D / D'D, both over s, 0 <= a <= 1
    r = a sqrt(mean((D / s)^2))
    lambda = n / v ln(1 + r^2),   v = (1 + rho_1) / (1 - rho_1) of that remainder (rows per independent row)
    d' = sqrt(lambda (1 - rho^2)), rho the largest correlation of D / s with another mechanism's columns
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sim_backend.second_plant.columns import Rows, base_columns, rival_columns
from sim_backend.second_plant.joint import DrawnJoint
from sim_backend.second_plant.recording import record, record_beside

FloatArray = NDArray[np.float64]
MOST_CORRELATED = 0.97
STRATA = 3


@dataclass(frozen=True)
class Floor:
    """What the base model leaves of a joint without a mechanism.

    Attributes:
        left: noisy, root mean square of each stratum, in the effort's unit, shape (3,).
        dependent: rows per independent row.
    """

    left: FloatArray
    dependent: float


@dataclass(frozen=True)
class Evidence:
    """How far a mechanism stands out; see above.

    Attributes:
        ratio: r; infinite where the mechanism holds the joint fast, so that no row moves.
        detectability: d'.
        rival: the mechanism that is most like it.
        independent: rows, of those that move.
    """

    ratio: float
    detectability: float
    rival: str
    independent: float


def floor_of(joint: DrawnJoint, name: str) -> Floor:
    """Record a joint without one of its mechanisms, as it is."""
    rows = Rows.of(record(joint, without=frozenset({name})), joint.scales)
    left = np.ones(STRATA)
    for _ in range(2):  # least squares, then weighted by what each stratum leaves
        remainder = _remainder(rows, joint, left) * left[rows.stratum]
        for stratum in range(STRATA):
            own = remainder[rows.moving & (rows.stratum == stratum)]
            left[stratum] = float(np.sqrt(np.mean(own**2))) if len(own) else 1.0
    white = (remainder / left[rows.stratum])[rows.moving]
    one = float(np.clip(white[:-1] @ white[1:] / (white @ white), 0.0, MOST_CORRELATED))
    return Floor(left, (1.0 + one) / (1.0 - one))


def evidence(joint: DrawnJoint, name: str, floor: Floor | None = None) -> Evidence:
    """How far the one mechanism that a joint hides stands out of a base model with nothing else missing.

    Args:
        joint: drawn.
        name: of the mechanism.
        floor: of the same joint without it, where it is known.
    """
    floor = floor or floor_of(joint, name)
    rows, shown, basis = _shown(joint, replace(joint, hidden=()), floor)
    if not len(shown):
        return Evidence(float("inf"), 0.0, "", 0.0)
    moving, weight = rows.moving, 1.0 / floor.left[rows.stratum]
    ratio, independent = float(np.sqrt(np.mean(shown**2))), len(shown) / floor.dependent
    correlation, rival = 0.0, ""
    for other, columns in rival_columns(rows, joint.scales).items():
        alike = 0.0 if other == name else _correlation(shown, basis, (columns * weight[:, None])[moving])
        if alike > correlation:
            correlation, rival = alike, other
    strength = independent * float(np.log1p(ratio**2))
    return Evidence(ratio, float(np.sqrt(strength * (1.0 - correlation**2))), rival, independent)


def laws_ratio(joint: DrawnJoint, floor: Floor) -> float:
    """The r of a joint's friction laws, as far as the base model does not have them, whatever else it hides.

    Args:
        joint: drawn.
        floor: of the joint without what it hides.
    """
    if joint.level == "textbook":
        return 0.0
    plain = replace(joint, hidden=())
    _, shown, _ = _shown(plain, plain.by_the_book(), floor)
    return float(np.sqrt(np.mean(shown**2)))


def _shown(joint: DrawnJoint, plain: DrawnJoint, floor: Floor) -> tuple[Rows, FloatArray, FloatArray]:
    """Rows of a joint; what the base model leaves of it, in motion, beyond a plain one; that model's basis."""
    rows, led = (Rows.of(recorded, joint.scales) for recorded in record_beside(joint, plain))
    weight = 1.0 / floor.left[rows.stratum]
    basis = _orthonormal((base_columns(rows, joint.scales) * weight[:, None])[rows.moving])
    left, left_of_plain = (_remainder(one, joint, floor.left)[rows.moving] for one in (rows, led))
    differs = left - left_of_plain
    differs -= basis @ (basis.T @ differs)
    power = float(differs @ differs)
    held = float(np.clip(differs @ left / power, 0.0, 1.0)) if power > 0.0 else 0.0
    return rows, held * differs, basis


def _correlation(shown: FloatArray, basis: FloatArray, columns: FloatArray) -> float:
    """Share of a difference's amplitude that lies in what columns add to the base model, 0 .. 1."""
    power = float(np.linalg.norm(shown))
    if power == 0.0:
        return 0.0
    fresh = columns - basis @ (basis.T @ columns)
    kept = np.linalg.norm(fresh, axis=0) > 1e-3 * np.linalg.norm(columns, axis=0)
    return min(float(np.linalg.norm(_orthonormal(fresh[:, kept]).T @ shown)) / power, 1.0)


def _remainder(rows: Rows, joint: DrawnJoint, left: FloatArray) -> FloatArray:
    """What the base model leaves of the rows that move, over `left`; 0 elsewhere."""
    weight = 1.0 / left[rows.stratum]
    basis = _orthonormal((base_columns(rows, joint.scales) * weight[:, None])[rows.moving])
    effort = (rows.effort * weight)[rows.moving]
    remainder = np.zeros(len(rows.effort))
    remainder[rows.moving] = effort - basis @ (basis.T @ effort)
    return remainder


def _orthonormal(columns: FloatArray) -> FloatArray:
    """Orthonormal basis of the columns' span."""
    scale = np.linalg.norm(columns, axis=0)
    scaled: FloatArray = columns[:, scale > 0.0] / scale[scale > 0.0]
    if scaled.shape[1] == 0:
        return scaled
    left, values, _ = np.linalg.svd(scaled, full_matrices=False)
    basis: FloatArray = left[:, values > 1e-8 * values[0]]
    return basis
