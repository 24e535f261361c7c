"""`friction-bench study ...` and `effects`."""

import importlib
import json
import shlex
from types import SimpleNamespace

import pytest

from bench.cli.lab import diagnosis_tables, study_tables
from bench.cli.lab.diagnosis_tables import next_step
from bench.study.diagnosis import search as search_module
from bench.study.diagnosis.findings import not_judged
from bench.study.models.diagnosis import Diagnosis, EffectClass, Finding, ProvisionalTerm
from bench.study.models.ladder import Rung
from bench.study.report import report as report_module
from compensator.lab.effects.offered import LeftOut
from tests.service.recorded_joint import recording_set_zip

HOW = [
    ("hold-out", "on trials that no model of the study is fitted to."),
    ("leave-one-trial-out", "each trial in turn is predicted by a fit to all the others."),
]
OF_A_ROUND = ["extend", "diagnose", "suggest"]


def test_from_trials_to_an_error_that_falls(command, tmp_path, monkeypatch):
    (tmp_path / "known joint.zip").write_bytes(recording_set_zip())
    assert command("import", "known joint.zip").exit_code == 0
    made = command("study", "new", "arm", "--experiment", 1, "--hold-out", "amplitude_rad=0.9", "--json")
    assert made.exit_code == 0, made.output
    study = json.loads(made.stdout)["study_id"]
    assert "arm" in command("study", "list").stdout
    compared = command("study", "compare", study)
    assert compared.exit_code == 0, compared.output
    for words in ("hold-out", "viscous friction", "sliding"):
        assert words in compared.stdout
    found = json.loads(command("study", "diagnose", study, "--json").stdout)
    best = found["ranking"][0]["effect"]
    assert best == "viscous_asymmetry"
    assert best in command("study", "diagnose", study).stdout
    shown = command("study", "add", study, best).stdout.splitlines()
    assert shown[-2:] == [
        f"next: friction-bench study diagnose {study}",
        f"score and p of {best}: friction-bench study diagnose {study} --model {found['model_id']}",
    ]
    added = json.loads(command("study", "add", study, best, "--model", found["model_id"], "--json").stdout)
    assert added["after"]["held_out"] < added["before"]["held_out"]
    assert f"+ {best}" in command("study", "ladder", study).stdout
    again = command("study", "add", study, best, "--model", added["parent_id"])
    value = added["parameters"][0]
    assert value["low"] < value["value"] < value["high"]
    for words in ("Its parameters", value["name"], f"{value['value']:.4g}"[:5], value["unit"]):
        assert words in again.stdout
    dropped = json.loads(command("study", "drop", study, best, "--json").stdout)
    assert best not in dropped["effects"]
    report = command("study", "report", study, "--html", "study.html", "--no-suggest")
    assert report.exit_code == 0, report.output
    assert "What the models leave" in (tmp_path / "study.html").read_text(encoding="utf-8")
    assert "written: study-1.html" in command("study", "report", study, "--no-suggest").stdout
    with monkeypatch.context() as patch:
        patch.setattr(report_module, "report_html", pytest.fail)  # a place that is taken is refused before the work
        again = command("study", "report", study, "--html", "study.html", "--no-suggest")
    assert again.exit_code == 3
    assert "is there already" in again.stderr
    others = [
        json.loads(command("study", "new", "unit", "--experiment", 1, "--json").stdout)["study_id"] for _ in range(2)
    ]
    beside = command("study", "units", study, *others)
    assert beside.exit_code == 0, beside.output
    assert "What 3 units have in common" in beside.stdout
    assert "None of the 3 units is shown to be an outlier." in beside.stdout
    two = command("study", "units", study, others[0])
    assert two.exit_code == 0, two.output
    assert "90 %" in two.stdout
    assert "two cannot tell" in " ".join(two.stdout.split())
    assert command("study", "units", study, study).exit_code == 3
    refused = command("study", "suggest", study)
    assert refused.exit_code == 3
    assert "of another rig than this bench" in refused.stderr
    assert "no completed trial that study" in command("study", "extend", study).stderr
    refused = command("study", "add", study, "magic")
    assert refused.exit_code == 3
    assert "magic" in refused.stderr


