"""The commissioning move finds wrong signs and scales; without its pass a real drive runs nothing."""

from dataclasses import replace
from math import nan, pi, sin

import pytest

from bench.config.configuration import default_configuration, parse_configuration
from bench.control import station
from bench.control.commissioned import fingerprint
from bench.control.cycle import Reading
from bench.control.drive_factory import Equipment
from bench.errors import ConfigurationError, LimitError, NotCommissionedError
from bench.experiments.analysis.commissioning_checks import Push, findings, position_findings
from bench.runs.runner import Runner
from bench.store import Store
from drivers.contract import Command, Mode, OwnLimit, Sample, Status
from tests.control.fake_drive import RATIO, RIG, FakeDrive
from tests.experiments.bench_run import Ran

PERIOD_S = 0.01
RESISTANCE_OHM, BACK_EMF_V_S_RAD, SUPPLY_V = 4.0, 0.02, 24.0  # of RIG


def readings(direction, sign=1.0, velocity=1.0, current=1.0, counts=1.0):
    """A push by hand: 0.2 s of rising current at rest, then 0.2 s of 5 rad/s2; what is wrong is a factor."""
    found = []
    for cycle in range(40):
        time_s = cycle * PERIOD_S
        moving_s = max(0.0, time_s - 0.2)
        current_a = direction * min(2.0 * time_s, 0.4)
        true_rad_s = direction * 5.0 * moving_s
        duty = (RESISTANCE_OHM * current_a + BACK_EMF_V_S_RAD * RATIO * true_rad_s) / SUPPLY_V
        position_rad = direction * 2.5 * moving_s**2 * counts * sign
        velocity_rad_s = true_rad_s * counts * sign * velocity
        sample = Sample(
            time_s, 0.0, position_rad, velocity_rad_s, duty, current_a * current, SUPPLY_V, 25.0, Status.ENABLED
        )
        found.append(Reading(time_s, sample, velocity_rad_s, current_a * current))
    return found


def found_wrong(**wrong):
    pushes = [Push(direction, readings(direction, **wrong), []) for direction in (1, -1)]
    return {finding.name: finding for finding in findings(pushes, RIG)}


def test_a_right_drive_passes_every_check():
    found = found_wrong()
    assert [finding.passed for finding in found.values()] == [True] * 4
    assert "4 ohm and 0.02 V s/rad, 1.00 and 1.00 of what the rig says" in found["ratio"].sentence


@pytest.mark.parametrize(
    ("wrong", "check", "message"),
    [
        ({"sign": -1.0}, "sign", "turned -0.0902 rad on a demand of sign +1"),
        ({"velocity": 9.5493}, "velocity", "is 9.55 .. 9.55 of the way"),  # rpm for rad/s
        ({"velocity": -1.0}, "velocity", "is -1.00 .. -1.00 of the way"),
        ({"current": -1.0}, "current", "-0.295 A while the joint went +0.0902 rad"),
        ({"counts": 4.0}, "ratio", "0.25 of what the rig says"),  # counted lines for counts
        ({"counts": 0.25}, "ratio", "4.00 of what the rig says"),
        ({"current": 10.0}, "ratio", "0.10 and"),  # a scale of another drive
    ],
)
def test_what_is_wrong_is_named(wrong, check, message):
    finding = found_wrong(**wrong)[check]
    assert finding.passed is False
    assert message in finding.sentence


def test_what_is_not_measured_is_not_passed_either():
    found = found_wrong(velocity=float("nan"), current=float("nan"))
    assert [found[name].passed for name in ("velocity", "current", "ratio")] == [None] * 3


def test_the_move_on_the_simulated_bench():
    ran = Ran(default_configuration(), "commissioning")
    assert ran.outcomes[0].outcome == "completed"
    forward_rad, back_rad = ran.summary["travel_rad"]
    assert 0.14 < forward_rad < 0.4
    assert -0.4 < back_rad < -0.14
    assert ran.summary["passed"] == ["sign", "velocity"]  # this drive measures no current
    assert ran.channel(0, "enabled")[-1] == 0.0


