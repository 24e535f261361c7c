"""Uploads that are broken on purpose: a clear refusal, and nothing is kept of them."""

import io
import os
import random
import tempfile
import time
import zipfile

import pytest

from bench.recording_set.container import MOST_FILES

RIG = b'name = "r"\n'
TABLE = b"time_s,position_rad,current_a\n" + b"".join(b"0.%02d,0.%02d,0.1\n" % (row, row) for row in range(50))
TYPE = {"Content-Type": "application/zip"}
MUTATIONS = 60
BLANKS, DIGITS = b" " * 20_000, b"1" * 200_000  # what a regular expression may go through again and again
AT_ONCE_S = 5.0
EVENTS = {"lists without end": b"[" * 60_000, "a moment beyond all": b'"[[' + b"9" * 400 + b',""x"",""y""]]"'}


def zipped(*members: tuple[str | zipfile.ZipInfo, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members:
            archive.writestr(name, data)
    return buffer.getvalue()


def with_table(text: bytes) -> bytes:
    return zipped(("rig.toml", RIG), ("a.csv", text))


def link(target: str) -> tuple[zipfile.ZipInfo, bytes]:
    info = zipfile.ZipInfo("a.csv")
    info.create_system, info.external_attr = 3, 0o120777 << 16
    return info, target.encode()


def many_entries() -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for number in range(MOST_FILES + 1):
            archive.writestr(zipfile.ZipInfo(f"{number}.csv"), b"")
    return buffer.getvalue()


UPLOADS = {
    "path traversal": lambda: zipped(("rig.toml", RIG), ("../a.csv", TABLE)),
    "absolute path": lambda: zipped(("rig.toml", RIG), ("/tmp/a.csv", TABLE)),
    "path of Windows": lambda: zipped(("rig.toml", RIG), ("..\\a.csv", TABLE)),
    "traversal in trials.csv": lambda: zipped(
        ("rig.toml", RIG), ("trials.csv", b"file,kind\n../../a.csv,steps\n"), ("a.csv", TABLE)
    ),
    "link": lambda: zipped(("rig.toml", RIG), link("/etc/passwd")),
    "bomb": lambda: zipped(("rig.toml", RIG), ("a.csv", TABLE), ("b.csv", b"0" * 100_000_000)),
    "too many entries": many_entries,
    "infinite": lambda: with_table(b"time_s,duty\n0,1e999\n"),
    "number of 100000 digits": lambda: with_table(b"time_s,duty\n0," + b"9" * 100_000 + b"\n"),
    "huge time": lambda: with_table(b"time_s,duty\n0,0\n1e308,0\n1e309,0\n"),
    "time backwards": lambda: with_table(b"time_s,duty\n1,0\n0,0\n"),
    "Latin-1 rig": lambda: zipped(("rig.toml", 'name = "é"'.encode("latin-1")), ("a.csv", TABLE)),
    "huge number in the rig": lambda: zipped(("rig.toml", RIG + b"[gear]\nratio = 1e400\n"), ("a.csv", TABLE)),
    "deep TOML": lambda: zipped(("rig.toml", b"a = " + b"[" * 20_000), ("a.csv", TABLE)),
    "NUL in the table": lambda: with_table(b"time_s,duty\n0,\x000\n"),
    "columns without end": lambda: with_table(b"time_s," + b"x," * 200_000 + b"\n"),
    "one endless line": lambda: with_table(b"time_s,duty\n" + b"1" * 5_000_000),
    "blanks in the rig": lambda: zipped(("rig.toml", RIG + b'q=1\nnote="""\n' + BLANKS + b'x\n"""'), ("a.csv", TABLE)),
    "dots in the rig": lambda: zipped(("rig.toml", RIG + b"a." * 250_000 + b"a=1\n"), ("a.csv", TABLE)),
    "keys of many parts": lambda: zipped(("rig.toml", RIG + (b"a." * 8000 + b"a=1\n") * 20), ("a.csv", TABLE)),
    "digits without a header": lambda: with_table(b"a;b\n" + DIGITS + b"x;1\n"),
    "digits of a rate": lambda: with_table(b"sampl" + DIGITS + b"\na;b\n1;2\n1;2\n"),
    "blanks in a name": lambda: with_table(b"a" + BLANKS + b"b,time_s\n0,0\n1,1\n"),
    "digits in a stamp": lambda: with_table(b"time_s,t\n0,1:" + DIGITS + b"\n"),
    "no encoding of files": lambda: zipped(("rig.toml", RIG), ("a.csv", TABLE), ("mapping.toml", b'encoding="hex"')),
    "an integer without end": lambda: zipped(
        ("rig.toml", RIG), ("a.json", b'[{"time_s":0},{"time_s":' + DIGITS + b"}]")
    ),
    "a large integer": lambda: zipped(("rig.toml", RIG), ("a.json", b'[{"time_s":0},{"time_s":1' + b"0" * 400 + b"}]")),
    "events without end": lambda: with_table(
        b"time_s,position_rad,current_a,event\n" + b"".join(b"%d,0,0,x\n" % row for row in range(20_000))
    ),
    "a condition without end": lambda: zipped(
        ("rig.toml", RIG), ("a.csv", TABLE), ("trials.csv", b"file,kind,grease\na.csv,steps," + BLANKS + b"x\n")
    ),
    "a name without end": lambda: zipped(("rig.toml", b'name = "' + DIGITS + b'"\n'), ("a.csv", TABLE)),
    "empty zip": zipped,
    "truncated": lambda: with_table(TABLE)[:-30],
}


@pytest.fixture(autouse=True)
def temporary(tmp_path, monkeypatch):
    """A folder for temporary files that nobody else writes into."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def refused(service, body: bytes) -> str:
    before = service.store.experiments(limit=1)
    began_s = time.process_time()
    answer = service.client.post("/recording-sets?name=fuzzed", content=body, headers=TYPE)
    assert time.process_time() < began_s + AT_ONCE_S
    assert 400 <= answer.status_code < 500, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert service.store.experiments(limit=1) == before
    assert os.listdir(tempfile.gettempdir()) == []
    return str(answer.json()["detail"])


@pytest.mark.parametrize("what", UPLOADS)
def test_a_hostile_upload_is_refused_and_leaves_nothing(service, what):
    detail = refused(service, UPLOADS[what]())
    assert 10 < len(detail) < 2000
    assert tempfile.gettempdir() not in detail
    assert "/tmp" not in detail.replace("/tmp/a.csv", "")


@pytest.mark.parametrize("what", EVENTS)
def test_text_that_is_no_list_of_events_is_a_name(service, what):
    table = b"time_s,position_rad,current_a,event\n0,0,0,\n0.1,0.1,0.1,%s\n0.2,0.2,0.1,\n" % EVENTS[what]
    answer = service.client.post("/recording-sets?name=events", content=with_table(table), headers=TYPE)
    assert answer.status_code in (201, 422), answer.text
    if answer.status_code == 201:
        trials = service.client.get(f"/trials?experiment_id={answer.json()['experiment_id']}").json()["items"]
        assert service.client.get(f"/trials/{trials[0]['trial_id']}/csv").status_code == 200


def test_the_same_set_unbroken_comes_in(service):
    answer = service.client.post("/recording-sets?name=whole", content=with_table(TABLE), headers=TYPE)
    assert (answer.status_code, answer.json()["rows"]) == (201, 50)


@pytest.mark.parametrize("seed", range(4))
def test_damaged_at_random_it_comes_in_whole_or_not_at_all(service, seed):
    generator, whole = random.Random(seed), with_table(TABLE)
    for _ in range(MUTATIONS // 4):
        body = bytearray(whole)
        for _ in range(generator.randint(1, 8)):
            body[generator.randrange(len(body))] = generator.randrange(256)
        cut = bytes(body[: generator.randint(1, len(body))] if generator.random() < 0.3 else body)
        before = service.store.experiments(limit=1)
        answer = service.client.post("/recording-sets?name=mutated", content=cut, headers=TYPE)
        assert answer.status_code in (201, 422), answer.text
        if answer.status_code == 422:
            assert service.store.experiments(limit=1) == before
        else:  # a byte that changes nothing that is read
            assert (answer.json()["trials"], answer.json()["rows"]) == (1, 50)
