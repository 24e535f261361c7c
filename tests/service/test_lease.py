"""Who has the bench."""

import time

import pytest

from bench.runs.lease import Lease, LeaseHeldError, NoLeaseError


class Bench:
    """What a lease sees: a clock and a run."""

    def __init__(self) -> None:
        self.time_s = 0.0
        self.run: int | None = None
        self.lease = Lease(lambda: self.run, lambda: self.time_s)


def test_a_lease_ends_by_itself_and_a_heartbeat_keeps_it():
    bench = Bench()
    bench.lease.take("ada", "Ada, room 12", 60.0)
    bench.time_s = 40.0
    with pytest.raises(LeaseHeldError, match=r"held by Ada, room 12 \(token 'ada'\) for another 20 s"):
        bench.lease.require("bob")
    bench.lease.renew("ada", 60.0)
    bench.time_s = 99.9
    assert bench.lease.current().remaining_s == pytest.approx(0.1)
    bench.time_s = 100.0
    assert bench.lease.current() is None
    with pytest.raises(NoLeaseError):
        bench.lease.renew("ada", 60.0)
    bench.lease.take("bob", "", 60.0)
    with pytest.raises(LeaseHeldError, match="held by bob"):
        bench.lease.renew("ada", 60.0)
    with pytest.raises(LeaseHeldError):
        bench.lease.release("ada")


def test_a_start_without_a_lease_has_the_bench_for_its_run():
    bench = Bench()
    with bench.lease.starting("ada"):
        with pytest.raises(LeaseHeldError, match="until the experiment that runs has ended"):
            bench.lease.require("bob")
        bench.run = 7
    with pytest.raises(LeaseHeldError), bench.lease.starting("bob"):
        pytest.fail("it began")
    bench.time_s = 1e6
    assert bench.lease.current().remaining_s is None
    bench.run = 8  # one that somebody else began after the end of that
    assert bench.lease.current() is None


def test_a_start_that_fails_leaves_the_bench_free():
    bench = Bench()
    with pytest.raises(ValueError, match="refused"), bench.lease.starting("ada"):
        raise ValueError("refused")
    bench.lease.require("bob")


def test_a_start_under_a_lease_keeps_it_as_it_is():
    bench = Bench()
    bench.lease.take("ada", "", 60.0)
    with bench.lease.starting("ada"):
        bench.run = 7
    assert bench.lease.current().remaining_s == pytest.approx(60.0)
    bench.time_s = 61.0
    bench.lease.take("bob", "", 60.0)  # the bench is free, and the experiment goes on
    assert bench.lease.current().token == "bob"


def test_an_admin_takes_over():
    bench = Bench()
    bench.lease.take("ada", "", 60.0)
    bench.lease.take("boss", "", 60.0, take_over=True)
    with pytest.raises(LeaseHeldError, match="boss"):
        bench.lease.require("ada")


@pytest.fixture
def ada(idle):
    with idle.with_token(f"ada {time.monotonic_ns()}", "operator") as client:
        yield client
        client.delete("/lease")


@pytest.fixture
def bob(idle):
    with idle.with_token(f"bob {time.monotonic_ns()}", "operator") as client:
        yield client


def test_others_wait_and_everybody_can_stop(idle, ada, bob):
    taken = ada.post("/lease", json={"duration_s": 60, "holder": "Ada, room 12"})
    assert taken.status_code == 201
    shown = idle.stranger.get("/bench").json()["lease"]
    assert shown["holder"] == "Ada, room 12"
    assert 50 < shown["remaining_s"] <= 60
    for path, body in (("/experiments", {"kind": "steps"}), ("/continue", {"prompt": 1}), ("/lease", {})):
        answer = bob.post(path, json=body)
        assert answer.status_code == 409, path
        assert answer.headers["content-type"] == "application/problem+json"
        assert "held by Ada, room 12" in answer.json()["detail"]
        assert "for another" in answer.json()["detail"]
        assert 1 <= int(answer.headers["retry-after"]) <= 60
    started = ada.post("/experiments", json={"kind": "steps", "pace": "real-time", "parameters": {"repeats": 3}})
    assert started.status_code == 201
    with idle.with_token(f"viewer {time.monotonic_ns()}", "viewer") as viewer:
        assert viewer.post("/lease").status_code == 403
        assert viewer.post("/stop").json()["was_running"] is True
    assert idle.runner.wait(10.0)
    assert ada.put("/lease", json={"duration_s": 30}).json()["lease"]["remaining_s"] == 30
    assert ada.delete("/lease").status_code == 204
    assert ada.put("/lease").status_code == 409
    assert bob.post("/lease").status_code == 201
    assert bob.delete("/lease").status_code == 204


def test_a_start_holds_the_bench_until_its_run_has_ended(idle, ada, bob):
    body = {"kind": "steps", "pace": "real-time", "parameters": {"repeats": 3}}
    assert ada.post("/experiments", json=body).status_code == 201
    refused = bob.post("/lease")
    assert refused.status_code == 409
    assert "until the experiment that runs has ended" in refused.json()["detail"]
    assert bob.post("/stop").status_code == 200
    assert idle.runner.wait(10.0)
    assert idle.stranger.get("/bench").json()["lease"] is None
    assert bob.post("/lease").status_code == 201
    assert bob.delete("/lease").status_code == 204


def test_only_an_admin_takes_over_and_it_is_on_record(idle, ada, bob):
    ada.post("/lease", json={"holder": "Ada"})
    assert bob.post("/lease", json={"take_over": True}).status_code == 403
    assert idle.client.post("/lease", json={"take_over": True}).status_code == 201
    assert ada.post("/experiments", json={"kind": "steps"}).status_code == 409
    assert idle.client.delete("/lease").status_code == 204
    deadline_s = time.monotonic() + 10.0
    while not any("took over the bench from Ada" in one.detail for one in idle.store.access.audit.find(limit=5)):
        assert time.monotonic() < deadline_s
        time.sleep(0.05)


@pytest.mark.parametrize("body", [{"duration_s": 1}, {"duration_s": 1e9}, {"duration_s": "long"}, {"surprise": 1}])
def test_bad_leases_are_problems(idle, body):
    answer = idle.client.post("/lease", json=body)
    assert answer.status_code == 422
    assert idle.stranger.get("/lease").json() == {"lease": None}