def measuring_current():
    """The simulated bench, whose drive measures current here: the ratio can be checked."""
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    return parse_configuration(
        values | {"drive": {"kind": "sim", "plant": {"current_sensor": {"present": True}}}}, "bench.toml"
    )


def test_a_push_too_short_for_the_ratio_is_made_again_longer():
    ran = Ran(measuring_current(), "commissioning", excursion_rad=0.02)
    assert ran.summary["passed"] == ["sign", "velocity", "current", "ratio"]
    assert 0.039 < ran.summary["travel_rad"][0] < 0.1
    assert ran.channel(0, "enabled")[-1] == 0.0


def test_no_push_is_longer_than_the_limits_leave_room_for():
    configuration = measuring_current()
    limits = configuration.limits.model_copy(update={"position_max_rad": 0.53, "position_min_rad": -0.53})
    ran = Ran(configuration.model_copy(update={"limits": limits}), "commissioning", excursion_rad=0.02)
    assert ran.summary["not_checked"] == ["ratio"]
    assert "ask for a longer excursion" in ran.summary["sentences"][-1]
    assert ran.summary["travel_rad"][0] < 0.039


def test_a_joint_that_is_held_ends_the_move_and_says_so():
    configuration = default_configuration()
    search = configuration.search.model_copy(update={"ceiling_a": 0.02})
    ran = Ran(configuration.model_copy(update={"search": search}), "commissioning")
    assert ran.outcomes[0].outcome == "failed"
    assert "at 0.02 A (search.ceiling_a); 0.15 rad is wanted" in ran.outcomes[0].reason


def test_an_excursion_outside_the_limits_is_refused():
    configuration = default_configuration()
    limits = configuration.limits.model_copy(update={"position_max_rad": 0.4})
    with pytest.raises(LimitError, match=r"angle 0 is 0 rad; allowed is -1.55 .. -0.25"):
        Ran(configuration.model_copy(update={"limits": limits}), "commissioning")


PROVENANCE = {
    "drive": {"device": "d", "vendor": "v", "product": "p", "firmware": "1", "serial": "", "max_rate_hz": 100.0},
    "configuration": {"drive": {"kind": "roboclaw", "zero_rad": 0.0}, "rig": {"gear": {"ratio": 20.0}}},
}


def test_a_pass_holds_for_one_drive_with_one_configuration():
    same = PROVENANCE | {"drive": PROVENANCE["drive"] | {"max_rate_hz": 99.0}}
    assert fingerprint(same) == fingerprint(PROVENANCE)
    other_firmware = PROVENANCE | {"drive": PROVENANCE["drive"] | {"firmware": "2"}}
    other_gear = PROVENANCE | {"configuration": PROVENANCE["configuration"] | {"rig": {"gear": {"ratio": 21.0}}}}
    assert len({fingerprint(found) for found in (PROVENANCE, other_firmware, other_gear)}) == 3


class PositionDrive(FakeDrive):
    """Closes positions, and takes nothing else; `share` of what it is asked for."""

    def __init__(self, share: float = 1.0) -> None:
        super().__init__(modes=frozenset({Mode.POSITION}))
        self.share = share

    def exchange(self, command: Command) -> Sample:
        if command.mode is Mode.POSITION:
            assert self.powered
            before_rad, self.position_rad = self.position_rad, self.share * command.value
            sample = super().exchange(Command(Mode.OFF))
            return sample._replace(velocity_rad_s=(self.position_rad - before_rad) / self._period_s)
        assert command.mode is Mode.OFF
        return super().exchange(command)


@pytest.fixture
def fake():
    return FakeDrive()


@pytest.fixture
def real_bench(monkeypatch, tmp_path, fake):
    """A bench whose drive is a real one, by its configuration; and the function that makes its runner."""
    drive = fake
    monkeypatch.setattr(station, "make_equipment", lambda _configuration, _ask: Equipment(drive, drive))
    values = default_configuration().model_dump(mode="json", exclude_none=True)
    values["rig"] = RIG.model_dump(exclude_none=True)
    values["drive"] = {"kind": "roboclaw", "port": "/dev/ttyACM0"}
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
        yield (
            store,
            lambda closed_by="bench", **drive: Runner(
                parse_configuration(
                    values | {"drive": values["drive"] | drive, "servo": {"closed_by": closed_by}}, "bench.toml"
                ),
                store,
            ),
        )


