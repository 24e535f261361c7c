"""`friction-bench study suggest --start`: rounds on the bench, and how they end."""

import json
from types import SimpleNamespace

import pytest

from bench.cli.exit_codes import ExitCode
from bench.errors import LimitError
from bench.study.models.diagnosis import Diagnosis
from bench.study.models.study import AddedTrial, Extended
from bench.study.suggestion.suggested import PairOfRivals, Suggested, SuggestedTrial
from drivers.errors import DriveError

TRIALS = [
    SuggestedTrial(
        name=name, kind="steps", parameters={"load_kg": 0.1}, minutes=1.0, before=0.0, after=6.0, sentence=""
    )
    for name in "abcd"
]


@pytest.fixture
def started(command, monkeypatch):
    """Runs --start on a bench whose trials end as they are told to; what it prints, and its exit code."""

    def start(*endings, extra=()):
        left, asked = list(endings), []

        def suggested(session, study_id, model_id, most, refused):
            asked.append(sorted(refused))
            offered = [one for one in TRIALS if one.name not in refused][:most] if left else []
            rounds = float(len(asked))
            pair = PairOfRivals(true="spring", rival=None, before=rounds, after=5.0 + rounds, promised=0.0)
            return Suggested.model_construct(study_id=study_id, note="n", trials=offered, pairs=[pair])

        def extend_study(_store, _study, numbers):
            return Extended.model_construct(added=[AddedTrial(trial_id=number, name="") for number in numbers])

        def carry_out(*_, **__):
            outcome = left.pop(0)
            if isinstance(outcome, Exception):
                raise outcome
            return SimpleNamespace(id=9 - len(left), outcome=outcome, reason=""), 130 if outcome == "stopped" else None

        monkeypatch.setattr("bench.cli.lab.study_trials.suggested", suggested)
        monkeypatch.setattr("bench.cli.lab.study_trials.carry_out", carry_out)
        monkeypatch.setattr("bench.study.extend.extend_study", extend_study)
        monkeypatch.setattr(
            "bench.study.diagnosis.diagnose.diagnose", lambda *_: Diagnosis.model_construct(sentence="so")
        )
        told = command("study", "suggest", 1, "--start", "--json", *extra)
        return json.loads(told.stdout), told.exit_code, asked

    return start


def added(told):
    return [one["trial_id"] for one in told["extended"]["added"]]


def outcomes(told):
    return [[one["outcome"] for one in each["experiments"]] for each in told["rounds"]]


def test_what_trips_is_replaced_and_the_rest_is_added_round_by_round(started):
    told, code, asked = started("completed", "tripped", "completed", "completed", extra=("--trials", 3))
    assert outcomes(told) == [["completed", "tripped"], ["completed", "completed"]]
    assert [added(one) for one in told["rounds"]] == [[6], [8, 9]]
    assert asked == [[], ["b"], []]  # the last: what came of the last round
    assert [one["came"] for one in told["rounds"]] == [
        [{"effect": "spring", "predicted": 6.0, "came": 2}],
        [{"effect": "spring", "predicted": 7.0, "came": 3}],
    ]
    assert code == 0


def test_a_refused_one_is_told_and_replaced(started):
    told, code, asked = started(LimitError("load 9 kg"), "completed", extra=("--trials", 1))
    assert outcomes(told) == [["refused"], ["completed"]]
    assert told["rounds"][0]["experiments"][0]["reason"] == "load 9 kg"
    assert asked == [[], ["a"], []]
    assert code == 0


@pytest.mark.parametrize("ending", ["stopped", "interrupted", DriveError("d", "no answer")])
def test_nothing_more_is_started_after_a_stop_or_without_a_drive(started, ending):
    told, code, _ = started("completed", ending, "completed")
    assert len(told["rounds"]) == 1
    assert added(told) == [7]
    assert code == (130 if ending == "stopped" else ExitCode.NOT_COMPLETED)


def test_after_three_that_trip_it_ends(started):
    told, code, _ = started("tripped", "failed", LimitError("x"), "completed", extra=("--at-once", 1))
    assert outcomes(told) == [["tripped"], ["failed"], ["refused"]]
    assert "extended" not in told
    assert code != 0
