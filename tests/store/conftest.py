"""A store in a temporary folder."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from bench.store import Store


@pytest.fixture(scope="session")
def empty_database(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Made once: the migrations take longer than most tests."""
    path = tmp_path_factory.mktemp("empty") / "bench.sqlite"
    Store.open(f"sqlite:///{path}").close()
    return path


@pytest.fixture
def url(tmp_path: Path) -> str:
    """The URL of a database that is not there yet."""
    return f"sqlite:///{tmp_path / 'bench.sqlite'}"


@pytest.fixture
def store(url: str, tmp_path: Path, empty_database: Path) -> Iterator[Store]:
    shutil.copy(empty_database, tmp_path / "bench.sqlite")
    with Store.open(url) as opened:
        yield opened
