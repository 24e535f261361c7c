"""A study's model in closed loop: errors of motion, the servo's law, refinement, the ladder."""

import json

import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.store import Store
from bench.study.changes import add_effect
from bench.study.closed_loop import keep_motion_errors, simulate
from bench.study.create import create_study
from bench.study.errors import StudyError
from bench.study.ladder import ladder
from bench.study.material import load_model
from bench.study.report.report import report_html
from compensator.lab.model.fit import seeing_all
from tests.lab.synthetic import Joint, plans
from tests.study.conftest import imported


@pytest.fixture(scope="module")
def study_id(store, experiment_id) -> int:
    return create_study(store, "moved", [experiment_id], cutoff_hz=6.0).study_id


@pytest.fixture(scope="module")
def models(store, study_id) -> tuple[int, int]:
    base = ladder(store, study_id).rungs[0].model_id
    return base, add_effect(store, study_id, "viscous_asymmetry", base).model_id


def test_the_motion_comes_nearer_with_the_hidden_effect(store, study_id, models):
    before, after = (simulate(store, study_id, model_id) for model_id in models)
    assert after.held_out.position < 0.7 * before.held_out.position  # the rest is the noise of the effort
    assert after.held_out.effort_relative < 0.7 * before.held_out.effort_relative
    assert len(after.trials) == 12
    assert all(one.settled for one in after.trials)


def test_recordings_without_a_set_point_say_that_a_servo_stands_in(store, study_id, models):
    found = simulate(store, study_id, models[0])
    assert {one.law for one in found.trials} == {"stand-in"}
    assert "12 trials" in found.notes[0]
    assert "stands in" in found.notes[0]


def test_series_show_both_motions(store, study_id, models):
    series = simulate(store, study_id, models[1]).trials[0].series
    assert len(series.time_s) == len(series.measured) == len(series.simulated) >= 300
    assert series.measured != series.simulated
    assert series.measured == pytest.approx(series.simulated, abs=0.05)


def test_what_is_moved_was_fitted_to_rows_that_see_stops_and_reversals(store, study_id, models):
    material, row = load_model(store, study_id, models[1])
    fit = material.fit_of(row)
    told = [one.before for one in simulate(store, study_id, models[1], refined=True).refined.parameters]
    assert told == pytest.approx(seeing_all(fit).coefficients.tolist())
    assert told != pytest.approx(fit.coefficients.tolist())


def test_refinement_says_what_it_gains_and_keeps_nothing(store, study_id, models):
    rungs = ladder(store, study_id).rungs
    found = simulate(store, study_id, models[1], refined=True).refined
    assert [one.effect for one in found.parameters][-1] == "viscous_asymmetry"
    assert found.training.effort <= simulate(store, study_id, models[1]).training.effort
    assert found.sentence.startswith("Refine")
    assert ladder(store, study_id).rungs == rungs


def test_the_ladder_has_the_motion_of_models_that_were_simulated(store, study_id, models):
    assert [rung.motion for rung in ladder(store, study_id).rungs] == [None, None]
    assert list(keep_motion_errors(store, study_id)) == list(models)
    before, after = (rung.motion for rung in ladder(store, study_id).rungs)
    assert after.position < before.position
    assert after.unit == "rad"
    assert list(keep_motion_errors(store, study_id)) == []  # once is enough


def test_the_bench_tells_the_law_of_its_own_servo(store, experiment_id, study_id, models, monkeypatch):
    from bench.study import closed_loop

    experiment = store.experiment(experiment_id)
    servo = {"proportional_a_rad": 20.0, "integral_a_rad_s": 0.0, "derivative_a_s_rad": 0.5, "dead_band_rad": 0.001}
    for closed_by, expected in (("bench", 20.0), ("drive", None)):
        experiment.provenance["configuration"] = {"servo": {**servo, "closed_by": closed_by}}
        monkeypatch.setattr(closed_loop, "drive_of", lambda *_: closed_loop_drive(1.0, 0.1))
        law = closed_loop._law(experiment, None)
        assert (law and law.stiffness) == expected
        assert law is None or (law.damping, law.dead_band, law.source) == (pytest.approx(0.4), 0.001, "bench")


def closed_loop_drive(per_a, per_rad_s):
    from bench.study.suggestion.dynamics import Drive

    return Drive(per_a, per_rad_s)


def test_a_model_without_inertia_is_refused_in_words(store):
    light = imported(store, plans(loads_kg=(0.0,)), Joint())
    number = create_study(store, "light", [light], base=["coulomb", "viscous"]).study_id
    with pytest.raises(StudyError, match="no inertia"):
        simulate(store, number)
    assert "no inertia" in report_html(store, number)


def test_the_report_shows_the_motion(store, study_id, models):
    page = report_html(store, study_id)
    assert "In closed loop" in page


def test_the_command_prints_both_errors(tmp_path):
    url = f"sqlite:///{tmp_path / 'bench.sqlite'}"
    with Store.open(url) as own:
        number = create_study(own, "moved", [imported(own, plans(loads_kg=(0.0, 0.2)))]).study_id

    def told(*words: str) -> str:
        run = CliRunner().invoke(app, ["--store", url, "study", *words], env={"COLUMNS": "200"})
        assert run.exit_code == 0, run.output
        return run.stdout

    assert json.loads(told("simulate", str(number), "--json"))["refined"] is None
    shown = told("simulate", str(number), "--refine")
    assert "Coefficients" in shown
    assert "stand-in" in shown
    assert "simulated" in told("ladder", str(number), "--motion")
    assert "position in closed loop" in told("ladder", str(number))
