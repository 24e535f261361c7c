"""Where a model is wrong, over REST."""

import pytest

from tests.service.recorded_joint import study_path


@pytest.fixture(scope="module")
def path(service) -> str:
    return study_path(service, "mapped")


def test_a_cell_of_the_map_leads_to_its_moments(service, path):
    found = service.stranger.get(f"{path}/error-map").json()
    assert found["across"]["driver"] == "velocity"
    assert len(found["rms"]) == len(found["down_edges"]) - 1
    assert len(found["rms"][0]) == len(found["across_edges"]) - 1
    value, down, across = max(
        (value, down, across)
        for down, row in enumerate(found["rms"])
        for across, value in enumerate(row)
        if value is not None
    )
    assert value > 0
    where = [
        f"velocity={found['across_edges'][across]}..{found['across_edges'][across + 1]}",
        f"{found['down']['driver']}={found['down_edges'][down]}..{found['down_edges'][down + 1]}",
    ]
    moments = service.stranger.get(f"{path}/moments", params={"where": where}).json()["items"]
    assert 0 < len(moments) <= 12
    assert max(one["rms"] for one in moments) >= value
    assert all(one["from_s"] <= one["to_s"] for one in moments)


def test_a_criterion_that_is_none_says_what_would_be_right(service, path):
    for wrong in ("velocity", "velocity=3..1", "velocity=a..b", "=1..2"):
        answer = service.stranger.get(f"{path}/moments", params={"where": wrong})
        assert answer.status_code == 422, wrong
        assert "velocity=0.5..1" in answer.json()["detail"]
    answer = service.stranger.get(f"{path}/moments", params={"where": "moon=0..1"})
    assert answer.status_code == 422
    assert "velocity" in answer.json()["detail"]


def test_where_a_missing_effect_would_act_is_told_with_what_it_takes_away(service, path):
    found = service.stranger.get(f"{path}/action", params={"effect": "viscous_asymmetry"}).json()
    assert found["title"] == "Direction-asymmetric viscous friction"
    first = found["items"][0]
    assert first["rms_with"] < first["rms"]
    compared = service.stranger.get(f"{path}/compare").json()
    before, after = compared["series"][0], found["series"][0]
    assert before["time_s"] == after["time_s"]
    assert before["measured"] == after["measured"]
    assert before["predicted"] != after["predicted"]
    models = service.stranger.get(f"{path}/ladder").json()["rungs"]
    assert len(models) == 1, "a look keeps no model"


def test_an_effect_that_is_unknown_or_in_the_model_acts_nowhere(service, path):
    for effect, words in (("moon", "moon"), ("viscous", "has viscous already")):
        answer = service.stranger.get(f"{path}/action", params={"effect": effect})
        assert answer.status_code == 422
        assert words in answer.json()["detail"]


def test_what_drives_the_residual_stands_beside_the_series_of_its_trial(service, path):
    series = service.stranger.get(f"{path}/compare").json()["series"][1]
    found = service.stranger.get(f"{path}/drivers", params={"trial_id": series["trial_id"]}).json()
    assert found["time_s"] == series["time_s"]
    velocity = next(one for one in found["drivers"] if one["driver"] == "velocity")
    assert velocity["unit"] == "rad/s"
    assert len(velocity["values"]) == len(series["time_s"])
    answer = service.stranger.get(f"{path}/drivers", params={"trial_id": 9999})
    assert answer.status_code == 422
    assert str(series["trial_id"]) in answer.json()["detail"]
