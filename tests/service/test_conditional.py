"""What a client has already is not sent again; a list is read page by page."""

import pytest


@pytest.fixture(scope="module")
def experiment_id(service) -> int:
    assert service.runner.wait(30.0)
    return service.run("steps", repeats=1)["experiment_id"]


def test_what_is_finished_is_sent_once(service, experiment_id):
    trial_id = service.store.trials(experiment_id)[0].id
    of_trial = ("", "/samples", "/samples?points=100", "/csv", "/parquet")
    of_experiment = ("", "/recording-set", "/parquet")
    paths = [f"/trials/{trial_id}{rest}" for rest in of_trial]
    for path in paths + [f"/experiments/{experiment_id}{rest}" for rest in of_experiment]:
        first = service.stranger.get(path)
        assert first.status_code == 200
        tag = first.headers["etag"]
        again = service.stranger.get(path, headers={"If-None-Match": f'"other", {tag}'})
        assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", tag), path
        assert service.stranger.get(path, headers={"If-None-Match": 'W/"other"'}).status_code == 200


def test_what_goes_on_is_sent_each_time(idle):
    running = idle.start("steps", pace="real-time", repeats=3)
    path = f"/experiments/{running}"
    before = idle.stranger.get(path)
    while not idle.store.trials(running):
        pass
    trial_id = idle.store.trials(running)[0].id
    assert "etag" not in idle.stranger.get(f"/trials/{trial_id}/csv").headers
    idle.client.post("/stop")
    assert idle.runner.wait(10.0)
    after = idle.stranger.get(path, headers={"If-None-Match": before.headers["etag"]})
    assert after.status_code == 200
    assert after.json()["outcome"] == "stopped"


def test_what_is_not_there_is_not_called_unchanged(service):
    assert service.stranger.get("/trials/999999", headers={"If-None-Match": "*"}).status_code == 404


@pytest.mark.parametrize("path", ["/experiments", "/trials", "/calibrations", "/studies", "/audit"])
def test_every_list_has_the_same_pages(service, experiment_id, path):
    found = service.client.get(path, params={"limit": 1}).json()
    assert set(found) == {"items", "limit", "offset", "next_offset"}
    assert (found["limit"], found["offset"]) == (1, 0)
    assert len(found["items"]) <= 1
    beyond = service.client.get(path, params={"offset": 2**31}).json()
    assert (beyond["items"], beyond["next_offset"]) == ([], None)
    for wrong in ({"limit": 0}, {"limit": 1001}, {"offset": -1}, {"offset": 2**31 + 1}):
        assert service.client.get(path, params=wrong).status_code == 422