@pytest.mark.parametrize(("kind", "how"), HOW)
@pytest.mark.parametrize(("rows", "in_both"), [("near reversals too", True), ("steady sliding", False)])
def test_a_change_and_the_ladder_say_what_their_errors_are_of(capsys, rows, in_both, kind, how):
    changed = SimpleNamespace(
        sentence="Added.", model_id=2, rows=rows, ladder_rows="steady sliding", ladder_before=0.0616,
        ladder_after=0.0466, before=SimpleNamespace(training=0.05, held_out=0.0888),
        after=SimpleNamespace(training=0.04, held_out=0.0707), parameters=[], breakaway=None,
    )  # fmt: skip
    study_tables.change(changed)
    told = capsys.readouterr().out
    assert "training, steady sliding" in told
    assert f"held out, {rows}" in told
    assert ("held out, steady sliding, as in the ladder" in told) == ("4.66 %" in told) == in_both
    rung = Rung.model_construct(
        model_id=1, parent_id=None, effects=["gravity"], added=None, removed=None, training=0.05, held_out=0.06,
        held_out_low=0.05, held_out_high=0.07, held_out_kind=kind, breakaway=None, motion=None, reflected_error_g=None,
    )  # fmt: skip
    study_tables.ladder(SimpleNamespace(study_id=1, rows="steady sliding", rungs=[rung], floor=None))
    told = capsys.readouterr().out
    assert "Ladder of study 1: errors in the effort, steady sliding" in told
    assert f"Held out: {how}" in told


def test_effects(command):
    names = [one["name"] for one in json.loads(command("effects", "--json").stdout)]
    assert "load_friction" in names
    assert "load_friction" in command("effects").stdout
    assert "Rhoban" in command("effects", "load_friction").stdout
    assert command("effects", "magic").exit_code == 3


def test_effects_that_are_left_out_are_told(command, monkeypatch):
    broken = (LeftOut("hose 1.0", "hose = hose:EFFECT", "ImportError: no hose"),)
    monkeypatch.setattr("bench.study.effects.left_out", lambda: broken)
    assert "left out: hose = hose:EFFECT, of package hose 1.0: ImportError: no hose" in command("effects").stdout


def test_what_is_suggested_is_run_added_and_diagnosed(command, monkeypatch):
    from bench.study.suggestion.options import choices

    suggest = importlib.import_module("bench.study.suggestion.suggest")

    def few(*args):
        return [one for one in choices(*args) if one.parameters.get("waveforms") == ["slow-sine"]]

    monkeypatch.setattr(suggest, "choices", few)
    motions = ["--waveforms", "slow-sine,multisine", "--loads-kg", "0.05", "--duration-s", 4]
    assert command("run", "excitation", *motions, "--json").exit_code == 0
    assert command("study", "new", "arm", "--experiment", 1, "--json").exit_code == 0
    assert command("study", "new", "to paste", "--experiment", 1, "--json").exit_code == 0
    shown = command("study", "suggest", 2, "--trials", 1)
    assert shown.exit_code == 0, shown.output
    assert "Trials to record next" in shown.stdout
    told = shown.stdout.splitlines()
    pasted = [shlex.split(line)[1:] for line in told[told.index("one by one:") + 1 :] if line.startswith("friction-")]
    assert [words[:2] for words in pasted] == [["run", "excitation"], *(["study", one] for one in OF_A_ROUND)]
    for words in pasted[:-1]:
        assert command(*words).exit_code == 0, words
    started = command("study", "suggest", 1, "--trials", 1, "--start", "--json")
    assert started.exit_code == 0, started.output
    found = json.loads(started.stdout)
    assert found["extended"]["trials"] == 4 + len(found["extended"]["added"])
    assert found["diagnosis"]["model_id"] == found["extended"]["model_id"]
    assert [one["outcome"] for one in found["rounds"][0]["experiments"]] == ["completed"]
    refused = command("study", "use", 1)
    assert refused.exit_code == 3
    assert "this bench has no calibration" in refused.stderr
    assert "no calibration to begin with" in command("study", "ladder", 1, "--bench").stderr
    assert f"the same, {found['extended']['trials']} trials" in command("study", "ladder", 1).stdout


