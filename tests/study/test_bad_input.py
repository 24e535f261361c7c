"""Bad recordings, as a user meets them: one sentence that says what is wrong and what to do, never a ranking of noise.

Each case goes through the commands: `study new`, `study diagnose`, `study suggest`, with and without --json.
"""

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.cli.exit_codes import ExitCode
from bench.config.configuration import default_configuration
from bench.config.rig import Rig
from bench.evaluation.challenge.session import record
from bench.recording_set import import_recording_set
from bench.recording_set.recording_set import RecordingSet
from bench.store import Store
from bench.study.material import facts_of
from compensator.lab.diagnosis.data_checks import data_problems
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import Bench, Plan, plans, recordings
from tests.study.conftest import RIG

SHORT = Bench(duration_s=9.0, rate_hz=100.0)
LOADS_KG = (0.0, 0.25)
Change = Callable[[Recording], None]


def every(change: Change) -> Callable[[list[Recording]], list[Recording]]:
    """Every trial altered."""

    def altered(made: list[Recording]) -> list[Recording]:
        for recording in made:
            change(recording)
        return made

    return altered


def first(change: Change) -> Callable[[list[Recording]], list[Recording]]:
    """The first trial altered."""
    return lambda made: every(change)(made[:1]) + made[1:]


def put(name: str, of: Callable[[np.ndarray], np.ndarray]) -> Change:
    def change(recording: Recording) -> None:
        recording.channels[name] = of(recording.channels[name])

    return change


def add(name: str, of: Callable[[dict[str, np.ndarray]], np.ndarray]) -> Change:
    def change(recording: Recording) -> None:
        recording.channels[name] = of(recording.channels)

    return change


def without(name: str) -> Change:
    return lambda recording: recording.channels.pop(name) is None


def part(count: int) -> Change:
    def change(recording: Recording) -> None:
        recording.channels.update({name: values[:count] for name, values in recording.channels.items()})

    return change


def grams(recording: Recording) -> None:
    recording.conditions["load_kg"] *= 1000.0


def swapped(made: list[Recording]) -> list[Recording]:
    for recording in made:
        recording.conditions["load_kg"] = sum(LOADS_KG) - recording.conditions["load_kg"]
    return made


def warmer_with_load(recording: Recording) -> None:
    recording.channels["temperature_c"] = (
        25.0 + 40.0 * recording.conditions["load_kg"] + 0.0 * recording.channels["time_s"]
    )


def speed(channels: dict[str, np.ndarray]) -> np.ndarray:
    return np.gradient(channels["position_rad"], channels["time_s"])


def as_unsigned(torque: np.ndarray) -> np.ndarray:
    return np.mod(np.round(1000.0 * torque), 65536.0) / 1000.0


def every_other_empty(values: np.ndarray) -> np.ndarray:
    return np.where(np.arange(len(values)) % 2, np.nan, values)


def in_degrees(recording: Recording) -> None:
    recording.channels["velocity_rad_s"] = speed(recording.channels)
    recording.channels["position_rad"] = np.degrees(recording.channels["position_rad"])


def against(recording: Recording) -> None:
    recording.channels["velocity_rad_s"] = -speed(recording.channels)


