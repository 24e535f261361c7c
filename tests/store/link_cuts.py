"""Two benches record, and hand in over links that are cut: `python -m tests.store.link_cuts --cuts 50`.

Each bench has a store of its own and a link of its own to one PostgreSQL server; its experiments begin, end and are
handed in by the same code as in the service. The links are cut at random moments, while blocks and ends are under way.
At the end each row of each bench is looked for in the laboratory: lost is what is not there, doubled what is there
more than once.
"""

import argparse
import logging
import sys
import tempfile
import threading
import time
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from bench.runs.lab_link import LabLink
from bench.store import Store
from bench.store.tables.benches import BenchWord
from tests.databases import PostgresqlServer, postgresql_server
from tests.store.link import Link
from tests.store.rates import CHANNELS

BENCHES = ("bench 1", "bench 2")
PERIOD_S = 0.02
LONGEST_S = 0.25  # between two cuts, and of a cut
BLOCKS, BLOCK_ROWS = 12, 1000
PATIENCE_S = 120.0


class RecordingBench:
    """A bench that records one experiment after the other.

    Args:
        name: of the bench.
        folder: for its store.
        lab_url: database of the laboratory, on a server's socket.
    """

    def __init__(self, name: str, folder: Path, lab_url: str) -> None:
        self.name = name
        self.link = Link(lab_url)
        self.store = Store.open(f"sqlite:///{folder / name}.sqlite")
        self.lab_link = LabLink(self.store, self.link.url, self._word, PERIOD_S)
        self._generator = np.random.default_rng(len(name) + ord(name[-1]))
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._record, name=name)

    def start(self) -> None:
        self._thread.start()
        self.lab_link.start()

    def stop_recording(self) -> None:
        self._over.set()
        self._thread.join()

    def close(self) -> None:
        self.stop_recording()
        self.lab_link.close()
        self.link.close()
        self.store.close()

    def _word(self, waiting: int) -> BenchWord:
        return BenchWord(self.name, "here", "running", waiting=waiting)

    def _record(self) -> None:
        while not self._over.is_set():
            provenance = {"configuration": {"name": self.name}}
            experiment = self.store.begin_experiment("steps", {}, "simulated", provenance, {"name": "paper"})
            for number in range(2):
                conditions = {"load_kg": 0.1 * number, "repeat": 1}
                writer = self.store.begin_trial(experiment, f"trial {number}", "steps", conditions, CHANNELS)
                for _ in range(BLOCKS):
                    rows = self._generator.normal(size=(BLOCK_ROWS, len(CHANNELS)))
                    writer.append(rows, [(0.5, "breakaway", "up")])
                    self._over.wait(0.005)
                writer.finish("completed")
            self.store.finish_experiment(experiment, "completed")


def main() -> None:
    """Cut, and print what is lost and doubled."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cuts", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    logging.getLogger("sqlalchemy").setLevel(logging.CRITICAL)  # each cut would be shown with its whole trace
    with tempfile.TemporaryDirectory(prefix="friction-bench-cuts-") as folder, postgresql_server() as server:
        lost, doubled, told = cut_often(Path(folder), server, arguments.cuts, arguments.seed)
    print(f"{arguments.cuts} cuts, {told}: rows lost {lost}, doubled {doubled}")
    sys.exit(bool(lost or doubled))


def cut_often(folder: Path, server: PostgresqlServer, cuts: int, seed: int) -> tuple[int, int, str]:
    """Rows lost, rows doubled, and how much there was."""
    generator = np.random.default_rng(seed)
    url = server.url(server.create())
    Store.open(url).close()
    with ExitStack() as stack:
        benches = [RecordingBench(name, folder, url) for name in BENCHES]
        for one in benches:
            stack.callback(one.close)
            one.start()
        for number in range(cuts):
            time.sleep(generator.uniform(0.0, LONGEST_S))
            cut = benches[number % 2]
            cut.link.cut()
            time.sleep(generator.uniform(0.0, LONGEST_S))
            cut.link.mend()
        for one in benches:
            one.stop_recording()
        lab = stack.enter_context(Store.open(url))
        wait_until_in(benches, lab)
        time.sleep(5 * PERIOD_S)  # whoever hands in twice does it now
        found = [compared(one.store, lab, one.name) for one in benches]
        rows = sum(trial.rows for trial in lab.trials())
        told = f"{len(benches)} benches, {len(lab.experiments())} experiments, {rows} rows"
    return sum(lost for lost, _ in found), sum(doubled for _, doubled in found), told


def wait_until_in(benches: list[RecordingBench], lab: Store) -> None:
    """Until the laboratory says that it has all of each; asked anew each time."""
    end_s = time.monotonic() + PATIENCE_S
    while any(one.store.hand_in_to(lab, one.name).waiting() for one in benches):
        if time.monotonic() > end_s:
            raise TimeoutError(f"not everything was handed in within {PATIENCE_S:g} s of the last cut")
        time.sleep(0.05)


def compared(bench: Store, lab: Store, name: str) -> tuple[int, int]:
    """Rows of a bench that are lost in the laboratory, and those that are there more than once."""
    own = Counter(_rows(bench, [trial.id for trial in bench.trials()]))
    mine = [one.id for one in lab.experiments() if one.provenance.get("configuration", {}).get("name") == name]
    there = Counter(_rows(lab, [trial.id for experiment in mine for trial in lab.trials(experiment)]))
    return (own - there).total(), (there - own).total()


def _rows(store: Store, trial_ids: list[int]) -> list[int]:
    """A number for each row, by all bits of it."""
    numbers = []
    for trial_id in trial_ids:
        columns = np.column_stack(list(store.samples(trial_id).values())).view(np.uint64)
        weights = np.random.default_rng(0).integers(1, 2**63, columns.shape[1], dtype=np.uint64) | np.uint64(1)
        numbers += (columns * weights).sum(axis=1, dtype=np.uint64).tolist()
    return numbers


if __name__ == "__main__":
    main()
