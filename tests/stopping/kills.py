"""Ends runs at random moments, in every way a run can end, and looks at what is left: `python -m tests.stopping.kills`.

    python -m tests.stopping.kills --kills 200 --seed 1 [--way "disk full"] [--joints 2] [--lab] [--server]

The drive is a simulated device in a process of its own, over Modbus TCP; when the motor was off is what the device
says. All runs share one store and one drive: that the next run starts is part of what is tested. After each: the
database is sound, every row that was seen committed is there, the rows have no gap, how much was lost, and what the
record says. A line for each run as it ends, and a table at the end, also after Ctrl-C.

With --lab the service hands in to a PostgreSQL server, whose link is cut and which is killed at random moments all the
while. No run may end otherwise for it, and at the end the laboratory has every row of the bench, once.

With --server every fourth round of all ways is that of a bench whose own store is on a PostgreSQL server.
"""

import argparse
import re
import signal
import socket
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from itertools import count, islice
from pathlib import Path

import httpx
import numpy as np

from bench.store import Store
from bench.store.records import Trial
from tests.databases import postgresql_server
from tests.drivers.conformance.benches import PERIOD_S
from tests.stopping.bench import OPTIONS, Bench, Service, is_there, kills_bench, wait_for
from tests.stopping.laboratory import laboratory
from tests.stopping.ways import WAYS, Scene, Way

ALLOWED_LOSS_S = 0.2
LONGEST_S = 1.0  # of a run after its first rows
SERVER_EVERY = 4  # rounds of all ways: one of so many is on a server's store


@dataclass(frozen=True)
class Ending:
    """What is left of a run.

    Attributes:
        off_s: how long after the deed the motor was off, by the device [s].
        lost_s: samples that the record lacks, up to the deed or, where nothing has to be lost, the power-off [s].
        problems: whatever must never be.
    """

    way: Way
    off_s: float
    lost_s: float
    rows: int
    problems: list[str] = field(default_factory=list)

    def in_words(self) -> str:
        """One line."""
        found = "; ".join(self.problems) or "as stated"
        off = f"off after {self.off_s:.3f} of {self.way.off_s:.3f} s"
        return f"{self.way.name:28} | {off} | lost {self.lost_s:.3f} of {ALLOWED_LOSS_S:.3f} s | {found}"


class Killer:
    """Starts, kills and looks, again and again; a service that survives is used again.

    Args:
        bench: store and drive.
        seed: of the moments.

    Attributes:
        bench: as given.
    """

    def __init__(self, bench: Bench, seed: int) -> None:
        self.bench = bench
        self._generator = np.random.default_rng(seed)
        self._programs = ExitStack()
        self._scene: Scene | None = None

    def end_one(self, way: Way) -> Ending:
        """Start a run, end it at a random moment, and look at what is left."""
        scene = self._started(way)
        on_s = self.bench.wait_for_power(True)
        if not way.survives:
            self.bench.prepare()
        wait_for(lambda: self.bench.committed() > 0 or scene.process.poll() is not None, self.bench)
        time.sleep(float(self._generator.uniform(0.0, LONGEST_S)))
        seen = self.bench.committed()
        loop = scene.loop_process()
        deed_s = way.deed(scene)
        wait_for(lambda: self._has_ended(scene), self.bench)
        off_s = self.bench.wait_for_power(False)
        self.bench.repair()
        if not way.survives:
            self.leave()
            wait_for(lambda: not is_there(loop), self.bench)  # nobody is left behind
        else:
            wait_for(lambda: not self.bench.is_recorded_as_running(), self.bench)
        return look(self.bench, way, seen, Times(on_s, deed_s, off_s))

    def leave(self) -> None:
        """End what still runs."""
        if self._scene is not None and self._scene.service is not None:
            self._scene.service.client.close()
        self._programs.close()
        self._scene = None

    def _started(self, way: Way) -> Scene:
        if way.served and self._scene is not None and self._scene.service is not None:
            self._scene.service.start(self.bench)
            return self._scene
        self.leave()
        words = ["serve", "--port", str(port := free_port())] if way.served else ["run", "excitation", *OPTIONS]
        process = self._programs.enter_context(self.bench.program(*words))
        service = Service(process, port) if way.served else None
        if service is not None:
            service.wait_until_up(self.bench)
            service.start(self.bench)
        self._scene = Scene(self.bench, process, service)
        return self._scene

    def _has_ended(self, scene: Scene) -> bool:
        """Whether the run has, or the program that it was part of."""
        if scene.process.poll() is not None:
            return True
        try:
            return scene.service is not None and not scene.service.runs()
        except (httpx.TransportError, ValueError):  # the service is just ending; what it was answering may be cut short
            return False


@dataclass(frozen=True)
class Times:
    """By `time.monotonic()` [s]: when the motor got power, the deed, and when it had none."""

    on_s: float
    deed_s: float
    off_s: float


def look(bench: Bench, way: Way, seen: int, times: Times) -> Ending:
    """What is left, and everything about it that must not be."""
    problems = bench.records.problems()
    with Store.open(bench.records.url) as store:
        (experiment,) = store.experiments(limit=1)
        trial = store.trials(experiment.id)[-1]
        # of a pair, the master gets its power last: the run is ended while both have it
        enabled = "master_enabled" if len(bench.devices) == 2 else "enabled"
        samples = store.samples(trial.id, ["time_s", enabled])
    off_s, lost_s = times.off_s - times.deed_s, _lost_s(way, samples["time_s"], samples[enabled], times)
    problems += list(_wrong_in_record(way, trial, samples["time_s"], seen))
    if off_s > way.off_s:
        problems.append(f"the motor was off after {off_s:.3f} s; stated are {way.off_s:.3f} s")
    if lost_s > ALLOWED_LOSS_S:
        problems.append(f"{lost_s:.3f} s of samples are lost; allowed are {ALLOWED_LOSS_S} s")
    return Ending(way, off_s, lost_s, trial.rows, problems)


