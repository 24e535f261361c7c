"""From trials to an explained effect, over REST."""

import pytest

from compensator.lab.effects.offered import LeftOut
from tests.service.recorded_joint import recording_set_zip


@pytest.fixture(scope="module")
def experiment_id(service) -> int:
    headers = {"Content-Type": "application/zip"}
    answer = service.client.post("/recording-sets?name=known+joint", content=recording_set_zip(), headers=headers)
    assert answer.status_code == 201, answer.text
    return answer.json()["experiment_id"]


@pytest.fixture(scope="module")
def study(service, experiment_id):
    body = {"name": "arm", "experiment_ids": [experiment_id], "hold_out": ["amplitude_rad=0.9"]}
    answer = service.client.post("/studies", json=body)
    assert answer.status_code == 201, answer.text
    assert answer.headers["location"] == f"/api/v1/studies/{answer.json()['study_id']}"
    return answer.json()


def test_a_study_splits_by_condition(service, study):
    assert len(study["trials"]) == 6
    for trial in study["trials"]:
        assert trial["role"] == ("held_out" if trial["conditions"]["amplitude_rad"] == 0.9 else "training")
    assert service.stranger.get(f"/studies/{study['study_id']}").json() == study
    assert study["study_id"] in [one["study_id"] for one in service.stranger.get("/studies").json()["items"]]


def test_compare_holds_the_measured_against_the_predicted(service, study):
    found = service.stranger.get(f"/studies/{study['study_id']}/compare").json()
    assert found["error"]["held_out"]["kind"] == "hold-out"
    assert 0 < found["error"]["training"]["relative"] < 1
    assert found["error"]["floor"] is not None
    assert len(found["series"]) == len(found["trials"]) == 6
    one = found["series"][0]
    for measured, predicted, residual in zip(one["measured"], one["predicted"], one["residual"], strict=True):
        assert measured - predicted == pytest.approx(residual, abs=1e-9)
    assert {"velocity", "position"} <= {one["driver"] for one in found["residual_against"]}
    assert found["parameters"]


def test_diagnose_add_ladder_drop_and_remove(service, study):
    path = f"/studies/{study['study_id']}"
    base = study["model_id"]
    found = service.stranger.get(f"{path}/diagnose", params={"model_id": base}).json()
    assert found["verdict"] == "missing", found["sentence"]
    best = found["ranking"][0]
    assert best["effect"] == "viscous_asymmetry"
    assert best["in_class"]
    assert best["picture"]["curve"]
    added = service.client.post(f"{path}/models", json={"effect": best["effect"], "model_id": base}).json()
    assert added["parent_id"] == base
    assert added["effects"][-1] == best["effect"]
    assert added["after"]["held_out"] < added["before"]["held_out"]
    ladder = service.stranger.get(f"{path}/ladder").json()
    assert [rung["model_id"] for rung in ladder["rungs"]] == [base, added["model_id"]]
    assert ladder["rungs"][1]["held_out"] == pytest.approx(added["after"]["held_out"])
    body = {"effect": best["effect"], "model_id": added["model_id"], "action": "drop"}
    dropped = service.client.post(f"{path}/models", json=body).json()
    assert dropped["after"]["held_out"] == pytest.approx(added["before"]["held_out"])
    refused = service.client.delete(f"{path}/models/{added['model_id']}")
    assert refused.status_code == 409
    assert service.client.delete(f"{path}/models/{dropped['model_id']}").status_code == 204
    assert len(service.stranger.get(f"{path}/ladder").json()["rungs"]) == 2


def test_a_search_adds_what_is_missing_and_keeps_its_models(service, experiment_id):
    body = {"name": "searched", "experiment_ids": [experiment_id], "hold_out": ["amplitude_rad=0.9"]}
    study_id = service.client.post("/studies", json=body).json()["study_id"]
    assert service.stranger.post(f"/studies/{study_id}/search", json={}).status_code == 401
    answer = service.client.post(f"/studies/{study_id}/search", json={"most": 2})
    assert answer.status_code == 201, answer.text
    found = answer.json()
    assert len(found["added"]) <= 2
    rungs = service.stranger.get(f"/studies/{study_id}/ladder").json()["rungs"]
    assert [rung["model_id"] for rung in rungs[1:]] == [step["model_id"] for step in found["steps"]]
    assert service.client.post(f"/studies/{study_id}/search", json={"most": 0}).status_code == 422


