"""A model in closed loop, over REST."""

import pytest

from tests.service.recorded_joint import study_path


@pytest.fixture(scope="module")
def path(service) -> str:
    return study_path(service, "moved")


def test_anybody_may_see_where_the_model_goes(service, path):
    found = service.stranger.get(f"{path}/closed-loop")
    assert found.status_code == 200, found.text
    told = found.json()
    assert told["training"]["position"] > 0.0
    assert told["refined"] is None
    assert {one["role"] for one in told["trials"]} == {"training"}
    refined = service.stranger.get(f"{path}/closed-loop", params={"refine": True}).json()["refined"]
    assert refined["training"]["effort"] <= told["training"]["effort"]


def test_it_is_computed_once(service, path):
    first = service.stranger.get(f"{path}/closed-loop")
    again = service.stranger.get(f"{path}/closed-loop", headers={"If-None-Match": first.headers["ETag"]})
    assert again.status_code == 304


def test_an_unknown_model_is_refused(service, path):
    answer = service.stranger.get(f"{path}/closed-loop", params={"model_id": 987654})
    assert answer.status_code == 422
    assert "987654" in answer.json()["detail"]


def test_what_is_kept_with_a_model_later_is_seen(service, path):
    """The error in closed loop, kept from the command line, is part of the ladder: it is not the same as before."""
    from bench.study.closed_loop import keep_motion_errors

    before = service.stranger.get(f"{path}/ladder")
    assert before.json()["rungs"][0]["motion"] is None
    assert list(keep_motion_errors(service.store, int(path.rsplit("/", 1)[1])))
    after = service.stranger.get(f"{path}/ladder", headers={"If-None-Match": before.headers["ETag"]})
    assert after.status_code == 200
    assert after.json()["rungs"][0]["motion"]["position"] > 0.0
