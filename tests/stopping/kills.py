"""Ends runs at random moments, in every way a run can end, and looks at what is left: `python -m tests.stopping.kills`.

    python -m tests.stopping.kills --kills 200 --seed 1

Each run is a process of its own, on the simulated drive in real time. All runs of one call share one store: that the
next run starts is part of what is tested. After each: the file is sound, every row that was seen committed is there,
the rows have no gap, how much was lost, and what the record says.
"""

import argparse
import os
import re
import resource
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import httpx
import numpy as np

from bench.store import Store
from bench.store.records import Trial
from tests.stopping import witnessed

ALLOWED_LOSS_S = 0.2
TOKEN = "a-token-for-the-kill-tests"
PARAMETERS = {"loads_kg": [0.1], "waveforms": ["multisine"], "duration_s": 600, "repeats": 1}
RUN = ["run", "excitation", "--loads-kg", "0.1", "--waveforms", "multisine", "--duration-s", "600", "--repeats", "1"]
PATIENCE_S = 120.0
LONGEST_S = 1.0  # of a run after its first rows


@dataclass
class Bench:
    """A store in a folder, and the witness of the run under way."""

    folder: Path

    @property
    def database(self) -> Path:
        return self.folder / "bench.sqlite"

    @property
    def witness(self) -> Path:
        return self.folder / "witness"

    @contextmanager
    def process(self, arguments: list[str], raise_after_s: float | None = None) -> Iterator["subprocess.Popen[bytes]"]:
        witnessed.prepare(self.witness)
        extra = [] if raise_after_s is None else ["--raise-after", str(raise_after_s)]
        words = [sys.executable, "-m", "tests.stopping.witnessed", str(self.witness), *extra]
        environment = os.environ | {"FRICTION_BENCH_TOKEN": TOKEN}
        with (self.folder / "output").open("wb") as output:
            process = subprocess.Popen(
                [*words, "--store", str(self.database), *arguments],
                stdout=output, stderr=output, env=environment, cwd=Path(__file__).parents[2],
            )  # fmt: skip
        try:
            yield process
        finally:
            process.kill()
            process.wait()

    def committed(self) -> int:
        """Rows of the newest trial, seen from another process."""
        if not self.database.exists():
            return 0
        with closing(sqlite3.connect(f"file:{self.database}?mode=ro", uri=True)) as connection:
            try:
                found = connection.execute("SELECT rows, outcome FROM trial ORDER BY id DESC LIMIT 1").fetchone()
            except sqlite3.OperationalError:  # the tables are being made
                return 0
        return found[0] if found and found[1] == "running" else 0


@dataclass(frozen=True)
class Ending:
    """What is left of a run.

    Attributes:
        outcome, reason: of the record.
        seen: rows that were committed before the end, as somebody else saw them.
        rows: rows of the record.
        lost_s: samples that the drive gave and the record lacks [s].
        powered: whether the drive had power when the process was gone.
        problems: whatever must never be.
    """

    way: str
    outcome: str
    reason: str
    seen: int
    rows: int
    lost_s: float
    powered: bool
    problems: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Way:
    """A way to end a run.

    Attributes:
        end: called with the process and its bench at a random moment.
        outcome, reason: what the record has to say; the reason as a pattern.
        graceful: the process ends by itself: it loses nothing, and takes the power away.
        over_rest: whether the run is started over REST, in the process of the service.
    """

    name: str
    end: Callable[["subprocess.Popen[bytes]", Bench], None]
    outcome: str
    reason: str
    graceful: bool = True
    over_rest: bool = False
    raises: bool = False


def signals(*numbers: signal.Signals) -> Callable[["subprocess.Popen[bytes]", Bench], None]:
    def send(process: "subprocess.Popen[bytes]", bench: Bench) -> None:
        for number in numbers:
            process.send_signal(number)

    return send


def fill_the_disk(process: "subprocess.Popen[bytes]", bench: Bench) -> None:
    """No file of the process may grow: what a full disk is to it."""
    sizes = [file.stat().st_size for file in bench.folder.glob("bench.sqlite*")]
    resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (max(sizes), resource.RLIM_INFINITY))


def do_nothing(process: "subprocess.Popen[bytes]", bench: Bench) -> None:
    """It ends by itself."""


def lock_for_a_moment(process: "subprocess.Popen[bytes]", bench: Bench) -> None:
    """Another program writes for a second: the rows wait, and none is lost."""
    with closing(sqlite3.connect(bench.database, isolation_level=None, timeout=PATIENCE_S)) as other:
        other.execute("BEGIN IMMEDIATE")
        time.sleep(1.0)
        other.execute("ROLLBACK")
    process.send_signal(signal.SIGTERM)


def lock_until_the_end(process: "subprocess.Popen[bytes]", bench: Bench) -> None:
    """Another program never lets go while the run lasts: the run ends, and its end is written later."""
    with closing(sqlite3.connect(bench.database, isolation_level=None, timeout=PATIENCE_S)) as other:
        other.execute("BEGIN IMMEDIATE")
        process.wait(PATIENCE_S)
        other.execute("ROLLBACK")


