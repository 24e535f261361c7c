"""The client against a live service."""

import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from bench.client import Bench, Refused, Unreachable, connection
from bench.client.bench import _left_token
from bench.config.channels import CHANNELS
from bench.control import station
from bench.control.drive_factory import Equipment
from bench.control.technician import PersonTechnician
from bench.errors import ConfigurationError
from bench.own_service import own_file
from tests.control.fake_drive import FakeDrive
from tests.service.recorded_joint import study_path
from tests.service.running_service import TOKEN


def test_a_run_from_start_to_arrays(bench, service):
    run = bench.start("steps", repeats=2, load_kg=0.05, operator="Ada", note="from a notebook").wait(90.0)
    assert (run.outcome, run.reason, run.record["operator"]) == ("completed", "", "Ada")
    assert repr(run) == f"<Run {run.experiment_id} steps: completed>"
    trials = run.trials()
    assert [trial.conditions["repeat"] for trial in trials] == [1, 2]
    channels = trials[0].channels()
    kept = service.store.samples(trials[0].trial_id)
    assert set(channels) == set(kept)
    for name, values in kept.items():
        assert np.array_equal(channels[name], values, equal_nan=True), name
    some = trials[0].channels("position_rad", "time_s")
    assert list(some) == ["position_rad", "time_s"]
    few = trials[0].channels("position_rad", points=100)
    assert len(few["time_s"]) < 150
    with pytest.raises(KeyError, match="no channel colour"):
        trials[0].channels("colour")
    assert f"<Trial {trials[0].trial_id} step-001" in repr(bench.trial(trials[0].trial_id))


def test_a_channel_that_no_recording_set_holds_is_read_too(bench, service, monkeypatch):
    monkeypatch.setitem(CHANNELS, "duty", replace(CHANNELS["duty"], exported=False))
    trial = bench.trials(kind="steps")[0]
    kept = service.store.samples(trial.trial_id)
    channels = trial.channels()
    assert list(channels) == list(kept)
    assert np.array_equal(channels["duty"], kept["duty"], equal_nan=True)
    assert list(trial.channels("duty")) == ["duty"]
    shared = service.client.get(f"/trials/{trial.trial_id}/csv").text.splitlines()[0].split(",")
    assert "duty" not in shared