def stuck_half_the_time(recording: Recording) -> None:
    recording.channels["velocity_rad_s"] = speed(recording.channels)
    count = np.arange(len(recording))
    seen = np.where(count % 300 < 150, count // 300 * 300, count)
    recording.channels["position_rad"] = recording.channels["position_rad"][seen]


def duty_of_an_unsigned_register(recording: Recording) -> None:
    recording.channels["duty"] = np.mod(np.round(100.0 * recording.channels.pop("torque_n_m")), 65536.0) / 1000.0
    recording.channels["supply_v"] = np.full(len(recording), 12.0)


Alter = Callable[[list[Recording]], list[Recording]]


@dataclass(frozen=True)
class Bad:
    """What is done to good recordings, and the words that the answer must hold."""

    alter: Alter
    words: str
    rig: Rig = RIG


REFUSED = {
    "a constant effort": Bad(
        every(put("torque_n_m", lambda x: 0.0 * x + 0.3)), "torque_n_m is 0.3 N m all the time; check"
    ),
    "no effort": Bad(
        every(without("torque_n_m")), "has no effort channel: found position_rad, temperature_c, time_s; wanted"
    ),
    "no effort in one trial": Bad(first(without("torque_n_m")), "'load-0g-0-1' has no effort channel"),
    "no position": Bad(every(without("position_rad")), "channel position_rad is missing"),
    "no motion": Bad(
        every(put("position_rad", lambda x: 0.0 * x + 0.3)),
        "does not move in any trial, under .* breakaway lies beyond that on either side; record trials with",
    ),
    "a jitter for motion": Bad(
        every(put("position_rad", lambda x: 1e-4 * np.round(np.random.default_rng(0).random(len(x))))),
        "rows count, and at least 40 are needed: the joint moves faster than",
    ),
    "saturated": Bad(
        every(add("duty", lambda c: np.sign(c["torque_n_m"]))), "duty is at its limit in 100% of the samples"
    ),
    "power off": Bad(
        every(add("enabled", lambda c: 0.0 * c["time_s"])), "the power stage is off in 100% of the samples"
    ),
    "holes": Bad(every(put("torque_n_m", every_other_empty)), "torque_n_m is missing in 50% of the samples"),
    "milliseconds": Bad(every(put("time_s", lambda t: 1e3 * t)), "check that time_s is in seconds"),
    "nothing but short trials": Bad(every(part(50)), "record longer, choose a higher cut-off, or leave the trial out"),
    "degrees": Bad(every(in_degrees), r"velocity_rad_s differ by a factor of 57.* \(degrees\?\)"),
    "degrees beside a set point": Bad(
        every(add("target_rad", lambda c: np.radians(c["position_rad"]))),
        "position_rad and target_rad differ by a factor of 57",
    ),
    "speed the other way": Bad(every(against), "position_rad and velocity_rad_s have opposite signs"),
    "a position that wraps": Bad(
        every(put("position_rad", lambda q: np.mod(q, 1.0))),
        r"against the motion at .* it wraps, every (1|0\.99\d*|1\.00\d*) rad; unwrap it in a mapping \(",
    ),
    "a position that wraps once a turn": Bad(
        every(put("position_rad", lambda q: np.mod(10 * q, 2 * np.pi))), "it wraps, once a turn; unwrap it"
    ),
    "unsigned effort": Bad(every(put("torque_n_m", as_unsigned)), "signed values were read as unsigned"),
    "unsigned duty": Bad(every(duty_of_an_unsigned_register), "duty goes up to 65.*, wanted is -1 .. 1"),
}

WRONG = {
    "turned effort": Bad(
        every(put("torque_n_m", np.negative)), "opposite signs .*; turn the sign of torque_n_m, or of position"
    ),
    "one turned trial": Bad(
        lambda made: first(put("torque_n_m", np.negative))(made), "trial 'load-0g-0-1' has the other sign"
    ),
    "milliamperes": Bad(
        every(put("torque_n_m", lambda x: 1e3 * x)), "the loads seem to weigh .* check the units of torque_n_m"
    ),
    "grams": Bad(every(grams), "the loads seem to weigh 0.001 times what load_kg and arm_m say"),
    "loads mixed up": Bad(swapped, "the loads seem to weigh nothing: .* which trial had which load"),
    "clocks apart": Bad(
        every(put("torque_n_m", lambda x: np.roll(x, 80))), "the effort is about 0.8 s behind the motion"
    ),
    "a sensor that is stuck": Bad(
        every(stuck_half_the_time), r"position_rad stands still from 0 to 1.49 s, .* the sensor is stuck .*; leave"
    ),
    "noise for effort": Bad(
        every(put("torque_n_m", lambda x: np.random.default_rng(3).standard_normal(len(x)))), "explain next to nothing"
    ),
}


@pytest.fixture
def ask(tmp_path: Path) -> Callable[..., tuple[int, str, str]]:
    """The commands on a store of their own: exit code, stdout, stderr."""
    url = f"sqlite:///{tmp_path / 'bench.sqlite'}"

    def run(*words: str) -> tuple[int, str, str]:
        found = CliRunner().invoke(app, ["--store", url, *words])
        if found.exception is not None and not isinstance(found.exception, SystemExit):
            raise found.exception  # a traceback is what no user should see
        return found.exit_code, found.stdout, found.stderr

    run.url = url
    return run


def kept(ask: Callable[..., tuple[int, str, str]], bad: Bad, trials: list[Plan] | None = None) -> None:
    made = bad.alter(recordings(bench=SHORT, trials=trials or plans(LOADS_KG), seed=3))
    with Store.open(ask.url) as store:
        import_recording_set(store, RecordingSet("set", bad.rig, made), "known joint")


@pytest.mark.parametrize("samples", [2, 50])
def test_a_trial_too_short_for_the_filter_is_left_out_and_named(ask, samples):
    kept(ask, Bad(first(part(samples)), ""))
    code, out, _ = ask("study", "new", "s", "--experiment", "1")
    assert code == 0
    assert re.search(r"too short for the low-pass of .* Hz, and left out: load-0g", out)


@pytest.mark.parametrize("what", REFUSED)
@pytest.mark.parametrize("form", [(), ("--json",)], ids=["text", "json"])
def test_what_cannot_be_a_study_is_refused_with_a_sentence(ask, what, form):
    kept(ask, REFUSED[what])
    code, out, told = ask("study", "new", "s", "--experiment", "1", *form)
    assert code == ExitCode.REFUSED
    assert out == ""
    assert told.startswith("error: ")
    assert len(told.splitlines()) == 1
    assert re.search(REFUSED[what].words, told), told


@pytest.mark.parametrize("what", WRONG)
def test_wrong_data_are_the_answer_and_nothing_is_ranked(ask, what):
    kept(ask, WRONG[what])
    assert ask("study", "new", "s", "--experiment", "1")[0] == ExitCode.DONE
    code, out, _ = ask("study", "diagnose", "1", "--json")
    found = json.loads(out)
    assert code == ExitCode.DONE
    assert (found["verdict"], found["ranking"], found["classes"], found["p_value"]) == ("data-problem", [], [], None)
    assert any(re.search(WRONG[what].words, problem) for problem in found["data_problems"])
    assert any(problem in found["sentence"] for problem in found["data_problems"])
    assert found["sentence"] in " ".join(ask("study", "diagnose", "1")[1].split())


def test_compare_tells_what_is_wrong_with_the_data_too(ask):
    kept(ask, WRONG["grams"])
    ask("study", "new", "s", "--experiment", "1")
    code, out, _ = ask("study", "compare", "1", "--json")
    assert code == ExitCode.DONE
    assert any(note.startswith("Data: the loads seem to weigh 0.001 times") for note in json.loads(out)["notes"])


def test_one_trial_ranks_nothing_and_says_how_much_more_is_needed(ask):
    kept(ask, Bad(lambda made: made[:1], ""))
    ask("study", "new", "s", "--experiment", "1")
    code, out, _ = ask("study", "diagnose", "1", "--json")
    found = json.loads(out)
    assert (code, found["verdict"], found["ranking"]) == (ExitCode.DONE, "nothing", [])
    assert re.search(r"too short to tell .* record \d+ more seconds of motion at least; other loads", found["sentence"])


def test_loads_in_step_with_warmth_are_told_with_the_trial_that_would_separate_them(ask):
    kept(ask, Bad(every(warmer_with_load), ""))
    ask("study", "new", "s", "--experiment", "1")
    problems = json.loads(ask("study", "diagnose", "1", "--json")[1])["data_problems"]
    assert any(
        "the heavier the load, the warmer" in one and "repeat the first load at the end" in one for one in problems
    )


def test_a_trial_that_tells_what_all_others_leave_open_is_not_called_turned():
    """Motions of a joint with free play, of which nearly all rows that slide on one flank are in the last trial."""
    configuration = default_configuration()
    motions = {"loads_kg": [0.0, 0.1], "waveforms": ["multisine"], "duration_s": 6.0, "repeats": 2}
    swing = {"loads_kg": [0.1], "waveforms": ["slow-sine"], "speed_rad_s": 4.8, "amplitude_rad": 1.6, "repeats": 1}
    recorded = record(configuration, [("excitation", motions), ("excitation", swing)])
    facts = facts_of(configuration.rig)
    assert data_problems(fit_model(make_dataset(recorded, facts, Processing()), default_effects(facts))) == []
