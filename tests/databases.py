"""A PostgreSQL server of the tests' own: in a temporary folder, reached by a socket in it, gone afterwards."""

import glob
import os
import shutil
import subprocess
import tempfile
import time
import uuid
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import create_engine, text

HOW_TO_GET_IT = "no PostgreSQL server found; install it: apt-get install postgresql"
FAST = {"fsync": "off", "synchronous_commit": "off", "full_page_writes": "off", "max_connections": "60"}


class PostgresqlServer:
    """Makes databases in a running server.

    Args:
        folder: of its data and its socket.
        control: runs pg_ctl with a verb and options.
    """

    def __init__(self, folder: Path, control: Callable[..., None]) -> None:
        self._folder, self._control = folder, control
        self._admin = create_engine(
            self.url("postgres").replace("postgresql:", "postgresql+psycopg:"), isolation_level="AUTOCOMMIT"
        )

    def url(self, name: str) -> str:
        return f"postgresql://postgres@/{name}?host={self._folder}"

    def create(self, template: str = "template1") -> str:
        """Make a database, as a copy of another one. Returns its name."""
        name = f"bench_{uuid.uuid4().hex[:12]}"
        self.run(f"CREATE DATABASE {name} TEMPLATE {template}")
        return name

    def drop(self, name: str) -> None:
        self.run(f"DROP DATABASE IF EXISTS {name} WITH (FORCE)")

    def run(self, statement: str) -> None:
        with self._admin.connect() as connection:
            connection.execute(text(statement))

    def cpu_s(self) -> float:
        """CPU time of all processes of the server that live now [s]."""
        parent = (self._folder / "data" / "postmaster.pid").read_text().split()[0]
        children = Path(f"/proc/{parent}/task/{parent}/children").read_text().split()
        return sum(int(Path(f"/proc/{one}/schedstat").read_text().split()[0]) for one in children) * 1e-9

    def crash(self, down_s: float = 0.0) -> None:
        """End all its processes at once, and start it anew."""
        self._control("stop", "-m", "immediate")
        time.sleep(down_s)
        self._control("start")

    def close(self) -> None:
        self._admin.dispose()


@contextmanager
def postgresql_server(settings: Mapping[str, str] = FAST) -> Iterator[PostgresqlServer]:
    """A server with some settings of its own, or a skipped test where there is none to start."""
    programs = _programs()
    folder = Path(tempfile.mkdtemp(prefix="fb-pg-"))  # short: a socket's path has at most 107 characters
    user = "postgres" if os.geteuid() == 0 else None  # the server refuses to run as root
    if user:
        shutil.chown(folder, user)
    try:
        _run(user, programs / "initdb", "-D", folder / "data", "-U", "postgres", "-A", "trust", "-E", "UTF8", "-N")
        options = " ".join(f"-c {name}={value}" for name, value in settings.items())
        options += f" -c listen_addresses='' -c unix_socket_directories={folder}"
        place = ("-D", folder / "data", "-o", options, "-l", folder / "log", "-w")

        def control(verb: str, *more: str) -> None:
            _run(user, programs / "pg_ctl", verb, *(place if verb == "start" else place[:2]), *more)

        control("start")
        server = PostgresqlServer(folder, control)
        try:
            yield server
        finally:
            server.close()
            control("stop", "-m", "immediate")
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _programs() -> Path:
    pytest.importorskip("psycopg", reason="needs psycopg: pip install 'friction-bench[postgresql]'")
    found = [shutil.which("initdb"), *sorted(glob.glob("/usr/lib/postgresql/*/bin/initdb"), reverse=True)]
    folders = [Path(path).resolve().parent for path in found if path]
    if not folders:
        pytest.skip(HOW_TO_GET_IT)
    return folders[0]


def _run(user: str | None, *command: str | Path) -> None:
    done = subprocess.run(
        command, user=user, cwd="/", stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    if done.returncode:
        raise RuntimeError(f"{command[0]}: {done.stderr.decode(errors='replace')}")
