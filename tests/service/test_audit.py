"""Who did what is on record, and no secret is."""

import sqlite3
import threading
import time
from collections import OrderedDict
from contextlib import closing
from datetime import UTC, datetime, timedelta

import pytest

from bench.service.auth.attempts import BURST
from bench.service.auth.audit_trail import AuditWriter
from bench.store import Store
from bench.store.errors import StoreLockedError
from bench.store.tables.audit import AuditEntry
from tests.service.running_service import TOKEN


def entry(number: int, at_utc: datetime = datetime(2026, 1, 1, tzinfo=UTC)) -> AuditEntry:
    return AuditEntry(at_utc, "ada", "operator", "127.0.0.1", "POST", f"/{number}", 200, "")


def wait_for(service, path, status, token):
    deadline_s = time.monotonic() + 20.0
    while True:
        for deed in service.client.get("/audit", params={"limit": 20}).json()["items"]:
            if (deed["path"], deed["status"], deed["token"]) == (f"/api/v1{path}", status, token):
                return deed
        assert time.monotonic() < deadline_s
        time.sleep(0.05)


def test_deeds_are_on_record_with_who_and_what(idle):
    with idle.with_token("auditor", "operator") as client:
        started = client.post("/experiments", json={"kind": "steps", "parameters": {"repeats": 1}, "pace": "fast"})
    deed = wait_for(idle, "/experiments", 201, "auditor")
    assert deed["detail"] == f"started experiment {started.json()['experiment_id']} (steps)"
    assert (deed["role"], deed["client"], deed["method"]) == ("operator", "127.0.0.1", "POST")
    idle.client.post("/stop", json={"reason": "cable \x1b[31mis caught"})
    assert "\x1b" not in wait_for(idle, "/stop", 200, "environment")["detail"]


def test_refusals_are_on_record_without_the_token_that_was_tried(service, monkeypatch):
    monkeypatch.setattr(service.access.attempts, "_full_at_s", OrderedDict())
    monkeypatch.setattr(service.access.strangers, "_full_at_s", OrderedDict())
    wrong = "wrong-token-of-this-test"
    service.stranger.post(f"/studies/77/search?token={wrong}", json={}, headers={"Authorization": f"Bearer {wrong}"})
    assert wait_for(service, "/studies/77/search", 401, "")["detail"] == ""
    path = service.store._database.backend.path
    with closing(sqlite3.connect(path)) as connection:
        dump = "\n".join(connection.iterdump())
    assert wrong not in dump
    assert TOKEN not in dump


def test_strangers_do_not_fill_the_store(service, monkeypatch):
    monkeypatch.setattr(service.access.strangers, "_full_at_s", OrderedDict())
    for number in range(3 * BURST):
        service.stranger.post(f"/nowhere/{number}")
    wait_for(service, f"/nowhere/{BURST - 1}", 404, "")
    service.client.post("/stop").raise_for_status()  # whoever has a token is noted whatever came before
    wait_for(service, "/stop", 200, "environment")
    found = service.client.get("/audit", params={"limit": 100}).json()["items"]
    assert len([one for one in found if "/nowhere/" in one["path"]]) <= BURST + 2


def test_reading_and_heartbeats_are_not(idle):
    idle.client.get("/bench")
    idle.client.post("/lease")
    idle.client.put("/lease")
    idle.client.delete("/lease")
    wait_for(idle, "/lease", 204, "environment")
    deeds = idle.client.get("/audit", params={"limit": 1000}).json()["items"]
    assert "GET" not in {deed["method"] for deed in deeds}
    # one without a token is a refusal, and on record: other tests try that
    assert ("PUT", "/api/v1/lease") not in {(deed["method"], deed["path"]) for deed in deeds if deed["status"] < 400}


def test_pages_and_names(service):
    service.store.access.audit.add([entry(number) for number in range(5)])
    page = service.client.get("/audit", params={"token": "ada", "limit": 2}).json()
    assert [deed["path"] for deed in page["items"]] == ["/4", "/3"]
    assert page["next_offset"] == 2
    rest = service.client.get("/audit", params={"token": "ada", "limit": 3, "offset": 2}).json()
    assert [deed["path"] for deed in rest["items"]] == ["/2", "/1", "/0"]
    assert rest["next_offset"] is None


def test_old_entries_are_removed(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as store:
        moment = datetime.now(UTC)
        store.access.audit.add([entry(1, moment - timedelta(days=40)), entry(2, moment)])
        assert store.access.audit.count_older(30) == 1
        assert store.access.audit.remove_older(30) == 1
        assert [one.path for one in store.access.audit.find()] == ["/2"]


def test_the_writer_tries_again_and_never_holds_up_who_adds():
    kept: list[AuditEntry] = []
    locked = threading.Event()
    locked.set()

    def write(entries):
        if locked.is_set():
            locked.clear()
            raise StoreLockedError("locked")
        kept.extend(entries)

    writer = AuditWriter(write)
    writer.start()
    for number in range(100):
        writer.add(entry(number))
    deadline_s = time.monotonic() + 20.0
    while len(kept) < 100:
        assert time.monotonic() < deadline_s
        time.sleep(0.02)
    writer.close()
    assert [one.path for one in kept] == [f"/{number}" for number in range(100)]


def test_what_waits_is_written_at_the_end():
    kept: list[AuditEntry] = []
    writer = AuditWriter(kept.extend)
    writer.start()
    for number in range(50):
        writer.add(entry(number))
    writer.close()
    assert len(kept) == 50


@pytest.mark.parametrize("role", ["viewer", "operator"])
def test_only_admins_read_it(service, role):
    with service.with_token(f"curious {role}", role) as client:
        assert client.get("/audit").status_code == 403
