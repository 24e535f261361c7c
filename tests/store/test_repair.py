"""A damaged store: the rest of it is saved, and what is lost is named."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.store import Store
from bench.store.errors import StoreFileError
from bench.store.tables.chain import SUBJECTS, digest_of
from bench.store.tables.samples import columns_of, encode
from bench.store.upkeep.chain_check import ended
from bench.store.upkeep.repair import repair
from tests.store.flips import filled, flipped, records
from tests.store.freeze import rows

CASES = 40


@pytest.fixture
def path(tmp_path: Path) -> Path:
    filled(tmp_path / "bench.sqlite")
    return tmp_path / "bench.sqlite"


def saved(path: Path) -> tuple[list[str], Path]:
    target = path.with_name("saved.sqlite")
    target.unlink(missing_ok=True)
    return repair(f"sqlite:///{path}", target), target


def digests(path: Path) -> dict[str, str | None]:
    """By record, such as "trial 2"."""
    with Store.open(f"sqlite:///{path}") as store:
        return digests_in(store)


def digests_in(store: Store) -> dict[str, str | None]:
    with store._database.reading() as connection:
        return {
            f"{subject} {number}": digest_of(connection, subject, number)
            for subject in SUBJECTS
            for number in connection.execute(ended(subject)).scalars().all()
        }


def test_a_sound_store_is_saved_whole(path: Path) -> None:
    lost, target = saved(path)
    assert lost == []
    assert digests(target) == digests(path)
    with Store.open(f"sqlite:///{target}") as store:
        assert store.upkeep.check() == []


def test_lost_rows_are_named_and_empty_and_the_others_stay(path: Path) -> None:
    with Store.open(f"sqlite:///{path}") as store:
        before = store.samples(1)  # those of trial 2 are the same
    content = bytearray(path.read_bytes())
    content[content.index(encode(columns_of(rows(40, 40)))) + 100] ^= 4
    path.write_bytes(content)
    lost, target = saved(path)
    number = int(lost[0].split()[1].rstrip(":"))
    assert lost[0].startswith(f"trial {number}: rows 40 .. 79 of 120 are lost")
    with Store.open(f"sqlite:///{target}") as store:
        assert store.upkeep.check() == []
        trial, after = store.trial(number), store.samples(number)
        assert (trial.rows, trial.outcome) == (120, "interrupted")
        assert "rows 40 .. 79 of 120 are lost" in trial.reason
        assert np.isnan(after["position_rad"][40:80]).all()
        assert np.allclose(after["time_s"], before["time_s"])
        for part in (slice(0, 40), slice(80, 120)):
            assert np.array_equal(after["position_rad"][part], before["position_rad"][part])
        assert store.trial(3 - number).outcome == "completed"
        assert len(store.samples_reduced(number, None, 10)["time_s"]) > 0


def test_a_broken_page_costs_its_own_rows_alone(path: Path) -> None:
    """The page of the audit log's rows, overwritten from its beginning."""
    content = bytearray(path.read_bytes())
    place = content.index(b"POST/19") // 16_384 * 16_384
    content[place : place + 200] = bytes(200)
    path.write_bytes(content)
    with pytest.raises(StoreFileError, match="damaged"), Store.open(f"sqlite:///{path}") as store:
        store.access.audit.find()
    lost, target = saved(path)
    assert any("audit" in one for one in lost)
    with Store.open(f"sqlite:///{target}") as store:
        assert store.upkeep.check() == []
        assert [one.id for one in store.experiments()] == [2, 1]
        assert np.isfinite(store.samples(1)["position_rad"]).all()


def test_whatever_bit_is_flipped_nothing_is_lost_without_a_word(path: Path) -> None:
    sound, kept, before = path.read_bytes(), digests(path), records(path)
    cases = 0
    for bit, spoilt in flipped(sound, 5):
        path.write_bytes(spoilt)
        if records(path) == before:
            continue
        lost, target = saved(path)
        with Store.open(f"sqlite:///{target}") as store:
            found, problems = digests_in(store), store.upkeep.check()
        assert problems == [], bit
        gone = [name for name, digest in kept.items() if found.get(name) != digest]
        assert len(gone) <= 1 or lost, bit
        for name in gone:
            named = name.replace("access_token", "access token")
            table = name.split()[0]
            assert any(one.startswith((named, f"table {table}", "store")) for one in lost), (bit, name, lost)
        # the page that describes the tables is the one that costs more than a record or two
        assert len(gone) <= 2 or any(one.startswith("table") for one in lost), (bit, gone, lost)
        cases += 1
        if cases == CASES:
            return


def test_the_command_says_what_is_lost(path: Path) -> None:
    target = path.with_name("saved.sqlite")
    words = ["--store", str(path), "store", "repair", str(target)]
    done = CliRunner().invoke(app, words)
    assert (done.exit_code, "holds what could be read" in done.output) == (0, True)
    again = CliRunner().invoke(app, words)
    assert again.exit_code != 0
    assert "is there already" in again.output
    missing = CliRunner().invoke(app, ["--store", str(path.with_name("no.sqlite")), "store", "repair", str(target)])
    assert "is not there; name the damaged file" in missing.output