def test_the_command_asks_all_studies_in_processes_and_prints_one_line_for_each(command, tmp_path):
    (tmp_path / "known joint.zip").write_bytes(recording_set_zip())
    assert command("import", "known joint.zip").exit_code == 0
    for name in ("one", "two"):
        assert command("study", "new", name, "--experiment", 1, "--hold-out", "amplitude_rad=0.9").exit_code == 0
    told = command("study", "diagnose-many", "--workers", 2, "--json")
    assert told.exit_code == 0, told.stderr
    assert [one["study_id"] for one in json.loads(told.stdout)] == [1, 2]
    assert "2 of 2 items" in told.stderr
    shown = command("study", "diagnose-many", 2, "--workers", 1).stdout
    assert "viscous_asymmetry" in shown
    refused = command("study", "diagnose-many", "--cluster", "nowhere")
    assert refused.exit_code != 0
    assert "wanted is a scheduler's address" in refused.stderr


def test_a_trial_is_left_out_by_its_name(command, tmp_path):
    (tmp_path / "known joint.zip").write_bytes(recording_set_zip())
    assert command("import", "known joint.zip").exit_code == 0
    made = command("study", "new", "arm", "--experiment", 1, "--leave-out", "swing-0.6-2", "--json")
    assert made.exit_code == 0, made.output
    names = [one["name"] for one in json.loads(made.stdout)["trials"]]
    assert names == ["swing-0.6-1", "swing-0.9-1", "swing-0.9-2", "swing-1.2-1", "swing-1.2-2"]
    refused = command("study", "new", "arm", "--experiment", 1, "--leave-out", "swing-0.6")
    assert refused.exit_code == 3
    assert "the nearest are: swing-0.6-" in refused.stderr


def test_each_step_of_a_study_names_the_next(command, tmp_path):
    (tmp_path / "known joint.zip").write_bytes(recording_set_zip())
    assert command("import", "known joint.zip").exit_code == 0
    made = command("study", "new", "arm", "--experiment", 1)
    assert made.stdout.splitlines()[-1] == "next: friction-bench study diagnose 1"
    elsewhere = command("--store", "friction-bench.sqlite", "study", "diagnose", 1).stdout.splitlines()
    assert elsewhere[-1] == "next: friction-bench --store friction-bench.sqlite study add 1 viscous_asymmetry"
    assert command("study", "add", 1, "viscous_asymmetry").exit_code == 0
    again = command("study", "diagnose", 1, "--model", 1).stdout.splitlines()
    assert again[-1] == "next: friction-bench study add 1 viscous_asymmetry --model 1"
    keep = "next: friction-bench study report 1"
    assert command("study", "diagnose", 1).stdout.splitlines()[-1] == keep
    searched = command("study", "search", 1, "--model", 1).stdout.splitlines()
    assert searched[-1] == keep
    count = sum(
        one["code"] == "not-judged" for one in json.loads(command("study", "diagnose", 1, "--json").stdout)["findings"]
    )
    assert count > 0
    assert f"{count} effects could not be judged on these trials; why: friction-bench study diagnose 1" in searched


def test_a_search_that_ends_at_a_curve_offers_it_as_its_diagnosis_does(command, tmp_path, monkeypatch):
    def of_what_is_unknown(diagnosis):
        def offering(*asked):
            told = diagnosis(*asked)
            curve = {"effect": "curve_of_speed_against_motion"}
            return told.model_copy(update={"classes": [], "provisional": ProvisionalTerm.model_construct(**curve)})

        return offering

    (tmp_path / "known joint.zip").write_bytes(recording_set_zip())
    assert command("import", "known joint.zip").exit_code == 0
    assert command("study", "new", "arm", "--experiment", 1).exit_code == 0
    monkeypatch.setattr(search_module, "answer_of", of_what_is_unknown(search_module.answer_of))
    offered = "next: friction-bench study add 1 curve_of_speed_against_motion"
    assert command("study", "search", 1).stdout.splitlines()[-1] == offered
    assert command("study", "search", 1, "--model", 2).stdout.splitlines()[-1] == f"{offered} --model 2"


