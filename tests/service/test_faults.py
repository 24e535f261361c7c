"""What nobody foresaw, and a store that goes away: the answer says so, and the service stays of use."""

import http.client
from urllib.parse import urlsplit

import pytest

from bench.store import Store
from tests.service.running_service import running_service

# of every room that reads the store
READS = (
    "/experiments",
    "/experiments/1",
    "/trials",
    "/trials/1",
    "/trials/1/rows",
    "/trials/1/csv",
    "/trials/1/reduced?channel=position_rad",
    "/studies",
    "/studies/1",
    "/calibrations",
    "/queue",
    "/audit",
    "/experiments/1/zip",
)


def test_a_fault_of_the_software_does_not_close_the_connection(service, monkeypatch):
    def fails(*_, **__):
        raise RuntimeError("nobody foresaw this")

    address = urlsplit(service.url)
    connection = http.client.HTTPConnection(address.hostname, address.port, timeout=10)
    connection.connect()
    connection.auto_open = 0  # what was closed stays closed
    with monkeypatch.context() as broken:
        broken.setattr(Store, "experiments", fails)
        connection.request("GET", "/api/v1/experiments")
        answer = connection.getresponse()
        assert answer.status == 500
        assert answer.headers["content-type"] == "application/problem+json"
        assert b"nobody foresaw" not in answer.read()
    connection.request("GET", "/api/v1/experiments")
    again = connection.getresponse()
    assert again.status == 200
    again.read()
    connection.close()


@pytest.mark.parametrize("replaced", [False, True])
def test_a_store_that_was_deleted_is_a_problem_that_says_so(tmp_path, replaced):
    with running_service(tmp_path) as service:
        service.run("steps", repeats=1)
        known = {path for path in READS if service.client.get(path).status_code == 200}
        for file in tmp_path.glob("bench.sqlite*"):
            file.unlink()
        if replaced:
            (tmp_path / "bench.sqlite").touch()
        assert len(known) >= 9
        for path in known:
            answer = service.client.get(path)
            assert answer.status_code == 503, (path, answer.text)
            assert "was deleted, moved or replaced" in answer.json()["detail"]
        started = service.client.post("/experiments", json={"kind": "steps", "parameters": {"repeats": 1}})
        assert started.status_code == 503
        assert service.client.get("/bench").status_code == 200
        assert service.client.post("/stop").status_code == 200
        assert replaced or not (tmp_path / "bench.sqlite").exists()