def test_a_real_drive_runs_nothing_before_it_has_passed(real_bench):
    store, make_runner = real_bench
    runner = make_runner()
    with pytest.raises(NotCommissionedError, match=r"run 'friction-bench doctor --move'"):
        runner.start("steps", {"repeats": 1})
    assert store.experiments()[0].outcome == "refused"
    runner.start("commissioning", {})
    assert runner.wait(60.0)
    assert store.experiments()[0].outcome == "completed", store.experiments()[0].reason
    runner.start("steps", {"repeats": 1})
    runner.close()
    changed = make_runner(motor_sign=-1)
    with pytest.raises(NotCommissionedError):
        changed.start("steps", {"repeats": 1})


def test_a_move_that_failed_is_no_pass(real_bench):
    store, make_runner = real_bench
    runner = make_runner()
    runner.start("commissioning", {"excursion_rad": 0.5, "rate_a_s": 10.0, "coast_s": 0.01})
    assert runner.wait(60.0)
    assert store.experiments()[0].outcome == "failed"
    with pytest.raises(NotCommissionedError):
        runner.start("steps", {"repeats": 1})


class HeldBack(FakeDrive):
    """Lets no current flow that would move the joint, and says so."""

    def __init__(self) -> None:
        super().__init__()
        self.friction_n_m = 50.0

    def describe(self):
        limit = OwnLimit(0.1, "The drive limits the motor current to 0.1 A (max torque); current_limit_a sets it.")
        return replace(super().describe(), own_limit=limit)


@pytest.mark.parametrize("fake", [HeldBack()])
def test_a_joint_that_stands_is_told_the_drives_own_limit_first(real_bench):
    store, make_runner = real_bench
    runner = make_runner()
    runner.start("commissioning", {})
    assert runner.wait(60.0)
    said = store.experiments()[0].reason
    assert (
        "0.1 A (max torque); current_limit_a sets it (servo.current_a is 1.6 A and search.ceiling_a is 1.5 A); " in said
    )
    assert said.index("The drive limits the motor current") < said.index("the joint moved by")


@pytest.mark.parametrize("fake", [PositionDrive()])
def test_a_drive_that_takes_positions_alone_is_moved_by_positions(real_bench):
    store, make_runner = real_bench
    runner = make_runner(closed_by="drive")
    runner.start("commissioning", {})
    assert runner.wait(60.0)
    record = store.experiments()[0]
    assert record.outcome == "completed", record.reason
    assert record.results["travel_rad"] == pytest.approx([0.15, -0.15], abs=2e-3)
    assert record.results["passed"] == ["velocity"]
    assert "Where you saw the arm turn the other way" in record.results["sentences"][0]
    with pytest.raises(LimitError, match="steps needs the mode current of the drive, and drive 'fake' has position"):
        runner.start("steps", {"repeats": 1})
    runner.start("reversals", {"amplitudes_rad": [0.2], "strokes": 2})
    runner.close()


@pytest.mark.parametrize("fake", [PositionDrive()])
def test_a_position_loop_of_the_bench_is_refused_for_it(real_bench):
    _, make_runner = real_bench
    with pytest.raises(ConfigurationError, match=r"takes neither current nor duty .* set servo.closed_by = 'drive'"):
        make_runner().start("commissioning", {})


@pytest.mark.parametrize("fake", [PositionDrive(share=0.5)])
def test_a_drive_that_does_not_get_there_has_not_passed(real_bench):
    store, make_runner = real_bench
    runner = make_runner(closed_by="drive")
    runner.start("commissioning", {"coast_s": 0.2})
    assert runner.wait(60.0)
    assert store.experiments()[0].outcome == "failed"
    assert "Look at the gains of the drive's own position loop" in store.experiments()[0].reason


