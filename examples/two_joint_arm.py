"""Force at the tip of a planar two-joint arm from the friction-compensated currents of its joints.

Run it:  python examples/two_joint_arm.py

Both joints are those of the preset `paper`: 1 N m at the joint per ampere (0.05 N m/A, ratio 20). The tip pushes with
(3, -4) N. Each joint's current holds the load's share and an error of 1.75 mA, one forwards and one backwards, within
the 2.5 mA either way (95 %) that a zero-speed search leaves: half a gram at the end of a 0.5 m arm.

x = l1 cos(q1) + l2 cos(q1 + q2)        q1 from the x axis, q2 from the first link
y = l1 sin(q1) + l2 sin(q1 + q2)        det J = l1 l2 sin(q2): singular stretched out and folded back
"""

from math import cos, degrees, radians, sin

import numpy as np

from compensator.errors import SingularPoseError
from compensator.reflection.tip_force import require_complete, tip_force

FIRST_M, SECOND_M = 0.5, 0.4
TORQUE_PER_CURRENT_N_M_A = 1.0
FORCE_N = np.array([3.0, -4.0])
ERROR_A = np.array([0.00175, -0.00175])
HALF_WIDTH_A = 0.0025
FIRST_RAD = radians(30.0)
ELBOWS_RAD = [radians(angle) for angle in (90.0, 60.0, 30.0, 15.0, 5.0, 0.0)]


def tip_m(first_rad: float, second_rad: float) -> np.ndarray:
    """Position of the tip, shape (2,)."""
    both_rad = first_rad + second_rad
    x_m = FIRST_M * cos(first_rad) + SECOND_M * cos(both_rad)
    return np.array([x_m, FIRST_M * sin(first_rad) + SECOND_M * sin(both_rad)])


def jacobian_m(first_rad: float, second_rad: float) -> np.ndarray:
    """Velocity of the tip per speed of each joint, shape (2, 2)."""
    x_m, y_m = tip_m(first_rad, second_rad)
    both_rad = first_rad + second_rad
    return np.array([[-y_m, -SECOND_M * sin(both_rad)], [x_m, SECOND_M * cos(both_rad)]])


def main() -> None:
    """Print one line for each angle of the elbow."""
    print("elbow [deg]  shortest lever [m]  condition  force [N]             +- [N]")
    for elbow_rad in ELBOWS_RAD:
        jacobian = jacobian_m(FIRST_RAD, elbow_rad)
        current_a = jacobian.T @ FORCE_N / TORQUE_PER_CURRENT_N_M_A + ERROR_A
        found = tip_force(jacobian, current_a * TORQUE_PER_CURRENT_N_M_A, HALF_WIDTH_A * TORQUE_PER_CURRENT_N_M_A)
        facts = f"{degrees(elbow_rad):11.0f}  {found.levers_m[-1]:18.4f}  {found.condition:9.3g}"
        try:
            require_complete(found, f"elbow at {degrees(elbow_rad):.0f} degrees")
        except SingularPoseError as error:
            print(f"{facts}  not told: {error}")
            continue
        print(f"{facts}  ({found.force_n[0]:7.3f}, {found.force_n[1]:7.3f})  "
              f"({found.half_width_n[0]:.3f}, {found.half_width_n[1]:.3f})")  # fmt: skip


if __name__ == "__main__":
    main()
