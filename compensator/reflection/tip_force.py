"""Force at the tip of an arm from the load torques of its joints (paper, "many joints").

    T = J^T F,  hence  F = (J^T)^-1 T

J, shape (forces, joints), has the tip's velocity per joint speed. Its singular values are levers [m]: a force along the
direction of a lever shows as lever * force in the joints. Where a lever comes to 0 (an arm stretched out), forces along
that direction show in no joint, and what one would compute is the joints' error over nearly nothing. So a lever below
`least_lever_m` counts as none: the force along it is not told, and the estimate says so; or it is refused.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from compensator.errors import ModelParameterError, SingularPoseError
from compensator.motion.kinetic_friction import FloatArray


@dataclass(frozen=True)
class TipForce:
    """A force at the tip, and how far it is told.

    Attributes:
        force_n: shape (forces,); without its part along `lost`.
        half_width_n: half of its 95 % interval along each axis, from those of the torques; infinite along an axis that
            `lost` has a part in.
        condition: longest over shortest lever; how much more a relative error of the torques can weigh in the force.
        levers_m: shape (forces,), falling.
        lost: unit vectors along which the force is not told, shape (lost, forces).
    """

    force_n: FloatArray
    half_width_n: FloatArray
    condition: float
    levers_m: FloatArray
    lost: FloatArray

    @property
    def complete(self) -> bool:
        """Whether the force is told in every direction."""
        return len(self.lost) == 0


def tip_force(
    jacobian: ArrayLike, torque_n_m: ArrayLike, half_width_n_m: ArrayLike = 0.0, least_lever_m: float = 0.05
) -> TipForce:
    """F from T, with what is lost near a singular pose.

    Args:
        jacobian: J, shape (n, n) [m]: as many joints as components of the force.
        torque_n_m: T, of the load alone, shape (n,).
        half_width_n_m: half of the 95 % intervals of T, shape (n,) or one for all; taken as independent.
        least_lever_m: levers shorter than that tell nothing; above 0.

    Raises:
        ModelParameterError: wrong shapes, values that are not finite, a lever or a width out of range.
    """
    matrix, torque, width = _checked(jacobian, torque_n_m, half_width_n_m, least_lever_m)
    directions, levers, joints = np.linalg.svd(matrix)  # J = directions diag(levers) joints
    told = levers >= least_lever_m
    gain = (directions[:, told] / levers[told]) @ joints[told]  # (J^T)^-1, without what is lost
    lost = directions[:, ~told].T
    half_width = np.sqrt(np.square(gain) @ np.square(width))
    half_width[np.any(np.abs(lost) > 1e-9, axis=0)] = np.inf
    shortest = float(levers[-1])
    condition = float(levers[0]) / shortest if shortest > 0.0 else np.inf
    return TipForce(gain @ torque, half_width, condition, levers, lost)


def require_complete(found: TipForce, pose: str) -> TipForce:
    """The estimate, where it tells the force in every direction.

    Raises:
        SingularPoseError: it does not.
    """
    if found.complete:
        return found
    along = "; ".join("(" + ", ".join(f"{value:.3f}" for value in direction) + ")" for direction in found.lost)
    raise SingularPoseError(
        f"{pose}: the shortest lever is {found.levers_m[-1]:.4g} m (condition {found.condition:.3g}), and the force "
        f"along {along} is not told by the joints. Move the arm away from this pose, or use the other components alone"
    )


def _checked(
    jacobian: ArrayLike, torque_n_m: ArrayLike, half_width_n_m: ArrayLike, least_lever_m: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    matrix, torque = np.asarray(jacobian, dtype=np.float64), np.asarray(torque_n_m, dtype=np.float64)
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or torque.shape != matrix.shape[:1]:
        raise ModelParameterError(
            f"the Jacobian has shape {matrix.shape} and the torques {torque.shape}; allowed is (n, n) and (n,): as "
            "many joints as components of the force"
        )
    width = np.asarray(half_width_n_m, dtype=np.float64)
    if width.shape not in ((), torque.shape):
        raise ModelParameterError(f"half widths have shape {width.shape}; allowed is one, or {torque.shape}")
    for name, values in (("the Jacobian", matrix), ("the torques", torque), ("half widths of the torques", width)):
        if not np.all(np.isfinite(values)):
            raise ModelParameterError(f"{name} must be finite; found {values.tolist()}")
    if np.any(width < 0.0) or not 0.0 < least_lever_m < np.inf:
        raise ModelParameterError(
            f"half widths are {width.tolist()} N m, allowed is 0 or more; least_lever_m is {least_lever_m} m, "
            "allowed is above 0"
        )
    return matrix, torque, np.broadcast_to(width, torque.shape)
