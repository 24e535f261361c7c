"""A holding brake: released under torque, set before the power goes, and at once where a run ends otherwise."""

from math import radians

import numpy as np
import pytest

from bench.config.channels import RECORDED
from bench.config.configuration import parse_configuration
from bench.control.clock import VirtualClock
from bench.control.cycle import OFF, Action, Reading
from bench.control.drive_factory import make_equipment
from bench.control.ending import StopRequest
from bench.control.joint import ControlledJoint
from bench.control.joint_group import SingleJoint
from bench.control.limits import Guard
from bench.control.loop import ControlLoop
from bench.control.power.brake import LOOK_S, TRUST_S, brake_of
from bench.control.servo import CurrentServo
from bench.errors import ConfigurationError
from bench.experiments.parts.joint import Joint
from bench.experiments.registry import find_kind, parse_parameters
from drivers.contract import Command, Mode, Sample, Status
from tests.control.fake_drive import FakeDrive, ListSink
from tests.control.test_sim_faults import RIG
from tests.experiments.bench_run import Ran

PERIOD_S = 0.005
RAISED_RAD = radians(60.0)
LOAD_KG = 0.25  # more than friction holds
HOLDS_N_M = 0.2  # at the motor shaft


def configured(brake, plant=None, faults=(), **tables):
    told = {"kind": "sim", "brake": brake, "plant": {"brake": {"torque_n_m": HOLDS_N_M} | (plant or {})}}
    return parse_configuration(
        {"name": "b", "rig": RIG, "drive": told | {"faults": list(faults)}, **tables}, "bench.toml"
    )


OUTPUT = {"by": "output", "release_s": 0.1, "engage_s": 0.08}


class Watched:
    """A simulated drive that notes what it is told, and when in its own time."""

    def __init__(self, drive):
        self._drive, self.told = drive, []

    def __getattr__(self, name):
        return getattr(self._drive, name)

    def note(self, what):
        self.told.append((what, self._drive.plant.time_s))

    def enable(self, mode):
        self.note("on")
        self._drive.enable(mode)

    def disable(self):
        self.note("off")
        self._drive.disable()

    def quick_stop(self):
        self.note("quick stop")
        self._drive.quick_stop()

    def set_brake(self, released, confirmed=True):
        self.note(("release" if released else "set") if confirmed else "drop")
        self._drive.set_brake(released, confirmed)

    def exchange(self, command):
        return self._drive.exchange(command)

    def at(self, what, last=False):
        """When it was told so, first or last."""
        times = [time_s for one, time_s in self.told if one == what]
        return times[-1 if last else 0]


class Run:
    """A run of a loop whose joint has a brake, begun with the arm at an angle."""

    def __init__(self, configuration, procedure, stop=None, at_rad=0.0, load_kg=0.0):
        self.drive = Watched(make_equipment(configuration).drive)
        self.drive.open(PERIOD_S)
        self.drive.hang_load(load_kg, False)
        self.plant.place(at_rad, at_rad)
        brake = brake_of(configuration, self.drive)
        joint = ControlledJoint(self.drive, Guard(configuration.limits), CurrentServo(configuration.rig), brake=brake)
        self.sink = ListSink()
        loop = ControlLoop(SingleJoint(joint), VirtualClock(), PERIOD_S)
        self.outcome = loop.run(procedure(configuration), self.sink, stop or StopRequest())
        self.brake = brake

    @property
    def plant(self):
        return self.drive._drive.plant

    @property
    def fallen_rad(self):
        """How far the arm goes within a second of the end of the run."""
        before_rad = self.plant.truth().arm_rad
        for _ in range(200):
            self.drive.exchange(OFF)
        return abs(self.plant.truth().arm_rad - before_rad)

    def channel(self, name):
        return np.vstack(self.sink.blocks)[:, RECORDED.index(name)]


def stay(configuration, seconds=0.3):
    """Hold the joint where it stands, then end."""
    joint = Joint(configuration)
    reading = yield from joint.wake()
    here_rad = reading.sample.position_rad
    for _ in range(round(seconds / PERIOD_S)):
        yield from joint.follow([(here_rad, 0.0)])
    return {"held_rad": here_rad}


def test_the_order_and_what_is_waited_for():
    ran = Run(configured(OUTPUT), stay, at_rad=RAISED_RAD, load_kg=LOAD_KG)
    assert ran.outcome.outcome == "completed", ran.outcome.reason
    assert [what for what, _ in ran.drive.told] == ["on", "release", "set", "off"]
    assert ran.drive.at("release") - ran.drive.at("on") >= LOOK_S - 1e-9
    assert ran.drive.at("off") - ran.drive.at("set") >= 0.08 + TRUST_S - 1e-9
    assert [detail for _, name, detail in ran.sink.events if name == "brake"] == [
        "set", "released", "about to be set", "set", "holds",
    ]  # fmt: skip
    # no motion is asked for until the brake has had its time
    assert ran.outcome.results["held_rad"] == pytest.approx(RAISED_RAD, abs=0.01)
    assert ran.fallen_rad < 0.01
    assert ran.plant.truth().arm_rad == pytest.approx(RAISED_RAD, abs=0.03)


