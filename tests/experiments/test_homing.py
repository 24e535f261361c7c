"""The search for an end stop in the ordinary loop: what it finds, and how STOP and faults end it."""

from math import radians

import pytest

from bench.config.configuration import parse_configuration
from bench.control.clock import VirtualClock
from bench.control.cycle import Reading
from bench.control.drive_factory import make_equipment
from bench.control.ending import StopRequest
from bench.control.limits import Guard
from bench.control.loop import joint_loop
from bench.control.servo import CurrentServo
from bench.errors import ExperimentError
from bench.experiments.kinds.homing import OFF_RAD, home_at_end_stop, home_by_drive, search_bench
from drivers.contract import Command, Mode, Sample, Status
from tests.control.fake_drive import ListSink
from tests.control.test_sim_faults import RIG

STOP_RAD = radians(80.0)
HOMING = {"method": "end-stop", "angle_rad": STOP_RAD, "speed_rad_s": 0.5, "current_a": 0.6, "travel_rad": 2.0}


def home(faults=(), at_rad=0.0, stop=None, load_kg=0.0, **changes):
    """Outcome and drive of a search on the simulated joint."""
    drive = {"kind": "roboclaw", "port": "none", "homing": HOMING | changes}
    bench = search_bench(parse_configuration({"name": "b", "rig": RIG, "drive": drive}, "bench.toml"), at_rad)
    plant = {"end_stops": {"present": True, "upper_rad": STOP_RAD, "lower_rad": -STOP_RAD}}
    simulated = {"plant": plant, "faults": list(faults)}
    joint = make_equipment(parse_configuration({"name": "b", "rig": RIG, "drive": simulated}, "bench.toml")).drive
    joint.open(bench.control.period_s)
    joint.hang_load(load_kg, False)
    joint.plant.place(at_rad, at_rad)
    loop = joint_loop(joint, VirtualClock(), Guard(bench.limits), bench.control.period_s, CurrentServo(bench.rig))
    outcome = loop.run(home_at_end_stop(bench), ListSink(), stop or StopRequest())
    assert joint.inspect().status is not Status.ENABLED
    return outcome, joint


BY_DRIVE = {"method": "drive", "drive_method": 34, "angle_rad": 0.1, "travel_rad": 0.5}


def home_by(positions_rad, homed_from=10**9):
    """What the search by the drive comes to, where its position is as listed, and then stays."""
    drive = {
        "kind": "canopen",
        "interface": "virtual",
        "channel": "c",
        "node_id": 5,
        "homing": BY_DRIVE,
        "zero_rad": 0.7,
    }
    told = {"name": "b", "rig": RIG, "drive": drive | {"homing": BY_DRIVE}}
    bench = parse_configuration(told, "bench.toml")
    search = home_by_drive(search_bench(bench, 0.0))
    action, cycle = next(search), -1
    while True:
        at_rad = positions_rad[min(max(cycle, 0), len(positions_rad) - 1)]
        sample = Sample(0.0, 0.0, at_rad, *[0.0] * 5, Status.ENABLED, homed=cycle >= homed_from)
        try:
            action = search.send(Reading(0.0, sample, 0.0, 0.0))
        except StopIteration as end:
            return end.value
        assert action.command == Command(Mode.HOME, 1.0)
        cycle += 1


def test_the_drive_may_count_from_home_before_it_says_that_it_is_there():
    results = home_by([0.0, 0.1, 0.2, -3.0, -3.0, -3.0], homed_from=6)
    assert results[OFF_RAD] == pytest.approx(-0.7 - 0.1)


def test_a_drive_that_goes_on_beyond_the_travel_is_ended():
    with pytest.raises(ExperimentError, match=r"the drive went 0\.6 rad and was not at home; 0\.5 rad are"):
        home_by([0.0, 0.3, 0.6])


def test_a_drive_that_never_comes_home_is_ended_in_time():
    with pytest.raises(ExperimentError, match="not at home within 25 s"):
        home_by([0.0])


class StopsSoon(StopRequest):
    """Stops the run at the question of a number."""

    def __init__(self, at):
        super().__init__()
        self._left = at

    def is_set(self):
        self._left -= 1
        if self._left == 0:
            self.ask("the test")
        return super().is_set()


@pytest.mark.parametrize("at_rad", [0.0, STOP_RAD], ids=["hanging", "at the stop already"])
def test_the_stop_is_found_and_the_arm_brought_down(at_rad):
    outcome, joint = home(at_rad=at_rad)
    assert outcome.outcome == "completed", outcome.reason
    assert outcome.results[OFF_RAD] == pytest.approx(0.0, abs=0.03)
    first_rad, second_rad = outcome.results["stops_rad"]
    assert first_rad == pytest.approx(second_rad, abs=0.02)
    assert joint.plant.truth().arm_rad == pytest.approx(0.0, abs=0.1)


def test_the_other_way():
    outcome, _ = home(direction=-1, angle_rad=-STOP_RAD)
    assert outcome.results[OFF_RAD] == pytest.approx(0.0, abs=0.03)


@pytest.mark.parametrize("at", [20, 300, 640])
def test_stop_ends_it_within_a_cycle_wherever_it_is(at):
    outcome, _ = home(stop=StopsSoon(at))
    assert (outcome.outcome, outcome.reason) == ("stopped", "the test")
    assert outcome.cycles < at
    assert OFF_RAD not in outcome.results


def test_a_fault_on_the_way_ends_it():
    outcome, _ = home(faults=[{"kind": "over-current", "at_s": 1.0}])
    assert outcome.outcome == "failed"
    assert OFF_RAD not in outcome.results


def test_an_encoder_that_stands_still_is_not_taken_for_a_stop_twice():
    """Its count rests while the joint is free: the limits end it, or no zero comes of it."""
    outcome, _ = home(faults=[{"kind": "encoder-stuck", "at_s": 0.5, "for_s": 2.0}])
    assert outcome.outcome != "completed"


def test_a_joint_that_the_current_does_not_move_gives_no_zero():
    outcome, _ = home(current_a=0.02, travel_rad=0.5)
    assert outcome.outcome == "tripped"
    assert OFF_RAD not in outcome.results


def test_a_weight_that_the_current_does_not_lift_is_no_stop():
    outcome, _ = home(load_kg=0.15)
    assert outcome.outcome == "failed", outcome
    assert "is no stop: at 0.6 A" in outcome.reason
    assert OFF_RAD not in outcome.results
