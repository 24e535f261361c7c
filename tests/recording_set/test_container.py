"""Zips: what is looked through, and what is refused."""

import io
import zipfile
from pathlib import Path

import pytest

from bench.recording_set import RecordingSetError, container, read_recording_set
from tests.recording_set.examples import GOOD, RIG, write_set

FILES = {"rig.toml": RIG, "trials.csv": "file,load_kg\nrun.csv,0.1\n", "run.csv": GOOD}


def write_zip(path: Path, files: dict[str, str], compression: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


def test_a_zip_reads_as_its_folder_does(tmp_path: Path) -> None:
    from_folder = read_recording_set(write_set(tmp_path / "set", dict(FILES)))
    from_zip = read_recording_set(write_zip(tmp_path / "set.zip", FILES))
    assert from_zip.name == from_folder.name == "set"
    assert from_zip.rig == from_folder.rig
    assert from_zip.recordings[0].conditions == from_folder.recordings[0].conditions == {"load_kg": 0.1}
    assert from_zip.recordings[0].channels["duty"].tolist() == [0.5, 0.25, -1.0]


def test_a_zip_of_a_folder_is_looked_through(tmp_path: Path) -> None:
    files = {f"my set/{name}": content for name, content in FILES.items()} | {"__MACOSX/my set/._run.csv": "x"}
    assert len(read_recording_set(write_zip(tmp_path / "a.zip", files)).recordings) == 1


def test_files_may_lie_in_folders_of_the_set(tmp_path: Path) -> None:
    files = {"rig.toml": RIG, "trials.csv": "file\na/run.csv\nb/run.csv\n", "a/run.csv": GOOD, "b/run.csv": GOOD}
    found = read_recording_set(write_zip(tmp_path / "a.zip", files))
    assert [recording.name for recording in found.recordings] == ["a/run", "b/run"]
    assert len(read_recording_set(write_set(tmp_path / "set", dict(files))).recordings) == 2


def test_a_single_table_is_a_set_of_one(tmp_path: Path) -> None:
    folder = write_set(tmp_path / "set", {"run.csv": GOOD, "other.csv": "not,a\ntable"})
    with pytest.raises(RecordingSetError, match="or name --rig"):
        read_recording_set(folder / "run.csv")
    rig = read_recording_set(write_set(tmp_path / "b", {"run.csv": GOOD})).rig
    found = read_recording_set(folder / "run.csv", rig=rig)
    assert [recording.name for recording in found.recordings] == ["run"]


@pytest.mark.parametrize("name", ["../run.csv", "/run.csv", "a/../../run.csv", "C:run.csv"])
def test_a_zip_that_leads_out_of_itself_is_refused(tmp_path: Path, name: str) -> None:
    path = write_zip(tmp_path / "a.zip", FILES | {name: GOOD})
    with pytest.raises(RecordingSetError, match=r"a.zip: the file name '.*' leads out of the set"):
        read_recording_set(path)


def test_a_zip_that_unpacks_to_far_more_than_it_is_is_refused(tmp_path: Path) -> None:
    path = write_zip(tmp_path / "a.zip", FILES | {"zeros.csv": "0" * (container.RATIO_FROM_BYTES + 1)})
    with pytest.raises(RecordingSetError, match=r"a.zip: unpacks to \d+ times its size; at most 250"):
        read_recording_set(path)


@pytest.mark.parametrize(("limit", "message"), [("MOST_BYTES", "unpacks to"), ("MOST_FILES", "holds 3 files")])
def test_a_zip_that_is_too_large_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, limit: str, message: str
) -> None:
    monkeypatch.setattr(container, limit, 2)
    with pytest.raises(RecordingSetError, match=f"{message}.*Split the set"):
        read_recording_set(write_zip(tmp_path / "a.zip", FILES))


def test_a_zip_that_says_less_than_it_holds_is_refused(tmp_path: Path) -> None:
    path = write_zip(tmp_path / "a.zip", FILES, zipfile.ZIP_STORED)
    content = bytearray(path.read_bytes())
    sizes = len(GOOD).to_bytes(4, "little")
    content = content.replace(sizes, (len(GOOD) - 8).to_bytes(4, "little"))
    path.write_bytes(content)
    with pytest.raises(RecordingSetError, match=r"a.zip: is no zip, or a damaged one"):
        read_recording_set(path)


def test_a_file_twice_in_a_zip_is_refused(tmp_path: Path) -> None:
    path = write_zip(tmp_path / "a.zip", FILES)
    with zipfile.ZipFile(path, "a") as archive, pytest.warns(UserWarning, match="Duplicate name"):
        archive.writestr("run.csv", GOOD)
    with pytest.raises(RecordingSetError, match=r"holds 'run.csv' twice"):
        read_recording_set(path)


@pytest.mark.parametrize("damage", ["cut", "flipped", "text", "empty"])
def test_a_damaged_zip_is_refused(tmp_path: Path, damage: str) -> None:
    lines = "".join(f"{time},{time % 7},0.5\n" for time in range(20_000))
    path = write_zip(tmp_path / "a.zip", FILES | {"run.csv": "time_s,position_rad,duty\n" + lines})
    content = bytearray(path.read_bytes())
    if damage == "cut":
        content = content[: len(content) // 2]
    elif damage == "flipped":
        middle = len(content) // 2
        content[middle : middle + 20] = bytes(20)
    else:
        content = bytearray(b"time_s,duty\n" if damage == "text" else b"")
    path.write_bytes(content)
    with pytest.raises(RecordingSetError, match=r"a.zip: is no zip, or a damaged one"):
        read_recording_set(path)


@pytest.mark.parametrize("where", ["file", "directory"])
def test_a_zip_with_a_name_that_is_no_text_is_refused(tmp_path: Path, where: str) -> None:
    # not ASCII: its name is flagged as UTF-8
    files = {name.replace("run", "läufe"): text.replace("run.csv", "läufe.csv") for name, text in FILES.items()}
    path = write_zip(tmp_path / "a.zip", files)
    content, name = bytearray(path.read_bytes()), "läufe".encode()
    at = content.find(name) if where == "file" else content.rfind(name)
    content[at + 1] = 0x93  # goes on with a character that never began
    path.write_bytes(content)
    with pytest.raises(RecordingSetError, match=r"a.zip: is no zip, or a damaged one \(the name of a file is no UTF-8"):
        read_recording_set(path)


def test_an_encrypted_zip_is_refused(tmp_path: Path) -> None:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in FILES.items():
            archive.writestr(name, content)
    content_bytes = bytearray(buffer.getvalue())
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):  # the flag "encrypted", in both places
        start = content_bytes.find(signature)
        while start >= 0:
            content_bytes[start + offset] |= 1
            start = content_bytes.find(signature, start + 1)
    (tmp_path / "a.zip").write_bytes(content_bytes)
    with pytest.raises(RecordingSetError, match="zip it again without a password"):
        read_recording_set(tmp_path / "a.zip")
