"""A bench whose drive is a simulated device in a process of its own, and the programs that run it."""

import json
import multiprocessing
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import tomli_w

from bench.config.configuration import BenchConfiguration, parse_configuration
from bench.control.commissioned import KIND
from bench.control.drive_factory import make_equipment
from bench.provenance import provenance
from bench.store import Store
from tests.devices.device_process import DeviceProcess, device_process
from tests.drivers.conformance.benches import ANSWER_TIMEOUT_S, PERIOD_S, configured
from tests.experiments.calibrated import calibrated_configuration
from tests.service.plain_http import NOBODY
from tests.stopping.records import PATIENCE_S, FileRecords, Records, ServerRecords

TOKEN = "a-token-for-the-kill-tests"
WATCHDOG_S = 1.0  # a busy machine keeps a host waiting for longer than a lab's would
HARDWARE_PRIORITY = 20  # of the device, where that is permitted: real ones do not share a processor with the host
ROOT = Path(__file__).parents[2]
PARAMETERS = {"loads_kg": [0.05], "waveforms": ["multisine"], "duration_s": 600, "repeats": 1}
PAIR_PARAMETERS = {"load_kg": 0.05, "angles_rad": [0.2] * 10, "rest_s": 60, "reflect": ["none"]}
CLIENTS, ASKED_FOR = 40, ("trials?limit=1000", "experiments?limit=1000", "bench", "live/now")
OPTIONS = ["--loads-kg", "0.05", "--waveforms", "multisine", "--duration-s", "600", "--repeats", "1"]


@dataclass
class Bench:
    """A store, a device and its configuration in a folder.

    Attributes:
        folder: where all is kept.
        devices: behind the wire: the joint's; or the slave's, and the master's.
        configuration: of the bench.
        records: its store.
        output_file: what the program that runs has said.
    """

    folder: Path
    devices: tuple[DeviceProcess, ...]
    configuration: BenchConfiguration
    records: Records
    output_file: Path = field(default=Path("/dev/null"))
    _waiting: "tuple[subprocess.Popen[bytes], Path] | None" = field(default=None)
    _programs: int = field(default=0)

    @property
    def device(self) -> DeviceProcess:
        """That of the joint, or of the slave."""
        return self.devices[0]

    def wait_for_power(self, on: bool) -> float:
        """Wait until every motor has power, or none has; when that began, by `time.monotonic()` [s]."""
        return max(device.wait_for_power(on, PATIENCE_S) for device in self.devices)

    def repair(self) -> None:
        """Put right whatever a deed has broken."""
        for device in self.devices:
            device.side.ask("repair")

    @property
    def output(self) -> str:
        return self.output_file.read_text(errors="replace")

    def prepare(self) -> None:
        """Have the next program import what it needs, while this one runs."""
        if self._waiting is None:
            self._programs += 1
            file = self.folder / f"output {self._programs}"
            command = [sys.executable, "-m", "tests.stopping.raising", str(self.folder / "raise")]
            environment = os.environ | {"FRICTION_BENCH_TOKEN": TOKEN, "PYTHONPATH": str(ROOT)}
            with file.open("wb") as output:
                process = subprocess.Popen(
                    command, stdin=subprocess.PIPE, stdout=output, stderr=output, env=environment, cwd=self.folder
                )
            self._waiting = process, file

    def close(self) -> None:
        """End a program that nobody has given its words."""
        if self._waiting is not None:
            process, _ = self._waiting
            process.kill()
            process.communicate()

    @contextmanager
    def program(self, *words: str) -> "Iterator[subprocess.Popen[bytes]]":
        """A command of ours, ended at the end."""
        self.prepare()
        assert self._waiting is not None
        process, self.output_file = self._waiting
        self._waiting = None
        options = ["--config", str(self.folder / "bench.toml"), "--store", self.records.url]
        assert process.stdin is not None
        with process.stdin as told:
            told.write(json.dumps([*options, *words]).encode() + b"\n")
        try:
            yield process
        finally:
            process.terminate()
            process.wait(PATIENCE_S)

    def committed(self) -> int:
        """Rows of the newest trial, where it runs, as another process sees them."""
        found = self.records.newest("SELECT rows, outcome FROM trial ORDER BY id DESC LIMIT 1")
        return int(found[0]) if found and found[1] == "running" else 0

    def is_recorded_as_running(self) -> bool:
        """Whether the newest experiment is."""
        return bool(self.records.newest("SELECT outcome FROM experiment ORDER BY id DESC LIMIT 1") == ("running",))