def test_the_token_that_the_service_left_for_its_user_is_taken(service, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.delenv("FRICTION_BENCH_TOKEN", raising=False)
    with Bench(service.url) as nobody, pytest.raises(Refused) as refused:
        nobody.stop()
    assert refused.value.status == 401
    port = service.url.rsplit(":", 1)[1]
    left = own_file(int(port))
    left.parent.mkdir()
    left.write_text(f"{TOKEN}\n")
    left.chmod(0o600)
    with Bench(service.url) as found:
        found.stop()
    assert _left_token(f"http://bench.lab:{port}") is None, "another machine is not sent it"
    assert _left_token("http://127.0.0.1:port") is None
    left.chmod(0o644)
    with pytest.raises(ConfigurationError, match="chmod 600"):
        Bench(service.url)


def test_lists_are_read_to_their_end(bench, service, monkeypatch):
    monkeypatch.setattr("bench.client.connection.PAGE", 1)
    assert [run.experiment_id for run in bench.experiments()] == [one.id for one in service.store.experiments()]
    assert len(bench.trials(kind="steps")) == len(service.store.trials(kind="steps"))


def test_what_can_be_started_shows_as_a_table(bench):
    kinds = bench.kinds()
    assert "steps" in [kind["name"] for kind in kinds]
    assert kinds._repr_html_().startswith("<table><tr><th>name</th>")
    assert "<th>state</th><td>idle</td>" in bench.status()._repr_html_()


def test_refusals_are_exceptions_with_the_words_of_the_service(bench, service):
    with pytest.raises(Refused, match="load_kg is 5 kg; allowed is at most") as refused:
        bench.start("steps", load_kg=5)
    assert (refused.value.status, refused.value.kind) == (422, "LimitError")
    with pytest.raises(Refused) as refused:
        bench.start("steps", repeats="many")
    assert refused.value.errors[0]["field"] == "parameters.repeats"
    with Bench(service.url, "wrong-token-0123456789") as stranger, pytest.raises(Refused, match="needs a token"):
        stranger.stop()


def test_a_service_that_is_not_there_is_named(monkeypatch):
    monkeypatch.setattr(connection, "PAUSE_S", 0.0)
    with Bench("http://127.0.0.1:9", TOKEN) as nobody, pytest.raises(Unreachable, match=r"127.0.0.1:9 does not answer"):
        nobody.status()


def test_a_start_whose_answer_is_lost_starts_once(bench, service, monkeypatch):
    monkeypatch.setattr(connection, "PAUSE_S", 0.0)
    before = service.store.experiments(limit=1)[0].id
    request, lost = bench._connection._http.request, []

    def losing(method, path, **how):
        answer = request(method, path, **how)
        if not lost:
            lost.append(answer)
            raise connection.httpx.ReadTimeout("the answer was lost")
        return answer

    monkeypatch.setattr(bench._connection._http, "request", losing)
    run = bench.start("steps", repeats=1).wait(90.0)
    assert lost[0].json()["experiment_id"] == run.experiment_id == before + 1
    assert service.store.experiments(limit=1)[0].id == run.experiment_id


def test_stop(bench):
    run = bench.start("steps", pace="real-time", repeats=5)
    assert run.status()["outcome"] == "running"
    with pytest.raises(TimeoutError, match="runs still after"):
        run.wait(0.1)
    assert run.stop("cable is caught").outcome == "stopped"
    assert "cable is caught" in run.reason


def test_live_rows_are_the_recorded_ones(bench, service):
    run = bench.start("steps", pace="real-time", repeats=1)
    heard = []
    for rows in bench.live():
        if rows.restarted:  # what was live before begins again
            heard = []
        heard += rows.channels["time_s"].tolist()
        if len(heard) > 200:
            break
    run.stop()
    recorded = service.store.samples(run.trials()[0].trial_id)["time_s"].tolist()
    begin = recorded.index(heard[-1]) - 199
    assert heard[-200:] == recorded[begin : begin + 200]


def test_the_person_at_the_bench_is_asked(bench, service, monkeypatch):
    drive = FakeDrive()
    monkeypatch.setattr(station, "make_equipment", lambda _configuration, ask: Equipment(drive, PersonTechnician(ask)))
    asked = []
    run = bench.start("steps", repeats=1)
    waiting = threading.Thread(target=run.wait, kwargs={"timeout_s": 60.0, "on_prompt": asked.append}, daemon=True)
    waiting.start()
    deadline_s = time.monotonic() + 30.0
    while drive.exchanges == 0:
        assert time.monotonic() < deadline_s
        time.sleep(0.02)
    assert asked == ["Hang 100 g at the tip of the arm, and stand clear."]
    run.stop()
    waiting.join(30.0)


def test_a_lease_is_kept_while_the_block_runs(bench, service):
    with service.with_token("other client", "operator") as other:
        with bench.lease("Ada", duration_s=5.0):
            assert bench.status()["lease"]["holder"] == "Ada"
            time.sleep(3.0)
            assert bench.status()["lease"]["remaining_s"] > 2.5
            assert other.post("/lease").status_code == 409
        assert other.post("/lease").status_code == 201
        assert other.delete("/lease").status_code == 204


def test_a_study_names_what_is_missing(bench, study):
    assert repr(study).startswith("<Study 1 arm: 6 trials")
    found = study.diagnose()
    assert found.verdict == "missing"
    assert "viscous_asymmetry" in found.classes[0].effects
    assert found.sentence in repr(found)
    changed = study.add("viscous_asymmetry")
    assert changed.after.held_out < changed.before.held_out
    assert [len(rung.effects) for rung in study.ladder().rungs][:2] != []
    assert study.compare().model_id == changed.model_id


def test_units_of_one_kind(bench, service, study):
    beside = [bench.study(int(study_path(service, f"unit {n}").split("/")[-1])) for n in range(2)]
    found = study.units(beside)
    assert [one.name for one in found.units] == ["arm", "unit 0", "unit 1"]
    assert found.sentence in repr(found)


def test_a_record_is_removed_for_a_reason(bench, service):
    made = bench.study(int(study_path(service, "to be removed").split("/")[-1]))
    trial = service.client.get(f"/trials/{made.facts.trials[0].trial_id}").json()
    run = bench.run(trial["experiment_id"])
    with pytest.raises(Refused, match="Remove a study first"):
        run.remove("wrong arm")
    made.remove("made twice")
    run.remove("wrong arm")
    for path in (f"/studies/{made.study_id}", f"/experiments/{run.experiment_id}"):
        assert service.client.get(path).status_code == 404