def test_a_drive_that_is_to_home_holds_the_joint_meanwhile_and_does_not_search():
    bench = configured(OUTPUT)
    brake = brake_of(bench, make_equipment(bench).drive)
    reading = Reading(0.0, Sample(*[0.0] * 8, Status.DISABLED), 0.0, 0.0)
    brake.watch(reading, Action(Command(Mode.HOME, 1.0)), "")
    assert brake.hold(reading).command == Command(Mode.HOME, 0.0)


def test_a_bench_that_does_not_know_of_the_brake_moves_nothing():
    outcome = Ran(configured({"by": "none"}), "steps", repeats=1).outcomes[0]
    assert outcome.outcome in ("tripped", "failed")


def test_without_a_brake_the_same_arm_falls():
    ran = Run(configured({"by": "none"}, plant={"torque_n_m": 0.0}), stay, at_rad=RAISED_RAD, load_kg=LOAD_KG)
    assert ran.fallen_rad > 0.5


def test_a_brake_that_does_not_hold_is_found_while_the_drive_still_can():
    ran = Run(configured(OUTPUT, plant={"torque_n_m": 1e-4}), stay, at_rad=RAISED_RAD, load_kg=LOAD_KG)
    assert ran.outcome.outcome == "tripped"
    assert "with the brake set" in ran.outcome.reason
    assert "move_rad" in ran.outcome.reason
    assert ran.drive.told[-1][0] == "off"


def test_a_brake_slower_than_its_time_is_found():
    ran = Run(configured(OUTPUT, plant={"engage_s": 2.0}), stay, at_rad=RAISED_RAD, load_kg=LOAD_KG)
    assert ran.outcome.outcome == "tripped"
    assert "it does not hold the joint" in ran.outcome.reason


def test_a_joint_that_sinks_after_the_release_is_stopped():
    weak = configured(OUTPUT, servo={"current_a": 0.01})
    ran = Run(weak, stay, at_rad=RAISED_RAD, load_kg=LOAD_KG)
    assert ran.outcome.outcome == "tripped"
    assert "way after the brake was released" in ran.outcome.reason
    assert ran.fallen_rad < 0.3, "the brake caught it"


def _told_to(configuration, seconds, stop):
    inner = stay(configuration, 5.0)
    reading = yield next(inner)
    while True:
        if reading.time_s >= seconds:
            stop.ask("the test")
        reading = yield inner.send(reading)


def test_stop_sets_it_at_once_and_waits_for_nothing():
    stop = StopRequest()
    ran = Run(configured(OUTPUT), lambda bench: _told_to(bench, 0.5, stop), stop, RAISED_RAD, LOAD_KG)
    assert (ran.outcome.outcome, ran.outcome.reason) == ("stopped", "the test")
    words = [what for what, _ in ran.drive.told]
    assert words[:4] == ["on", "release", "drop", "quick stop"]
    assert ran.drive.at("quick stop") == ran.drive.at("drop")
    assert words[-1] == "set"  # said again, and confirmed, once the power is off
    assert ran.fallen_rad < 0.05


def test_a_fault_sets_it_at_once():
    faulty = configured(OUTPUT, faults=[{"kind": "over-current", "at_s": 0.5}])
    ran = Run(faulty, lambda bench: stay(bench, 5.0), at_rad=RAISED_RAD, load_kg=LOAD_KG)
    assert ran.outcome.outcome == "failed"
    assert ran.drive.at("drop") - 0.5 <= 2.0 * PERIOD_S + 1e-9
    assert not ran.drive._drive._brake.is_released


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


def test_stop_while_the_brake_is_released_ends_the_run_within_a_cycle():
    ran = Run(configured({**OUTPUT, "release_s": 2.0}), stay, StopsSoon(60), RAISED_RAD, LOAD_KG)
    assert (ran.outcome.outcome, ran.outcome.reason) == ("stopped", "the test")
    assert ran.outcome.cycles <= 60
    assert ran.drive.at("drop") > ran.drive.at("release")
    assert not ran.drive._drive._brake.is_released
    assert ran.drive.exchange(OFF).status is Status.DISABLED


def test_an_output_that_the_drive_has_not_is_refused_before_anything_is_opened():
    with pytest.raises(ConfigurationError, match="has no output that this bench can set"):
        brake_of(configured(OUTPUT), FakeDrive())
    assert brake_of(configured({"by": "none"}), FakeDrive()) is None


def test_a_coast_without_power_is_refused_where_the_drive_would_set_its_brake():
    kind = find_kind("coast-down")
    with pytest.raises(ConfigurationError, match=r"drive\.brake\.by is 'drive'"):
        kind.refuse(parse_parameters(kind, {"released": "off"}), configured({"by": "drive"}))
    kind.refuse(parse_parameters(kind, {"released": "off"}), configured(OUTPUT))
    kind.refuse(parse_parameters(kind, {}), configured({"by": "drive"}))