def way(direction, sign=1.0):
    """A slow move by hand, with friction and a little noise in the current."""
    made = []
    for cycle in range(60):
        current_a = sign * direction * 0.2 + 0.05 * (-1) ** cycle + 0.3  # 0.3 A of gravity
        position_rad = direction * 0.003 * cycle
        sample = Sample(cycle * PERIOD_S, 0.0, position_rad, direction * 0.3, nan, current_a, nan, nan, Status.ENABLED)
        made.append(Reading(sample.time_s, sample, direction * 0.3, current_a))
    return Push(direction, made, [])


@pytest.mark.parametrize(("sign", "passed"), [(1.0, True), (-1.0, False), (0.0, None)])
def test_the_sign_of_the_current_is_seen_by_friction(sign, passed):
    found = {one.name: one for one in position_findings([way(1, sign), way(-1, sign)], RIG)}
    assert found["current"].passed is passed, found["current"].sentence
    assert found["velocity"].passed
    assert found["ratio"].passed is None


# four rows of a drive that follows each set point of a profile to a stop; speed [rad/s] and current [A]
STOP_AND_GO = ((0.06, 0.67), (0.46, 0.16), (0.52, -0.46), (0.15, -0.12))


def stop_and_go(direction, sign=1.0, friction_a=0.0, offset=0):
    """A move by hand that speeds up and brakes again and again: it brakes while it is fast."""
    made, position_rad = [], 0.0
    for cycle in range(60):
        speed_rad_s, current_a = STOP_AND_GO[(cycle + offset) % 4]
        velocity_rad_s, current_a = direction * speed_rad_s, sign * direction * (current_a + friction_a)
        position_rad += velocity_rad_s * PERIOD_S
        sample = Sample(cycle * PERIOD_S, 0.0, position_rad, nan, nan, current_a, nan, nan, Status.ENABLED)
        made.append(Reading(sample.time_s, sample, velocity_rad_s, current_a))
    return Push(direction, made, [])


@pytest.mark.parametrize("offset", range(4))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_drive_that_stops_at_every_set_point_is_not_accused(sign, offset):
    pushes = [stop_and_go(direction, sign, offset=offset) for direction in (1, -1)]
    found = {one.name: one for one in position_findings(pushes, RIG)}
    assert found["current"].passed is None, found["current"].sentence


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_friction_that_is_large_enough_shows_all_the_same(sign):
    pushes = [stop_and_go(direction, sign, friction_a=0.4) for direction in (1, -1)]
    found = {one.name: one for one in position_findings(pushes, RIG)}
    assert found["current"].passed is (sign > 0.0), found["current"].sentence


def swaying(direction, sign, phase):
    """A move at one speed with a slow oscillation of the current, far above its friction."""
    current_a = [0.02 * direction + 0.3 * sin(2.0 * pi * cycle / 70.0 + phase) for cycle in range(50)]
    made = []
    for cycle, one_a in enumerate(current_a):
        position_rad = direction * 0.003 * cycle
        sample = Sample(cycle * PERIOD_S, 0.0, position_rad, nan, nan, sign * one_a, nan, nan, Status.ENABLED)
        made.append(Reading(sample.time_s, sample, direction * 0.3, sign * one_a))
    return Push(direction, made, [])


@pytest.mark.parametrize("phase", [eighth * pi / 4 for eighth in range(8)])
def test_an_oscillation_of_the_current_is_no_friction(phase):
    pushes = [swaying(1, 1.0, phase), swaying(-1, 1.0, phase + pi)]
    found = {one.name: one for one in position_findings(pushes, RIG)}
    assert found["current"].passed is None, found["current"].sentence


def test_a_new_zero_does_not_ask_for_the_move_again():
    drive = {"kind": "roboclaw", "port": "a", "zero_rad": 0.0}
    bare = PROVENANCE["configuration"]
    first, moved, other = (
        PROVENANCE | {"configuration": bare | {"drive": one}}
        for one in (drive, drive | {"zero_rad": 1.2}, drive | {"port": "b"})
    )
    assert fingerprint(first) == fingerprint(moved)
    assert fingerprint(first) != fingerprint(other)
