"""Teleoperation over REST."""

from bench.config.channels import PAIR_RECORDED
from tests.experiments.calibrated import calibrated_configuration
from tests.service.running_service import running_service


def test_a_pair_is_teleoperated_watched_and_exported(idle, monkeypatch):
    monkeypatch.setattr(idle.runner, "configuration", calibrated_configuration(seed=31))
    found = idle.run("teleoperation", angles_rad=[0.6], rest_s=0.5, reflect=["compensated"])
    assert found["outcome"] == "completed"
    assert found["results"]["compensated_limit_cycle"] is False
    assert found["provenance"]["master_drive"]["simulated"] is True
    rows = idle.stranger.get("/live/now", params={"limit": 5}).json()["rows"]
    assert rows["channels"] == list(PAIR_RECORDED)
    assert [len(row) for row in rows["rows"]] == [len(PAIR_RECORDED)] * 5
    exported = idle.stranger.get(f"/experiments/{found['experiment_id']}/recording-set")
    assert exported.headers["content-type"] == "application/zip"


def test_without_friction_curves_it_is_refused_with_what_to_do(tmp_path):
    with running_service(tmp_path) as new:
        answer = new.client.post("/experiments", json={"kind": "teleoperation"})
    assert answer.status_code == 422
    assert "calibrate run" in answer.json()["detail"]


def test_after_a_pair_a_single_joint_shows_its_own_rows(idle, monkeypatch):
    with monkeypatch.context() as patched:
        patched.setattr(idle.runner, "configuration", calibrated_configuration(seed=31))
        idle.run("teleoperation", angles_rad=[0.3], rest_s=0.2, reflect=["none"])
    idle.run("steps", repeats=1)
    channels = idle.stranger.get("/live/now", params={"limit": 1}).json()["rows"]["channels"]
    assert "master_position_rad" not in channels
