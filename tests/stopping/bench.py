"""A bench whose drive is a simulated device in a process of its own, and the programs that run it."""

import multiprocessing
import os
import sqlite3
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import tomli_w

from bench.config.configuration import BenchConfiguration
from bench.control.commissioned import KIND
from bench.control.drive_factory import make_equipment
from bench.provenance import provenance
from bench.store import Store
from tests.devices.device_process import DeviceProcess, device_process
from tests.drivers.conformance.benches import ANSWER_TIMEOUT_S, PERIOD_S, configured

TOKEN = "a-token-for-the-kill-tests"
WATCHDOG_S = 1.0  # a busy machine keeps a host waiting for longer than a lab's would
HARDWARE_PRIORITY = 20  # of the device, where that is permitted: real ones do not share a processor with the host
ROOT = Path(__file__).parents[2]
PATIENCE_S = 120.0
PARAMETERS = {"loads_kg": [0.05], "waveforms": ["multisine"], "duration_s": 600, "repeats": 1}
CLIENTS, ASKED_FOR = 40, ("trials?limit=1000", "experiments?limit=1000", "bench", "live/now")
OPTIONS = ["--loads-kg", "0.05", "--waveforms", "multisine", "--duration-s", "600", "--repeats", "1"]


@dataclass
class Bench:
    """A store, a device and its configuration in a folder.

    Attributes:
        folder: where all is kept.
        device: behind the wire.
        configuration: of the bench.
    """

    folder: Path
    device: DeviceProcess
    configuration: BenchConfiguration
    starts: int = field(default=0)

    @property
    def database(self) -> Path:
        return self.folder / "bench.sqlite"

    @property
    def output(self) -> str:
        return (self.folder / "output").read_text(errors="replace")

    @contextmanager
    def program(self, *words: str) -> "Iterator[subprocess.Popen[bytes]]":
        """A command of ours, ended at the end."""
        environment = os.environ | {"FRICTION_BENCH_TOKEN": TOKEN}
        options = ["--config", str(self.folder / "bench.toml"), "--store", str(self.database)]
        with (self.folder / "output").open("wb") as output:
            command = [sys.executable, "-m", "tests.stopping.raising", str(self.folder / "raise"), *options, *words]
            process = subprocess.Popen(command, stdout=output, stderr=output, env=environment, cwd=ROOT)
        try:
            yield process
        finally:
            process.terminate()
            process.wait(PATIENCE_S)

    def committed(self) -> int:
        """Rows of the newest trial, where it runs, as another process sees them."""
        found = self._newest("SELECT rows, outcome FROM trial ORDER BY id DESC LIMIT 1")
        return int(found[0]) if found and found[1] == "running" else 0

    def is_recorded_as_running(self) -> bool:
        """Whether the newest experiment is."""
        return self._newest("SELECT outcome FROM experiment ORDER BY id DESC LIMIT 1") == ("running",)

    def _newest(self, query: str) -> Any:
        with closing(sqlite3.connect(f"file:{self.database}?mode=ro", uri=True)) as connection:
            return connection.execute(query).fetchone()


@contextmanager
def kills_bench(folder: Path) -> Iterator[Bench]:
    """A bench whose drive has passed the commissioning move, as the store remembers it."""
    with device_process("modbus", "--transport", "tcp") as device:
        _do_not_share(device)
        configuration = configured(**device.drive, watchdog_s=WATCHDOG_S, answer_timeout_s=ANSWER_TIMEOUT_S)
        drive = configuration.drive.model_copy(update={"side_channel": device.drive["side_channel"]})
        configuration = configuration.model_copy(update={"drive": drive})
        values = configuration.model_dump(mode="json", exclude_none=True, exclude={"store"})
        (folder / "bench.toml").write_text(tomli_w.dumps(values))
        found = Bench(folder, device, configuration)
        _commission(found)
        yield found


def _do_not_share(device: DeviceProcess) -> None:
    with suppress(PermissionError):
        for thread in Path(f"/proc/{device.process.pid}/task").iterdir():
            os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, os.sched_param(HARDWARE_PRIORITY))


def _commission(bench: Bench) -> None:
    opened = make_equipment(bench.configuration).drive
    opened.open(PERIOD_S)
    try:
        identity = provenance(bench.configuration, opened.describe())
    finally:
        opened.close()
    with Store.open(f"sqlite:///{bench.database}") as store:
        store.finish_experiment(store.begin_experiment(KIND, {}, "simulated", identity, {}), "completed")


class Service:
    """`friction-bench serve` as a client sees it."""

    def __init__(self, process: "subprocess.Popen[bytes]", port: int) -> None:
        self.process = process
        self._port = port
        self.client = self.another_client()

    def another_client(self) -> httpx.Client:
        """One that has no connection yet."""
        headers = {"Authorization": f"Bearer {TOKEN}"}
        return httpx.Client(base_url=f"http://127.0.0.1:{self._port}/api/v1", headers=headers, timeout=PATIENCE_S)

    def wait_until_up(self, bench: Bench) -> None:
        def answers() -> bool:
            try:
                return self.client.get("/token").status_code == 200
            except httpx.TransportError:
                return False

        wait_for(lambda: answers() or self.process.poll() is not None, bench)

    def start(self) -> None:
        body = {"kind": "excitation", "parameters": PARAMETERS, "pace": "real-time"}
        answer = self.client.post("/experiments", json=body)
        if answer.status_code != 201:
            raise RuntimeError(f"the next start did not work: {answer.text}")

    def runs(self) -> bool:
        return bool(self.client.get("/bench").json()["state"] == "running")

    def bench_process(self) -> int:
        """Its process id: the service's only child."""
        tasks = Path(f"/proc/{self.process.pid}/task").glob("*/children")
        (child,) = [int(word) for task in tasks for word in task.read_text().split()]
        return child


@contextmanager
def busy(service: Service) -> Iterator[None]:
    """Forty clients that ask for whatever takes long, without a pause; in a process of their own, as clients are."""
    context = multiprocessing.get_context("spawn")
    over, answers = context.Event(), context.Value("q", 0)
    clients = context.Process(target=_ask, args=(str(service.client.base_url), over, answers))
    clients.start()
    deadline_s = time.monotonic() + PATIENCE_S
    try:
        while answers.value < len(ASKED_FOR) and time.monotonic() < deadline_s:
            time.sleep(0.01)
        yield
    finally:
        over.set()
        clients.join()


def _ask(base_url: str, over: Any, answers: Any) -> None:
    def ask(number: int) -> None:
        with httpx.Client(base_url=base_url, timeout=PATIENCE_S) as client:
            while not over.is_set():
                client.get(ASKED_FOR[number % len(ASKED_FOR)])
                with answers.get_lock():
                    answers.value += 1

    readers = [threading.Thread(target=ask, args=(number,)) for number in range(CLIENTS)]
    for reader in readers:
        reader.start()
    for reader in readers:
        reader.join()


def is_there(process_id: int) -> bool:
    """Whether a process runs; one that has ended and nobody has asked after does not."""
    try:
        return Path(f"/proc/{process_id}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def wait_for(condition: Callable[[], Any], bench: Bench, patience_s: float = PATIENCE_S) -> None:
    deadline_s = time.monotonic() + patience_s
    while not condition():
        if time.monotonic() > deadline_s:
            raise RuntimeError(f"waited {patience_s:g} s in vain; the program said: {bench.output}")
        time.sleep(0.01)
