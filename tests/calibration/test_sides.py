"""Both sides of the travel are searched at rest where the limits let them; one alone is said."""

from math import pi
from types import SimpleNamespace

import pytest

from bench.calibration.sides import FLATTEST_RAD, one_sided, sides_rad
from bench.config.configuration import default_configuration
from bench.runs.sequential_calibration import SequentialCalibration, Wish

BENCH = default_configuration()
LEVEL_RAD = pi / 2.0


def limited(low_rad, high_rad):
    limits = BENCH.limits.model_copy(update={"position_min_rad": low_rad, "position_max_rad": high_rad})
    return BENCH.model_copy(update={"limits": limits})


@pytest.mark.parametrize(
    ("low_rad", "high_rad", "wanted"),
    [
        (-2.2, 2.2, [LEVEL_RAD, -LEVEL_RAD]),
        (-0.3, 2.2, [LEVEL_RAD]),
        (-2.2, 0.3, [-LEVEL_RAD]),
        (-1.0, 2.2, [LEVEL_RAD, -0.8]),
        (-0.2, 0.2, [LEVEL_RAD]),
    ],
)
def test_loads_are_searched_level_on_both_sides_or_as_far_as_the_limits_go(low_rad, high_rad, wanted):
    assert sides_rad(limited(low_rad, high_rad)) == pytest.approx(wanted, abs=1e-4)


def trial(angle_rad, breakaways=(1,)):
    return SimpleNamespace(conditions={"angle_rad": angle_rad}, results={"breakaways": list(breakaways)})


def test_what_was_searched_on_one_side_alone_is_said():
    assert "on one side alone" in one_sided([trial(0.0), trial(1.0)])
    assert "on one side alone" in one_sided([trial(-1.0), trial(-0.5), trial(1.0, [])])
    assert one_sided([trial(0.0), trial(1.0), trial(-FLATTEST_RAD)]) == ""
    assert one_sided([trial(0.0), trial(0.1)]) == ""


@pytest.mark.parametrize(("low_rad", "said"), [(-2.2, "on both sides"), (-0.3, "no angle on the other side")])
def test_it_says_before_it_begins_on_which_sides_it_will_search(low_rad, said):
    stands, asked = [], []

    class Enough(Exception):
        pass

    def run(kind, parameters, _hung):
        asked.append((kind, parameters["angles_rad"]))
        raise Enough

    wish = Wish((), 5e-3, 240.0, ())
    calibration = SequentialCalibration(limited(low_rad, 2.2), None, wish, run, stands.append)
    with pytest.raises(Enough):
        calibration.carry_out()
    assert said in stands[0].sentence
    assert asked == [("load-sweep", [0.0, *sides_rad(limited(low_rad, 2.2))])]
