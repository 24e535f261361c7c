"""Force at the tip of a planar arm from the torques of its joints."""

import runpy
from math import cos, pi, radians, sin
from types import SimpleNamespace

import numpy as np
import pytest

from compensator.errors import ModelParameterError, SingularPoseError
from compensator.reflection.tip_force import require_complete, tip_force
from tests.paths import EXAMPLES

EXAMPLE = EXAMPLES / "two_joint_arm.py"
ARM = SimpleNamespace(**runpy.run_path(str(EXAMPLE)))
POSES = [(0.3, 1.2), (-1.0, 0.4), (2.0, -2.2)]


@pytest.mark.parametrize("pose", POSES)
def test_the_jacobian_is_the_derivative_of_the_tip(pose):
    step = 1e-6
    first = (ARM.tip_m(pose[0] + step, pose[1]) - ARM.tip_m(pose[0] - step, pose[1])) / (2 * step)
    second = (ARM.tip_m(pose[0], pose[1] + step) - ARM.tip_m(pose[0], pose[1] - step)) / (2 * step)
    assert ARM.jacobian_m(*pose) == pytest.approx(np.column_stack([first, second]), abs=1e-9)


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("force", [(1.0, 0.0), (0.0, -2.0), (3.0, -4.0)])
def test_torques_of_a_force_give_the_force_back(pose, force):
    # torques by hand, from lever arms: T = r x F about each joint
    elbow = np.array([0.5 * cos(pose[0]), 0.5 * sin(pose[0])])
    tip = ARM.tip_m(*pose)
    torque = [arm[0] * force[1] - arm[1] * force[0] for arm in (tip, tip - elbow)]
    found = tip_force(ARM.jacobian_m(*pose), torque)
    assert found.complete
    assert found.force_n == pytest.approx(force)


def test_half_widths_are_what_errors_of_the_torques_amount_to():
    jacobian = ARM.jacobian_m(0.3, 0.5)
    width = np.array([0.003, 0.001])
    errors = np.random.default_rng(5).normal(0.0, width / 1.96, (20000, 2))
    forces = np.array([tip_force(jacobian, one).force_n for one in errors])
    found = tip_force(jacobian, [0.0, 0.0], width)
    assert found.half_width_n == pytest.approx(1.96 * np.std(forces, axis=0), rel=0.03)  # 0.5 % of chance
    # a relative error weighs at most `condition` times as much in the force
    assert found.condition == pytest.approx(np.linalg.cond(jacobian))


def test_stretched_out_the_force_along_the_arm_is_lost_and_said_to_be():
    jacobian = ARM.jacobian_m(0.0, radians(1.0))
    torque = jacobian.T @ [5.0, 2.0]
    found = tip_force(jacobian, torque, 0.002)
    assert not found.complete
    assert abs(found.lost[0]) == pytest.approx([1.0, 0.0], abs=0.02)
    assert found.force_n[1] == pytest.approx(2.0, rel=0.05)
    assert np.all(np.isinf(found.half_width_n))
    with pytest.raises(SingularPoseError, match=r"elbow at 1 degree: the shortest lever is 0.00\d+ m \(condition"):
        require_complete(found, "elbow at 1 degree")


def test_exactly_singular_poses_give_no_infinite_force():
    for elbow in (0.0, pi):
        found = tip_force(ARM.jacobian_m(0.4, elbow), [0.1, 0.2])
        assert np.all(np.isfinite(found.force_n))
        assert found.condition > 1e6


REFUSED = [
    (([[1.0, 0.0]], [1.0, 2.0]), {}, "as many joints as components"),
    ((np.eye(2), [1.0, 2.0, 3.0]), {}, "allowed is"),
    ((np.eye(2), [1.0, np.nan]), {}, "the torques must be finite"),
    ((np.eye(2), [1.0, 2.0]), {"half_width_n_m": -1.0}, "0 or more"),
    ((np.eye(2), [1.0, 2.0]), {"half_width_n_m": [1.0, 2.0, 3.0]}, "half widths have shape"),
    ((np.eye(2), [1.0, 2.0]), {"least_lever_m": 0.0}, "above 0"),
]


@pytest.mark.parametrize(("arguments", "named", "message"), REFUSED)
def test_what_makes_no_sense_is_refused(arguments, named, message):
    with pytest.raises(ModelParameterError, match=message):
        tip_force(*arguments, **named)


def test_the_example_prints_a_force_within_its_interval_or_why_not(capsys):
    runpy.run_path(str(EXAMPLE), run_name="__main__")
    lines = capsys.readouterr().out.splitlines()[1:]
    told = [line for line in lines if "not told" not in line]
    assert len(told) == 4
    assert len(lines) == 6
    for line in told:
        (x, y), (width_x, width_y) = (map(float, part.split(")")[0].split(",")) for part in line.split("(")[1:])
        assert abs(x - 3.0) <= width_x + 0.001  # as printed
        assert abs(y + 4.0) <= width_y + 0.001
