"""What was recorded: lists, samples, CSV, recording sets."""

import csv
import io
import zipfile

import numpy as np
import pytest

from bench.config.channels import exported


@pytest.fixture(scope="module")
def experiment_id(service) -> int:
    assert service.runner.wait(30.0)
    return service.run("steps", repeats=3)["experiment_id"]


def test_pages_join_without_gap_or_double(service, experiment_id):
    first = service.stranger.get("/trials", params={"experiment_id": experiment_id, "limit": 2}).json()
    assert first["next_offset"] == 2
    second = service.stranger.get("/trials", params={"experiment_id": experiment_id, "limit": 2, "offset": 2}).json()
    assert second["next_offset"] is None
    assert [one["name"] for one in first["items"] + second["items"]] == ["step-001", "step-002", "step-003"]
    assert first["items"][0]["conditions"]["load_kg"] == 0.1


def test_filters(service, experiment_id):
    def count(**wanted):
        return len(service.stranger.get("/trials", params={"experiment_id": experiment_id, **wanted}).json()["items"])

    assert count(kind="steps", outcome="completed") == 3
    assert count(outcome="failed") == 0
    assert count(kind="load-sweep") == 0


def test_one_trial_with_its_events(service, experiment_id):
    trial_id = service.store.trials(experiment_id)[0].id
    trial = service.stranger.get(f"/trials/{trial_id}").json()
    assert trial["events"][-1]["name"] == "end"
    assert trial["results"]["reflected_load_kg"] == pytest.approx(0.1, abs=0.01)


def test_reduced_samples_are_recorded_rows_and_keep_the_extremes(service, experiment_id):
    trial_id = service.store.trials(experiment_id)[0].id
    whole = service.store.samples(trial_id)
    query = {"channels": "position_rad,velocity_rad_s", "points": 200}
    answer = service.stranger.get(f"/trials/{trial_id}/samples", params=query).json()
    assert set(answer["channels"]) == {"time_s", "position_rad", "velocity_rad_s"}
    assert answer["rows_recorded"] == len(whole["time_s"]) > answer["rows_returned"]
    assert answer["rows_returned"] <= 206
    rows = np.searchsorted(whole["time_s"], answer["channels"]["time_s"])
    for name in ("position_rad", "velocity_rad_s"):
        assert answer["channels"][name] == whole[name][rows].tolist()
        assert max(answer["channels"][name]) == whole[name].max()
        assert min(answer["channels"][name]) == whole[name].min()


def test_all_samples_and_null_where_nothing_was_measured(service, experiment_id):
    trial_id = service.store.trials(experiment_id)[0].id
    answer = service.stranger.get(f"/trials/{trial_id}/samples", params={"points": 200_000}).json()
    assert answer["rows_returned"] == answer["rows_recorded"]
    assert set(answer["channels"]["current_a"]) == {None}


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/trials/999999", 404),
        ("/trials/999999/csv", 404),
        ("/trials/999999/samples", 404),
        ("/trials/0", 422),
        ("/trials/x", 422),
        ("/trials?limit=0", 422),
        ("/trials?limit=1001", 422),
        ("/trials?offset=-1", 422),
        ("/experiments/999999", 404),
        ("/experiments/999999/recording-set", 404),
        ("/no-such-thing", 404),
    ],
)
def test_what_is_not_there_is_a_problem(service, path, status):
    answer = service.client.get(path)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["status"] == status


def test_an_unknown_channel_is_a_problem(service, experiment_id):
    trial_id = service.store.trials(experiment_id)[0].id
    answer = service.client.get(f"/trials/{trial_id}/samples", params={"channels": "torque_n_m"})
    assert answer.status_code == 404
    assert "torque_n_m" in answer.json()["detail"]


def test_csv_holds_the_same_numbers(service, experiment_id):
    trial_id = service.store.trials(experiment_id)[0].id
    answer = service.stranger.get(f"/trials/{trial_id}/csv")
    assert answer.headers["content-type"].startswith("text/csv")
    assert f'filename="trial-{trial_id}.csv"' in answer.headers["content-disposition"]
    rows = list(csv.DictReader(io.StringIO(answer.text)))
    for name, values in service.store.samples(trial_id, exported(service.store.trial(trial_id).channels)).items():
        read = np.array([float(row[name] or "nan") for row in rows])
        assert np.array_equal(read, values, equal_nan=True), name


def test_a_recording_set_leaves_and_comes_back(service, experiment_id):
    answer = service.stranger.get(f"/experiments/{experiment_id}/recording-set")
    assert answer.headers["content-type"] == "application/zip"
    names = zipfile.ZipFile(io.BytesIO(answer.content)).namelist()
    assert {"rig.toml", "trials.csv", "step-001.csv"} <= set(names)
    headers = {"Content-Type": "application/zip"}
    imported = service.client.post("/recording-sets?name=back", content=answer.content, headers=headers)
    assert imported.status_code == 201, imported.text
    back = imported.json()
    assert back["trials"] == 3
    for before, after in zip(
        service.store.trials(experiment_id), service.store.trials(back["experiment_id"]), strict=True
    ):
        assert before.name == after.name
        assert after.channels == exported(before.channels)
        for name, values in service.store.samples(before.id, after.channels).items():
            assert np.array_equal(values, service.store.samples(after.id)[name], equal_nan=True), name


def _zip(**files: str) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, text in files.items():
            archive.writestr(name.replace("__", "."), text)
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (b"", "is no zip"),
        (b"PK nonsense", "is no zip"),
        (_zip(a__csv="time_s,duty\n0,0\n1,0\n"), "rig.toml"),
        (_zip(rig__toml='name = "r"', a__csv="time_s,duty\n0,0\n1,x\n"), "line 3"),
    ],
)
def test_a_bad_upload_says_what_is_wrong_and_leaves_nothing(service, body, words):
    before = service.store.experiments(limit=1)
    answer = service.client.post(
        "/recording-sets?name=broken", content=body, headers={"Content-Type": "application/zip"}
    )
    assert answer.status_code == 422
    assert words in answer.json()["detail"]
    assert "/tmp" not in answer.json()["detail"]
    assert service.store.experiments(limit=1) == before


def test_an_upload_needs_its_type_and_a_harmless_name(service):
    assert service.client.post("/recording-sets?name=x", json={}).status_code == 415
    zip_type = {"Content-Type": "application/zip"}
    for name in ("../x", "a/b", "", "a\\b"):
        answer = service.client.post("/recording-sets", params={"name": name}, content=b"", headers=zip_type)
        assert answer.status_code == 422, name
