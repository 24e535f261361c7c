"""`[[drive.faults]]` of bench.toml: what is refused, and how a run with each ends on record."""

import time

import pytest

from bench.config.configuration import parse_configuration, read_configuration
from bench.control.drive_factory import make_equipment
from bench.errors import ConfigurationError
from bench.runs.runner import Runner
from bench.store import Store
from drivers.contract import Command, Mode, Status
from tests.experiments.bench_run import Ran


def configured(*faults):
    return parse_configuration({"name": "b", "rig": RIG, "drive": {"faults": list(faults)}}, "bench.toml")


RIG = {
    "name": "paper",
    "motor": {"resistance_ohm": 8.0, "torque_constant_n_m_a": 0.05, "back_emf_v_s_rad": 0.05},
    "gear": {"ratio": 20.0, "backlash_rad": 0.01},
    "arm": {"length_m": 0.5, "mass_kg": 0.3, "centre_of_mass_m": 0.0, "inertia_kg_m2": 0.01},
    "sensor": {"counts_per_turn": 4096},
}
KINDS = "encoder-stuck, encoder-jump, samples-lost, samples-late, over-temperature, over-current, supply-lost"


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ({"kind": "encoder-stuck"}, r"drive.faults.0.at_s: missing; give a value in s"),
        ({"kind": "encoder-stuck", "at_s": -1}, r"at_s: found -1; should be greater than or equal to 0 s"),
        ({"kind": "encoder-stuck", "at_s": 1, "for_s": 0}, r"for_s: found 0; should be greater than 0 s"),
        ({"kind": "encoder-jump", "at_s": 1}, r"drive.faults.0.jump_rad: missing; give a value in rad"),
        ({"kind": "samples-late", "at_s": 1, "age_s": 3}, r"age_s: found 3; should be less than or equal to 1 s"),
        ({"kind": "over-current", "at_s": 1, "jump_rad": 1}, r"jump_rad: unknown key"),
        ({"kind": "over-current", "at_s": 1, "clock": "sun"}, r"clock: found 'sun'; should be 'drive' or 'wall'"),
        ({"kind": "gremlin", "at_s": 1}, rf"kind should be one of {KINDS}"),
    ],
)
def test_impossible_faults_are_refused_with_key_value_bound_and_unit(fault, message):
    with pytest.raises(ConfigurationError, match=message):
        configured(fault)


def test_two_of_a_kind_at_a_time_are_refused():
    twice = configured({"kind": "encoder-stuck", "at_s": 1}, {"kind": "encoder-stuck", "at_s": 2})
    with pytest.raises(ConfigurationError, match=r"EncoderStuck.start_s = 2 \[s\]: the one of 1 s is not over"):
        make_equipment(twice)


def test_faults_are_read_from_a_file(tmp_path):
    text = 'name = "b"\n[rig]\nname = "r"\n[[drive.faults]]\nkind = "load-falls"\nat_s = 2.5\n'
    (tmp_path / "bench.toml").write_text(text)
    (fault,) = read_configuration(tmp_path / "bench.toml").drive.faults
    assert (fault.kind, fault.at_s, fault.for_s, fault.clock) == ("load-falls", 2.5, None, "drive")


ENDS = [
    ({"kind": "encoder-stuck", "at_s": 0.4}, "tripped", "tracking error"),
    ({"kind": "encoder-jump", "at_s": 0.4, "jump_rad": 1.0}, "tripped", "speed"),
    ({"kind": "samples-lost", "at_s": 0.4}, "failed", "no answer to the command of 0.4000 s"),
    ({"kind": "samples-late", "at_s": 0.4, "age_s": 0.3}, "tripped", "age of the sample"),
    ({"kind": "over-temperature", "at_s": 0.4}, "failed", "over-temperature, 95 degC"),
    ({"kind": "over-current", "at_s": 0.4, "current_a": 12.0}, "failed", "over-current, 12 A"),
    ({"kind": "supply-lost", "at_s": 0.4}, "failed", "under-voltage"),
    ({"kind": "drive-failed", "at_s": 0.4, "text": "brake open"}, "failed", "brake open"),
    ({"kind": "torque-disabled", "at_s": 0.4}, "failed", "safe torque off is active"),
]


@pytest.mark.parametrize(("fault", "outcome", "reason"), ENDS, ids=lambda value: getattr(value, "get", str)("kind"))
def test_run_ends_as_the_record_should_say(fault, outcome, reason):
    ran = Ran(configured(fault), "steps", repeats=1)
    assert ran.outcomes[0].outcome == outcome
    assert reason in ran.outcomes[0].reason
    assert ran.channel(0, "time_s")[-1] < 1.5


@pytest.mark.parametrize(
    "fault", [{"kind": "load-falls", "at_s": 0.4}, {"kind": "clutch-slips", "at_s": 0.4, "limit_n_m": 0.1}]
)
def test_load_that_falls_or_slips_is_a_trial_like_any_other_to_the_drive(fault):
    ran, honest = Ran(configured(fault), "steps", repeats=1), Ran(configured(), "steps", repeats=1)
    assert ran.outcomes[0].outcome == honest.outcomes[0].outcome == "completed"
    assert ran.summary != honest.summary


def test_fault_by_the_wall_clock_comes_when_the_wall_says_so():
    drive = make_equipment(configured({"kind": "drive-failed", "at_s": 0.3, "clock": "wall"})).drive
    began = time.monotonic()
    drive.open(0.005)
    while drive.exchange(Command(Mode.OFF)).status is not Status.FAULT:
        assert time.monotonic() - began < 30.0
    assert time.monotonic() - began >= 0.29
    # the drive's own time has run far ahead
    assert drive.exchange(Command(Mode.OFF)).time_s > 1.0


def test_fault_ends_a_run_of_the_runner_on_record(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
        runner = Runner(configured({"kind": "supply-lost", "at_s": 0.4}), store)
        identity = runner.start("steps", {"repeats": 2}, pace="fast")
        assert runner.wait(60.0)
        runner.close()
        experiment = store.experiment(identity)
        assert experiment.outcome == "failed"
        assert "under-voltage" in experiment.reason