@pytest.mark.parametrize(
    ("verdict", "code", "slight", "command"),
    [
        ("data-problem", "data-problem", False, "study new NAME --experiment NUMBER --leave-out TRIAL"),
        ("nothing", "nothing", False, "study report 3"),
        ("missing", "missing", True, "study report 3"),
        ("nothing", "too-short", False, "study suggest 3"),
        ("nothing", "unexplained", False, "study suggest 3"),
    ],
)
def test_where_no_effect_is_offered_the_next_step_is_a_command(verdict, code, slight, command):
    found = SimpleNamespace(study_id=3, verdict=verdict, conclusion=SimpleNamespace(code=code), slight=slight)
    found.offered = found.helps = None
    found.joint = "here"
    assert next_step(found, None) == f"next: friction-bench {command}"
    found.joint = "elsewhere"
    assert next_step(found, None) == f"next: friction-bench {command.replace('suggest', 'coverage')}"
    found.joint = "nowhere"
    assert "suggest" not in next_step(found, None)
    assert "coverage" not in next_step(found, None)


@pytest.mark.parametrize(("trial", "told"), [("lifts", ["suggest 3"]), (None, [])])
def test_rivals_of_what_is_offered_may_be_told_apart_first(trial, told):
    members = EffectClass(effects=["spring", "cogging"], sentence="", separating_trial=trial)
    found = Diagnosis.model_construct(study_id=3, classes=[members], slight=False, findings=[], joint="here")
    add, *first = next_step(found, None).splitlines()
    assert add == "next: friction-bench study add 3 spring"
    assert first == [f"or tell it from its rivals first: friction-bench study {one}" for one in told]


@pytest.mark.parametrize(("joint", "record"), [("here", "suggest 3"), ("elsewhere", "coverage 3"), ("nowhere", None)])
def test_what_helps_and_may_be_luck_is_added_and_judged_by_what_comes_later(joint, record):
    noted = Finding(code="helps", values={"effect": "spring"}, text="")
    found = Diagnosis.model_construct(
        study_id=3, classes=[], slight=False, provisional=None, findings=[noted], joint=joint
    )
    add, *later = next_step(found, None).splitlines()
    assert add == "next: friction-bench study add 3 spring"
    judged = [f"friction-bench study {record}", "friction-bench study drop 3 spring"]
    assert later[1:] == (judged if record else [])


@pytest.mark.parametrize(("kind", "how"), HOW)
def test_what_errors_are_of_and_every_reason_against_an_effect_are_told_below(monkeypatch, capsys, kind, how):
    told = {"why_not": ["may be luck (p = 0.5)", "gain not sure"], "effect": "spring"}
    numbers = dict.fromkeys(
        ("score", "p_value", "held_out_before", "held_out_after", "gain", "gain_low", "gain_high", "d_prime"), 0.5
    )
    found = SimpleNamespace(
        sentence="", slight=False, findings=[], classes=[], provisional=None, notes=[], held_out_kind=kind,
        ranking=[
            SimpleNamespace(**told, **numbers),
            SimpleNamespace(**{**told, **numbers, "effect": "cogging", "score": -1.0}),
        ],
    )  # fmt: skip
    shown = []
    monkeypatch.setattr(diagnosis_tables, "table", lambda *table: shown.append(table))
    diagnosis_tables.diagnosis(found)
    _, columns, _ = shown[0]
    assert "p#" not in columns, "it would be the same in nearly all rows"
    below = " ".join(capsys.readouterr().out.split())
    assert f"Held out: {how}" in below
    assert "gains count each row by how well it is known" in below
    assert "not spring: may be luck (p = 0.5), gain not sure" in below
    assert "no evidence (score not above 0): cogging" in below


def test_effects_that_are_not_judged_for_one_reason_share_a_line():
    reasons = {"dead_time": "does not show", "supply_sag": "does not show", "warm_up": "needs session_s"}
    told = [not_judged(effect, f"{effect} {reason}") for effect, reason in reasons.items()]
    noted = Finding(code="few-trials", values={}, text="Too few trials.")
    assert diagnosis_tables.why_not_judged([noted, *told]) == [
        "Not judged: dead_time, supply_sag: each does not show.",
        "Not judged: warm_up needs session_s.",
    ]
