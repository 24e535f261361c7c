"""What serving costs the control loop: `python -m tests.service.rates`. Part of `make benchmark`, not a test.

    python -m tests.service.rates [--rounds 4] [--seconds 8]

One trial at 1 kHz on the simulated drive, again and again, in turn alone and beside 50 readers, an export and a
diagnosis that are asked for without a pause. Readers are in a process of their own, on the same machine. Printed:
cycles lost, and how late cycles began, of both, and p99 beside the readers over that of the stretches alone before and
after, so that a machine that drifts cancels.

The bound beside it, in the same run: a bare process that only waits for its deadlines with the loop's priority
(`bare_loop`), alone and beside the same readers, in turn with the trials. And during each stretch, a process on each
processor whose priority is above the loop's (`host_watch`): where even that one is held up, the host was, and the
cycles that are lost in the same moments are counted as the host's. Both counts are printed.
"""

import argparse
import asyncio
import multiprocessing
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from multiprocessing.synchronize import Event
from pathlib import Path
from typing import Any

import httpx
import tomli_w

from bench.config.configuration import default_configuration
from tests.service import bare_loop, timed_process
from tests.service.host_watch import watched
from tests.service.lateness import Measured, Stretch, report
from tests.service.recorded_joint import recording_set_zip
from tests.service.served_process import wait_until_up
from tests.service.timed_process import Cycles

TOKEN = "a-token-for-the-benchmark"
PERIOD_S = 0.001
STREAMS, ASKING = 30, ("/bench", "/trials?limit=100")  # 30 watch; 10 each ask for these
ASKED_EVERY_S = 0.5
ROOT = Path(__file__).parents[2]


