"""A store that may not be written: an archive on a disk that is mounted for reading, a colleague's folder."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from bench.store import Store
from bench.store.errors import StoreReadOnlyError
from tests.store.examples import begin, begin_trial, rows

NOBODY = 65534


@pytest.fixture
def folder() -> Iterator[Path]:
    """A folder that every user may enter; pytest's own are for one user alone."""
    made = Path(tempfile.mkdtemp(prefix="friction-bench-"))
    made.chmod(0o755)
    yield made
    made.chmod(0o755)
    shutil.rmtree(made)


@contextmanager
def without_rights() -> Iterator[None]:
    """As a user who owns nothing: the administrator may write everywhere."""
    before = os.geteuid()
    if before == 0:
        os.seteuid(NOBODY)
    try:
        yield
    finally:
        os.seteuid(before)


def recorded(folder: Path) -> str:
    url = f"sqlite:///{folder / 'bench.sqlite'}"
    with Store.open(url) as store:
        experiment_id = begin(store)
        writer = begin_trial(store, experiment_id)
        writer.append(rows(0, 100))
        store.finish_experiment(experiment_id, "completed")
    return url


@pytest.mark.parametrize(("of_file", "of_folder"), [(0o444, 0o555), (0o644, 0o555), (0o444, 0o755)])
def test_what_may_not_be_written_is_read(folder: Path, of_file: int, of_folder: int) -> None:
    url = recorded(folder)
    (folder / "bench.sqlite").chmod(of_file)
    folder.chmod(of_folder)
    with without_rights(), Store.open(url) as store:
        assert [one.outcome for one in store.experiments()] == ["completed"]
        assert len(store.samples(store.trials()[0].id)["time_s"]) == 100
        assert store.upkeep.check() == []
        with pytest.raises(StoreReadOnlyError, match="read-only; make the file and its folder writable"):
            begin(store)
    assert [one.name for one in folder.iterdir()] == ["bench.sqlite"]


def test_a_log_that_needs_a_writable_folder_is_told_of(folder: Path) -> None:
    """What was committed last stands in the log. To leave it out would be to show half of a run."""
    url = recorded(folder)
    with Store.open(url) as writes:
        begin(writes)
        for ending in ("", "-wal"):
            shutil.copy(folder / f"bench.sqlite{ending}", folder / f"copy.sqlite{ending}")
            (folder / f"copy.sqlite{ending}").chmod(0o444)
        folder.chmod(0o555)
        with without_rights(), pytest.raises(StoreReadOnlyError, match="with its -wal where it has one"):
            Store.open(f"sqlite:///{folder / 'copy.sqlite'}")
        folder.chmod(0o755)