@contextmanager
def kills_bench(
    folder: Path, joints: int = 1, lab_url: str | None = None, store_url: str | None = None
) -> Iterator[Bench]:
    """A bench whose drives have passed the commissioning move, as the store remembers it.

    Args:
        folder: for store and configuration.
        joints: 1, or 2 for a master and a slave.
        lab_url: database of the laboratory that its service hands in to; None: it is by itself.
        store_url: a database on a server for its own store, empty; None: a file.
    """
    with ExitStack() as stack:
        devices = [stack.enter_context(device_process("modbus", "--transport", "tcp")) for _ in range(joints)]
        for device in devices:
            _do_not_share(device)
        values = configured().model_dump(mode="json", exclude_none=True, exclude={"store"})
        values["drive"] = _section(devices[0])
        if joints == 2:
            told = calibrated_configuration().model_dump(mode="json", exclude_none=True, include={"friction", "rest"})
            master = {"drive": _section(devices[1]), "limits": values["limits"]}
            values |= {**told, "master": master}
        if lab_url is not None:
            values["store"] = {"lab_url": lab_url}
        (folder / "bench.toml").write_text(tomli_w.dumps(values))
        records: Records = FileRecords(folder / "bench.sqlite")
        if store_url is not None:
            Store.open(store_url).close()
            records = server = ServerRecords(store_url)
            stack.callback(server.close)
        found = Bench(folder, tuple(devices), parse_configuration(values, "bench.toml"), records)
        stack.callback(found.close)
        _commission(found)
        yield found


def _section(device: DeviceProcess) -> dict[str, Any]:
    return {**device.drive, "watchdog_s": WATCHDOG_S, "answer_timeout_s": ANSWER_TIMEOUT_S}


def _do_not_share(device: DeviceProcess) -> None:
    with suppress(PermissionError):
        for thread in Path(f"/proc/{device.process.pid}/task").iterdir():
            os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, os.sched_param(HARDWARE_PRIORITY))


def _commission(bench: Bench) -> None:
    benches = [bench.configuration] + ([bench.configuration.of_master()] if len(bench.devices) == 2 else [])
    with Store.open(bench.records.url) as store:
        for one in benches:
            opened = make_equipment(one).drive
            opened.open(PERIOD_S)
            try:
                identity = provenance(one, opened.describe())
            finally:
                opened.close()
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
        url = f"http://127.0.0.1:{self._port}/api/v1"
        return httpx.Client(base_url=url, headers=headers, timeout=PATIENCE_S, verify=NOBODY)

    def wait_until_up(self, bench: Bench) -> None:
        def answers() -> bool:
            try:
                return self.client.get("/token").status_code == 200
            except httpx.TransportError:
                return False

        wait_for(lambda: answers() or self.process.poll() is not None, bench)

    def start(self, bench: Bench) -> None:
        kind, parameters = ("teleoperation", PAIR_PARAMETERS) if len(bench.devices) == 2 else ("excitation", PARAMETERS)
        body = {"kind": kind, "parameters": parameters, "pace": "real-time"}
        answer = self.client.post("/experiments", json=body)
        if answer.status_code != 201:
            raise RuntimeError(f"the next start did not work: {answer.text}")
        if kind == "teleoperation":
            self._take_hold(bench)

    def _take_hold(self, bench: Bench) -> None:
        """Say that somebody holds the master, as soon as that is asked for."""
        wait_for(lambda: self.client.get("/bench").json()["prompt"], bench)
        prompt = self.client.get("/bench").json()["prompt"]
        self.client.post("/continue", json={"prompt": prompt["number"]}).raise_for_status()

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
        with httpx.Client(base_url=base_url, timeout=PATIENCE_S, verify=NOBODY) as client:
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