def test_bad_requests_say_what_would_be_right(service, study, experiment_id):
    def detail(answer, status):
        assert answer.status_code == status, answer.text
        assert answer.headers["content-type"] == "application/problem+json"
        return answer.json()["detail"]

    path = f"/studies/{study['study_id']}"
    new = {"name": "x", "experiment_ids": [experiment_id]}
    assert "amplitude_rad" in detail(service.client.post("/studies", json={**new, "hold_out": ["colour=red"]}), 422)
    assert "key=value" in detail(service.client.post("/studies", json={**new, "hold_out": ["repeat"]}), 422)
    assert "experiment 99999" in detail(service.client.post("/studies", json={**new, "experiment_ids": [99999]}), 404)
    assert "experiment_ids" in detail(service.client.post("/studies", json={"name": "x", "experiment_ids": []}), 422)
    assert "magic" in detail(service.client.post(f"{path}/models", json={"effect": "magic"}), 422)
    assert "viscous already" in detail(service.client.post(f"{path}/models", json={"effect": "viscous"}), 422)
    assert "no model 99999" in detail(service.client.delete(f"{path}/models/99999"), 404)
    detail(service.client.get("/studies/99999/compare"), 404)
    detail(service.client.get(f"{path}/compare", params={"model_id": 99999}), 422)


def test_the_catalogue_is_complete_enough_to_learn_from(service):
    effects = {one["name"]: one for one in service.stranger.get("/effects").json()["items"]}
    assert {"inertia", "gravity", "coulomb", "viscous", "stribeck", "load_friction", "viscous_asymmetry"} <= set(
        effects
    )
    for effect in effects.values():
        for text in ("title", "physics", "equation", "driver", "excited_by", "source"):
            assert effect[text], (effect["name"], text)
        assert set(effect["confused_with"]) <= set(effects), effect["name"]


def test_a_report_to_be_filed(service, study):
    answer = service.stranger.get(f"/studies/{study['study_id']}/report")
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/html")
    assert "attachment" in answer.headers["content-disposition"]
    assert "What the models leave" in answer.text


def test_suggestions_and_more_trials(service, study):
    path = f"/studies/{study['study_id']}"
    assert service.stranger.post(f"{path}/suggest", json={}).status_code == 401
    refused = service.client.post(f"{path}/suggest", json={"trials": 1})
    assert refused.status_code == 422
    assert "of another rig than this bench" in refused.json()["detail"]
    assert service.stranger.post(f"{path}/trials", json={}).status_code == 401
    refused = service.client.post(f"{path}/trials", json={})
    assert "no completed trial that study" in refused.json()["detail"]
    zipped = {"content": recording_set_zip(), "headers": {"Content-Type": "application/zip"}}
    more = service.client.post("/recording-sets?name=again", **zipped).json()["experiment_id"]
    added = service.client.post(f"{path}/trials", json={"experiment_ids": [more]})
    assert added.status_code == 201, added.text
    assert added.json()["trials"] == 12
    assert len(service.stranger.get(path).json()["trials"]) == 12


def test_a_model_of_another_rig_cannot_be_used(service, study):
    path = f"/studies/{study['study_id']}/use"
    assert service.stranger.post(path, json={}).status_code == 401
    refused = service.client.post(path, json={})
    assert refused.status_code == 422
    assert "of another rig than this bench" in refused.json()["detail"]


def test_units_of_one_kind_stand_beside_each_other(service, study, experiment_id):
    body = {"name": "unit", "experiment_ids": [experiment_id]}
    beside = [service.client.post("/studies", json=body).json()["study_id"] for _ in range(2)]
    path = f"/studies/{study['study_id']}/units"
    found = service.stranger.get(path, params={"beside": beside, "model_id": study["model_id"]}).json()
    assert [one["study_id"] for one in found["units"]] == [study["study_id"], *beside]
    assert found["sentence"].startswith("None of the 3 units is shown to be an outlier.")
    coulomb = next(one for one in found["parameters"] if one["effect"] == "coulomb")
    assert [one["study_id"] for one in coulomb["values"]] == [study["study_id"], *beside]
    assert coulomb["next_low"] <= coulomb["mean"] <= coulomb["next_high"]
    two = service.stranger.get(path, params={"beside": beside[:1]}).json()
    assert all(one["low"] <= one["difference"] <= one["high"] for one in two["differences"])
    assert two["differences"]
    assert service.stranger.get(path).status_code == 422
    assert service.stranger.get(path, params={"beside": [beside[0], 999]}).status_code == 404


def test_effects_of_other_packages_that_are_broken_are_told(service, monkeypatch):
    assert service.stranger.get("/effects").json()["left_out"] == []
    broken = (LeftOut("hose 1.0", "hose = hose:EFFECT", "ImportError: no hose"),)
    monkeypatch.setattr("bench.study.effects.left_out", lambda: broken)
    answer = service.stranger.get("/effects", params={"limit": 1}).json()
    told = {"package": "hose 1.0", "entry_point": "hose = hose:EFFECT", "reason": "ImportError: no hose"}
    assert (len(answer["items"]), answer["left_out"]) == (1, [told])
