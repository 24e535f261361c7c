"""DELETE /experiments/N and /studies/N over REST: an admin's, with a reason, on record."""

import pytest

from tests.service.recorded_joint import recording_set_zip
from tests.service.test_audit import wait_for

WHY = {"reason": "recorded with the wrong arm"}


@pytest.fixture
def experiment_id(service):
    headers = {"Content-Type": "application/zip"}
    made = service.client.post("/recording-sets?name=gone", content=recording_set_zip(), headers=headers)
    return made.json()["experiment_id"]


def test_an_admin_removes_it_and_the_record_says_who_when_what_and_why(service, experiment_id):
    path = f"/experiments/{experiment_id}"
    with service.with_token("head of the lab", "admin") as admin:
        assert admin.delete(path, params=WHY).status_code == 204
    assert service.client.get(path).status_code == 404
    assert service.client.get("/trials", params={"experiment_id": experiment_id}).json()["items"] == []
    deed = wait_for(service, path, 204, "head of the lab")
    assert deed["method"] == "DELETE"
    assert deed["detail"].startswith(f"removed experiment {experiment_id} (")
    assert deed["detail"].endswith(f": {WHY['reason']}")
    assert deed["at_utc"]


def test_nobody_else_does(service, experiment_id):
    path = f"/experiments/{experiment_id}"
    with service.with_token(f"operator {experiment_id}", "operator") as operator:
        answer = operator.delete(path, params=WHY)
    assert answer.status_code == 403
    assert "takes the role admin" in answer.json()["detail"]
    assert service.stranger.delete(path, params=WHY).status_code == 401
    assert service.client.get(path).status_code == 200


@pytest.mark.parametrize("query", [{}, {"reason": ""}, {"reason": "  "}, {"reason": "x" * 201}])
def test_not_without_a_reason(service, experiment_id, query):
    assert service.client.delete(f"/experiments/{experiment_id}", params=query).status_code == 422
    assert service.client.get(f"/experiments/{experiment_id}").status_code == 200


def test_what_is_used_or_runs_stays(idle, experiment_id):
    body = {"name": "uses it", "experiment_ids": [experiment_id], "hold_out": ["amplitude_rad=0.9"]}
    study_id = idle.client.post("/studies", json=body).json()["study_id"]
    refused = idle.client.delete(f"/experiments/{experiment_id}", params=WHY)
    assert refused.status_code == 409
    assert f"study {study_id} (uses it)" in refused.json()["detail"]
    running = idle.start("steps", pace="real-time", repeats=3)
    refused = idle.client.delete(f"/experiments/{running}", params=WHY)
    assert refused.status_code == 409
    assert "is running; stop it" in refused.json()["detail"]
    idle.client.post("/stop")
    assert idle.client.delete(f"/studies/{study_id}", params=WHY).status_code == 204
    assert idle.client.get(f"/studies/{study_id}").status_code == 404
    assert idle.client.delete(f"/studies/{study_id}", params=WHY).status_code == 404
    assert idle.client.delete(f"/experiments/{experiment_id}", params=WHY).status_code == 204
