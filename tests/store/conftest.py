"""A store in either database: each test that asks for `url` or `store` runs over both."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from bench.store import Store
from tests.databases import PostgresqlServer, postgresql_server

BACKENDS = ("sqlite", "postgresql")


@pytest.fixture(scope="session")
def empty_database(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Made once: the migrations take longer than most tests."""
    path = tmp_path_factory.mktemp("empty") / "bench.sqlite"
    Store.open(f"sqlite:///{path}").close()
    return path


@pytest.fixture(scope="session")
def server() -> Iterator[PostgresqlServer]:
    with postgresql_server() as running:
        yield running


@pytest.fixture(scope="session")
def empty_template(server: PostgresqlServer) -> str:
    """As `empty_database`, to be copied by the server."""
    name = server.create()
    Store.open(server.url(name)).close()
    return name


@pytest.fixture(params=BACKENDS)
def backend(request: pytest.FixtureRequest) -> str:
    name: str = request.param
    return name


@pytest.fixture
def sqlite_url(tmp_path: Path) -> str:
    """The URL of a file that is not there yet."""
    return f"sqlite:///{tmp_path / 'bench.sqlite'}"


@pytest.fixture
def url(backend: str, request: pytest.FixtureRequest) -> Iterator[str]:
    """The URL of a database that has no tables yet."""
    if backend == "sqlite":
        yield request.getfixturevalue("sqlite_url")
        return
    server: PostgresqlServer = request.getfixturevalue("server")
    name = server.create()
    yield server.url(name)
    server.drop(name)


@pytest.fixture
def store_url(backend: str, request: pytest.FixtureRequest) -> Iterator[str]:
    """The URL of a database whose tables are made, and empty."""
    if backend == "sqlite":
        url: str = request.getfixturevalue("sqlite_url")
        shutil.copy(request.getfixturevalue("empty_database"), url.removeprefix("sqlite:///"))
        yield url
        return
    server: PostgresqlServer = request.getfixturevalue("server")
    name = server.create(request.getfixturevalue("empty_template"))
    yield server.url(name)
    server.drop(name)


@pytest.fixture
def store(store_url: str) -> Iterator[Store]:
    with Store.open(store_url) as opened:
        yield opened