KILLED = "killed, crashed, or the power went"
WAYS = (
    Way("kill -9 of the run", signals(signal.SIGKILL), "interrupted", KILLED, graceful=False),
    Way("kill -9 of the service", signals(signal.SIGKILL), "interrupted", KILLED, graceful=False, over_rest=True),
    Way("Ctrl-C", signals(signal.SIGINT), "stopped", "Ctrl-C at the terminal"),
    Way("Ctrl-C twice", signals(signal.SIGINT, signal.SIGINT), "stopped", "Ctrl-C at the terminal"),
    Way("SIGTERM", signals(signal.SIGTERM), "stopped", "SIGTERM at the terminal"),
    Way("SIGTERM to the service", signals(signal.SIGTERM), "stopped", "the service was ended", over_rest=True),
    Way("disk full", fill_the_disk, "failed", "disk|full"),
    Way("exception in the trial", do_nothing, "failed", "the witness has seen enough", raises=True),
    Way("locked for a second", lock_for_a_moment, "stopped", "SIGTERM at the terminal"),
    Way("locked until the end", lock_until_the_end, "failed", "locked|does not keep up"),
)
# graceful, but what comes after the disk is full, or the database locked for good, cannot be kept
LOSES = ("disk full", "locked until the end")


def end_one(bench: Bench, way: Way, generator: np.random.Generator) -> Ending:
    """Start a run, end it at a random moment, and look at what is left."""
    moment_s = float(generator.uniform(0.0, LONGEST_S))
    port = free_port()
    arguments = ["serve", "--port", str(port)] if way.over_rest else [*RUN, "--pace", "real-time"]
    with bench.process(arguments, raise_after_s=0.3 + moment_s if way.raises else None) as process:
        if way.over_rest:
            start_over_rest(port)
        wait_for(lambda: bench.committed() > 0 or process.poll() is not None, bench)
        time.sleep(moment_s)
        seen = bench.committed()
        way.end(process, bench)
        process.wait(PATIENCE_S)
    return look(bench, way, seen)


def look(bench: Bench, way: Way, seen: int) -> Ending:
    """What is left, and everything about it that must not be."""
    with closing(sqlite3.connect(bench.database)) as connection:
        sound = connection.execute("PRAGMA integrity_check").fetchone()[0]
    witnessed_s, powered = witnessed.read(bench.witness)
    with Store.open(f"sqlite:///{bench.database}") as store:
        (experiment,) = store.experiments(limit=1)
        trial = store.trials(experiment.id)[-1]
        time_s = store.samples(trial.id, ["time_s"])["time_s"]
    lost_s = witnessed_s - (float(time_s[-1]) if len(time_s) else 0.0)
    problems = [] if sound == "ok" else [f"integrity_check says {sound}"]
    problems += list(wrong_in_record(way, trial, time_s, seen))
    if way.graceful and powered:
        problems.append("the drive was left with power")
    period_s = float(np.median(np.diff(time_s))) if len(time_s) > 1 else 0.0
    allowed_s = ALLOWED_LOSS_S if not way.graceful else 1.5 * period_s
    if way.name not in LOSES and lost_s > allowed_s + 1e-9:
        problems.append(f"{lost_s:.3f} s of samples are lost")
    return Ending(way.name, trial.outcome, trial.reason, seen, trial.rows, lost_s, powered, problems)


def wrong_in_record(way: Way, trial: Trial, time_s: np.ndarray, seen: int) -> Iterator[str]:
    if (trial.outcome, bool(re.search(way.reason, trial.reason))) != (way.outcome, True):
        yield f"the record says {trial.outcome}: {trial.reason}"
    if trial.rows != len(time_s) or trial.rows < seen:
        yield f"{seen} rows were seen committed; {trial.rows} are counted, {len(time_s)} are there"
    steps = np.diff(time_s)
    if len(steps) and (steps.min() <= 0.0 or steps.max() > 1.5 * np.median(steps)):
        yield f"the rows have a gap: {steps.min():g} .. {steps.max():g} s"


def start_over_rest(port: int) -> None:
    url, headers = f"http://127.0.0.1:{port}/api/v1", {"Authorization": f"Bearer {TOKEN}"}
    deadline_s = time.monotonic() + PATIENCE_S
    body = {"kind": "excitation", "parameters": PARAMETERS, "pace": "real-time"}
    while True:
        try:
            answer = httpx.post(f"{url}/experiments", json=body, headers=headers, timeout=PATIENCE_S)
            break
        except httpx.ConnectError:
            if time.monotonic() > deadline_s:
                raise
            time.sleep(0.05)
    if answer.status_code != 201:
        raise RuntimeError(f"the next start did not work: {answer.text}")


def wait_for(condition: Callable[[], bool], bench: Bench) -> None:
    deadline_s = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > deadline_s:
            raise RuntimeError(f"nothing was recorded in {PATIENCE_S:g} s: {(bench.folder / 'output').read_text()}")
        time.sleep(0.01)


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return int(probe.getsockname()[1])


def main() -> None:
    """Kill, and print what was left."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    generator = np.random.default_rng(arguments.seed)
    endings = []
    with tempfile.TemporaryDirectory(prefix="friction-bench-kills-") as folder:
        bench = Bench(Path(folder))
        for number in range(arguments.kills):
            ending = end_one(bench, WAYS[number % len(WAYS)], generator)
            endings.append(ending)
            for problem in ending.problems:
                print(f"run {number + 1}, {ending.way}: {problem}", flush=True)  # noqa: T201
    print(f"{'way':24} | runs | wrong | samples lost [s]: median, largest (allowed)")  # noqa: T201
    for way in WAYS:
        found = [ending for ending in endings if ending.way == way.name]
        if found:
            lost = [ending.lost_s for ending in found]
            allowed = "-" if way.name in LOSES else f"{ALLOWED_LOSS_S:g}" if not way.graceful else "one period"
            wrong = sum(bool(ending.problems) for ending in found)
            print(f"{way.name:24} | {len(found):4} | {wrong:5} | {np.median(lost):.3f}, {max(lost):.3f} ({allowed})")  # noqa: T201
    sys.exit(any(ending.problems for ending in endings))


if __name__ == "__main__":
    main()
