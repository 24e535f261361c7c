"""`friction-bench study suggest --start`: rounds on the bench, and how they end."""

import json
from types import SimpleNamespace

import pytest

from bench.cli.exit_codes import ExitCode
from bench.cli.lab import diagnosis_tables
from bench.errors import LimitError
from bench.study.models.diagnosis import Conclusion, Diagnosis, EffectClass
from bench.study.models.study import AddedTrial, Extended
from bench.study.suggestion.suggested import PairOfRivals, Suggested, SuggestedTrial
from drivers.errors import DriveError

TRIALS = [
    SuggestedTrial(
        name=name, kind="steps", parameters={"load_kg": 0.1}, minutes=1.0, before=0.0, after=6.0, sentence=""
    )
    for name in "abcd"
]
SAYS = Diagnosis.model_construct(sentence="so")
OF_TWO = EffectClass(effects=["backlash", "elasticity"], sentence="Not told apart.", separating_trial=None)


def named(*classes, code="missing"):
    """A diagnosis that names these classes."""
    conclusion = Conclusion(code=code, values={}, text="so")
    return Diagnosis.model_construct(study_id=1, classes=list(classes), conclusion=conclusion)


@pytest.fixture
def started(command, monkeypatch):
    """Runs --start on a bench whose trials end as they are told to; what it prints, and its exit code."""

    def start(*endings, extra=("--json",)):
        left, asked = list(endings), []

        def suggested(session, study_id, model_id, most, refused):
            asked.append(sorted(refused))
            offered = [one for one in TRIALS if one.name not in refused][:most] if left else []
            rounds = float(len(asked))
            pair = PairOfRivals(true="spring", rival=None, before=rounds, after=5.0 + rounds, promised=0.0)
            return Suggested.model_construct(study_id=study_id, note="n", trials=offered, pairs=[pair], hopeless=[])

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
        monkeypatch.setattr("bench.study.diagnosis.diagnose.diagnose", lambda *_: SAYS)
        told = command("study", "suggest", 1, "--start", *extra)
        return json.loads(told.stdout) if "--json" in extra else told.stdout, told.exit_code, asked

    return start


def added(told):
    return [one["trial_id"] for one in told["extended"]["added"]]


def outcomes(told):
    return [[one["outcome"] for one in each["experiments"]] for each in told["rounds"]]


def test_what_trips_is_replaced_and_the_rest_is_added_round_by_round(started):
    told, code, asked = started("completed", "tripped", "completed", "completed", extra=("--json", "--trials", 3))
    assert outcomes(told) == [["completed", "tripped"], ["completed", "completed"]]
    assert [added(one) for one in told["rounds"]] == [[6], [8, 9]]
    assert asked == [[], ["b"], []]  # the last: what came of the last round
    assert [one["came"] for one in told["rounds"]] == [
        [{"effect": "spring", "before": 1.0, "predicted": 6.0, "came": 2}],
        [{"effect": "spring", "before": 2.0, "predicted": 7.0, "came": 3}],
    ]
    assert code == 0


def test_a_refused_one_is_told_and_replaced(started):
    told, code, asked = started(LimitError("load 9 kg"), "completed", extra=("--json", "--trials", 1))
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
    told, code, _ = started("tripped", "failed", LimitError("x"), "completed", extra=("--json", "--at-once", 1))
    assert outcomes(told) == [["tripped"], ["failed"], ["refused"]]
    assert "extended" not in told
    assert code != 0


def test_what_is_not_told_apart_after_all_trials_is_not_settled():
    told = diagnosis_tables.not_settled(named(OF_TWO), 4)
    assert told.startswith("It is not settled: 4 suggested trials came, and backlash and elasticity are not told apart")
    assert told.endswith("friction-bench study coverage 1")
    assert "1 suggested trial came, and what is likely" in diagnosis_tables.not_settled(named(code="likely"), 1)
    one = OF_TWO.model_copy(update={"effects": ["backlash"]})
    assert diagnosis_tables.not_settled(named(one), 4) == ""
    assert diagnosis_tables.not_settled(named(code="nothing"), 4) == ""


def test_at_the_end_of_the_rounds_it_is_said_that_it_is_not_settled(command, started, monkeypatch):
    shown = []
    monkeypatch.setattr("bench.cli.lab.study_trials.say", shown.append)
    monkeypatch.setattr("bench.cli.lab.study_trials.in_words", lambda _: "what came")
    for name in ("suggestion", "extended", "diagnosis"):
        monkeypatch.setattr(diagnosis_tables, name, lambda *_: None)
    monkeypatch.setattr(diagnosis_tables, "next_step", lambda *_: "next: record")
    monkeypatch.setattr("tests.cli.test_study_trials.SAYS", named(OF_TWO))
    started("completed", extra=("--trials", 1))
    assert shown[-1] == "next: record"
    assert shown[-2].startswith("It is not settled: 1 suggested trial came")


def test_without_pairs_no_empty_table_of_them_is_printed(capsys):
    found = Suggested.model_construct(diagnosis="so", sentence="No trial", trials=[], kept_out=[], pairs=[])
    diagnosis_tables.suggestion(found)
    assert capsys.readouterr().out == "so\nNo trial\n"
