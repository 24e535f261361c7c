"""`friction-bench serve` as its users have it: a process of its own, and the bench process that it starts."""

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx

from tests.service.plain_http import NOBODY
from tests.service.running_service import TOKEN

UP_WITHIN_S = 60.0


@contextmanager
def served_process(folder: Path, *options: str) -> Iterator[str]:
    """Its address; see `started_process`."""
    with started_process(folder, *options) as (_process, url):
        yield url


@contextmanager
def started_process(folder: Path, *options: str) -> "Iterator[tuple[subprocess.Popen[bytes], str]]":
    """Process and address; `TOKEN` may all. The store is `bench.sqlite` in the folder, and may be there already.

    Args:
        folder: where it runs.
        *options: before `serve`, such as "--config", "bench.toml".
    """
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    store = ["--store", str(folder / "bench.sqlite")]
    command = [sys.executable, "-m", "bench.cli", *store, *options, "serve", "--port", str(port)]
    environment = os.environ | {"FRICTION_BENCH_TOKEN": TOKEN, "PYTHONPATH": os.pathsep.join(sys.path)}
    process = subprocess.Popen(command, env=environment, cwd=folder, stdout=subprocess.DEVNULL)
    url = f"http://127.0.0.1:{port}"
    try:
        wait_until_up(url)
        yield process, url
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(UP_WITHIN_S)


def wait_until_up(url: str) -> None:
    """Until a service answers at its address; raises what the last attempt did after UP_WITHIN_S."""
    deadline_s = time.monotonic() + UP_WITHIN_S
    with httpx.Client(verify=NOBODY) as client:
        while True:
            try:
                client.get(f"{url}/api/v1/bench")
                return
            except httpx.TransportError:
                if time.monotonic() > deadline_s:
                    raise
                time.sleep(0.1)