async def _watch(port: int, served: Any) -> None:
    """Read the live stream, as a browser does."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(f"GET /api/v1/live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
    while data := await reader.read(65536):
        served.value += data.count(b"event: ")


async def _ask(client: httpx.AsyncClient, path: str, pause_s: float, served: Any) -> None:
    while True:
        with suppress(httpx.ReadError, httpx.RemoteProtocolError):  # a connection that was kept open was just closed
            (await client.get(path)).raise_for_status()
            served.value += 1
        await asyncio.sleep(pause_s)


async def _read_all(port: int, paths: list[str], served: Any, over: Event) -> None:
    headers = {"Authorization": f"Bearer {TOKEN}"}
    limits = httpx.Limits(max_connections=100)
    base = f"http://127.0.0.1:{port}/api/v1"
    async with httpx.AsyncClient(base_url=base, headers=headers, timeout=120, limits=limits) as client:
        work = [_watch(port, served) for _ in range(STREAMS)]
        work += [_ask(client, path, ASKED_EVERY_S, served) for path in ASKING for _ in range(10)]
        work += [_ask(client, path, 0.0, served) for path in paths]
        tasks = [asyncio.ensure_future(one) for one in work]
        while not over.is_set():
            await asyncio.sleep(0.05)
            for task in tasks:
                if task.done():
                    task.result()  # a reader that was refused shows nothing
        for task in tasks:
            task.cancel()


def _readers(port: int, paths: list[str], served: Any, over: Event) -> None:
    asyncio.run(_read_all(port, paths, served, over))


class Bench:
    """The service under test, and its client."""

    def __init__(self, port: int, folder: Path) -> None:
        headers = {"Authorization": f"Bearer {TOKEN}"}
        self._port, self._folder = port, folder
        self._client = httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1", headers=headers, timeout=120)
        self._long: list[str] = []

    def prepare(self, seconds: float) -> None:
        """What is exported, and what is diagnosed."""
        exported = self.trial(seconds)
        content, kind = recording_set_zip(), {"Content-Type": "application/zip"}
        imported = self._post("/recording-sets?name=known", content=content, headers=kind)["experiment_id"]
        study = self._post("/studies", json={"name": "known", "experiment_ids": [imported]})["study_id"]
        self._long = [f"/experiments/{exported}/recording-set", f"/studies/{study}/diagnose"]

    def trial(self, seconds: float) -> int:
        """Run it to its end."""
        parameters = {"loads_kg": [0.05], "waveforms": ["multisine"], "duration_s": seconds, "repeats": 1}
        body = {"kind": "excitation", "parameters": parameters, "pace": "real-time"}
        experiment_id = int(self._post("/experiments", json=body)["experiment_id"])
        while self._client.get("/bench").json()["state"] == "running":
            time.sleep(0.5)
        found = self._client.get(f"/experiments/{experiment_id}").json()
        if found["outcome"] != "completed":
            raise RuntimeError(f"the trial {found['outcome']}: {found['reason']}")
        self.scheduling = found["provenance"]["control_loop"]["scheduling"]
        return experiment_id

    def measured(self, seconds: float, what: Measured) -> Stretch:
        """A trial, or a bare process, alone or not."""
        served = multiprocessing.get_context("spawn").Value("q", 0)
        with self._serving(served) if what.beside else nullcontext():
            before = served.value
            with watched() as gaps:
                cycles = self._waiting(seconds) if what.waits else self._trial(seconds)
            return Stretch(cycles, gaps, served.value - before)

    def _trial(self, seconds: float) -> Cycles:
        self.trial(seconds)
        return timed_process.read(self._folder)[-1]

    def _waiting(self, seconds: float) -> Cycles:
        return bare_loop.run(self._folder / "bare", int(seconds / PERIOD_S), PERIOD_S)

    @contextmanager
    def _serving(self, served: Any) -> Iterator[None]:
        context = multiprocessing.get_context("spawn")
        over = context.Event()
        readers = context.Process(target=_readers, args=(self._port, self._long, served, over))
        readers.start()
        try:
            while served.value < STREAMS:
                time.sleep(0.1)
            yield
        finally:
            over.set()
            readers.join()
        if readers.exitcode:
            raise RuntimeError("the readers were not served; the run shows nothing")

    def _post(self, path: str, **content: Any) -> Any:
        answer = self._client.post(path, **content)
        if answer.is_error:
            raise RuntimeError(f"{path}: {answer.text}")
        return answer.json()


@contextmanager
def service(folder: Path) -> Iterator[Bench]:
    """`friction-bench serve` in a process of its own, whose control loop notes how late it is."""
    values = default_configuration().model_dump(mode="json", exclude_none=True, exclude={"store"})
    values["control"]["period_s"] = PERIOD_S
    (folder / "bench.toml").write_text(tomli_w.dumps(values))
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    options = ["--config", str(folder / "bench.toml"), "--store", str(folder / "bench.sqlite")]
    command = [sys.executable, "-m", "tests.service.timed_process", str(folder), *options, "serve", "--port", str(port)]
    environment = os.environ | {"FRICTION_BENCH_TOKEN": TOKEN}
    process = subprocess.Popen(command, env=environment, cwd=ROOT, stdout=subprocess.DEVNULL)
    try:
        wait_until_up(f"http://127.0.0.1:{port}")
        yield Bench(port, folder)
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(60)


def main() -> None:
    """Measure, in one run, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--seconds", type=float, default=8.0)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="friction-bench-rates-") as folder, service(Path(folder)) as bench:
        bench.prepare(arguments.seconds)
        found: dict[Measured, list[Stretch]] = {what: [] for what in Measured}
        order = [one for _ in range(arguments.rounds) for one in Measured] + [Measured.WAITING, Measured.ALONE]
        for number, what in enumerate(order, 1):
            stretch = bench.measured(arguments.seconds, what)
            found[what].append(stretch)
            print(f"{number}/{len(order)} {what.value}: {stretch.in_words(PERIOD_S)}", flush=True)
        print(f"control loop: a process of its own, {bench.scheduling}; {os.cpu_count()} cores")
    print("\n".join(report(found, PERIOD_S)))


if __name__ == "__main__":
    main()