def _lost_s(way: Way, time_s: np.ndarray, enabled: np.ndarray, times: Times) -> float:
    """Samples that the record lacks [s]. Its first row with power is from the moment when the device had power."""
    if not enabled.any():
        return max(times.deed_s - times.on_s, 0.0)
    last_s = times.on_s + time_s[-1] - time_s[np.flatnonzero(enabled)[0]]
    until_s = times.off_s if way.keeps_all else times.deed_s
    return max(float(until_s - last_s), 0.0)  # a joint that brakes without power is recorded, too


def _wrong_in_record(way: Way, trial: Trial, time_s: np.ndarray, seen: int) -> Iterator[str]:
    if (trial.outcome, bool(re.search(way.reason, trial.reason))) != (way.outcome, True):
        yield f"the record says {trial.outcome}: {trial.reason}"
    if trial.rows != len(time_s) or trial.rows < seen:
        yield f"{seen} rows were seen committed; {trial.rows} are counted, {len(time_s)} are there"
    if trial.results.get("overruns") == 0 and len(time_s) > 1 and np.diff(time_s).max() > 3.0 * PERIOD_S:
        yield f"the rows have a gap of {np.diff(time_s).max():.3f} s"
    if len(time_s) > 1 and np.diff(time_s).min() <= 0.0:
        row = int(np.diff(time_s).argmin())
        yield f"the rows are not in order: {time_s[row + 1]:.6f} s comes after {time_s[row]:.6f} s"


def plan(ways: list[Way], on_server: bool) -> Iterator[tuple[Way, bool]]:
    """Ways without end, and whether the store is on a server.

    Args:
        ways: each in turn.
        on_server: whether some rounds of them are.
    """
    for turn in count():
        there = on_server and turn % SERVER_EVERY == 1
        yield from ((way, there) for way in ways if not (there and way.of_file))


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return int(probe.getsockname()[1])


def table(endings: list[Ending]) -> Iterator[str]:
    """One line per way."""
    yield f"{'way':28} |  n | motor off: worst, stated [s] | samples lost: worst, allowed [s] | failures"
    for way in WAYS:
        found = [ending for ending in endings if ending.way is way]
        if found:
            off_s, lost_s = (max(getattr(one, name) for one in found) for name in ("off_s", "lost_s"))
            failures = sum(bool(one.problems) for one in found)
            yield (
                f"{way.name:28} | {len(found):2} | {off_s:16.3f}, {way.off_s:9.3f} "
                f"| {lost_s:20.3f}, {ALLOWED_LOSS_S:9.3f} | {failures:8}"
            )


@contextmanager
def killer_of(
    arguments: argparse.Namespace, lab_url: str | None = None, store_url: str | None = None
) -> Iterator[Killer]:
    """One with a bench of its own."""
    with (
        tempfile.TemporaryDirectory(prefix="friction-bench-kills-") as folder,
        kills_bench(Path(folder), arguments.joints, lab_url, store_url) as bench,
    ):
        yield Killer(bench, arguments.seed)


def main() -> None:
    """Kill, and print what was left."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    names = [way.name for way in WAYS]
    parser.add_argument("--way", action="append", choices=names, metavar="WAY", help="only this one; repeatable")
    parser.add_argument("--joints", type=int, choices=(1, 2), default=1, help="2: a master and a slave, served")
    parser.add_argument("--lab", action="store_true", help="hand in to a PostgreSQL server that is cut off and killed")
    parser.add_argument("--server", action="store_true", help="every fourth round with a store on a PostgreSQL server")
    arguments = parser.parse_args()
    for number in (signal.SIGINT, signal.SIGTERM):  # a shell has what it starts in the background ignore the first
        signal.signal(number, signal.default_int_handler)
    ways = [way for way in WAYS if not arguments.way or way.name in arguments.way]
    ways = [way for way in ways if way.served or arguments.joints == 1]
    endings, astray = [], 0
    with ExitStack() as stack:
        lab = stack.enter_context(laboratory(arguments.seed)) if arguments.lab else None
        killers = {False: stack.enter_context(killer_of(arguments, lab_url=lab.link.url if lab else None))}
        if arguments.server:
            server = stack.enter_context(postgresql_server())
            killers[True] = stack.enter_context(killer_of(arguments, store_url=server.url(server.create())))
        try:
            for way, there in islice(plan(ways, arguments.server), arguments.kills):
                for other, killer in killers.items():
                    if other != there:
                        killer.leave()
                ending = killers[there].end_one(way)
                endings.append(ending)
                where = "server" if there else "file"
                print(f"{len(endings):4}/{arguments.kills} {where:6} {ending.in_words()}", flush=True)
        except KeyboardInterrupt:
            print(f"interrupted after {len(endings)} of {arguments.kills}")
        finally:
            print("\n".join(table(endings)), flush=True)
            for killer in killers.values():
                killer.leave()
        if lab is not None:
            bench = killers[False].bench
            lost, doubled, told = lab.held_against(bench.records.url, bench.configuration.name)
            print(f"{told}: rows lost {lost}, doubled {doubled}", flush=True)
            astray = lost + doubled
    sys.exit(len(endings) < arguments.kills or any(ending.problems for ending in endings) or astray > 0)


if __name__ == "__main__":
    main()
