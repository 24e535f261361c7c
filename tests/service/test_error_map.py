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
