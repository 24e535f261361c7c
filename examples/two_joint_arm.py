"""Force at the tip of a planar two-joint arm from the friction-compensated currents of its joints.

Run it:  python examples/two_joint_arm.py

Both joints are those of the preset `paper`: 1 N m at the joint per ampere (0.05 N m/A, ratio 20). The tip pushes with
(3, -4) N. Each joint's current holds the load's share and an error of 1.75 mA, one forwards and one backwards, within
the 2.5 mA either way (95 %) that a zero-speed search leaves: half a gram at the end of a 0.5 m arm.
"""

from math import degrees, radians

import numpy as np

from compensator.errors import SingularPoseError
from compensator.reflection.planar_arm import PlanarArm
from compensator.reflection.tip_force import require_complete, tip_force

ARM = PlanarArm(first_m=0.5, second_m=0.4)
TORQUE_PER_CURRENT_N_M_A = 1.0
FORCE_N = np.array([3.0, -4.0])
ERROR_A = np.array([0.00175, -0.00175])
HALF_WIDTH_A = 0.0025
FIRST_RAD = radians(30.0)
ELBOWS_RAD = [radians(angle) for angle in (90.0, 60.0, 30.0, 15.0, 5.0, 0.0)]


def main() -> None:
    """Print one line for each angle of the elbow."""
    print("elbow [deg]  shortest lever [m]  condition  force [N]             +- [N]")
    for elbow_rad in ELBOWS_RAD:
        jacobian = ARM.jacobian(FIRST_RAD, elbow_rad)
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
