"""A laboratory that a bench hands in to, on a PostgreSQL server that is cut off and killed at random moments."""

import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import numpy as np

from bench.store import Store
from tests.databases import PostgresqlServer, postgresql_server
from tests.store.link import Link
from tests.store.link_cuts import compared

BETWEEN_S, CUT_S, DOWN_S = 3.0, 1.0, 1.0  # at most
KILLED = 0.2  # share of the disturbances that are a killed server, not a cut link


class Laboratory:
    """Server, link and what is done to them.

    Args:
        server: that runs.
        seed: of the moments.

    Attributes:
        link: through which the bench reaches its database.
    """

    def __init__(self, server: PostgresqlServer, seed: int) -> None:
        self._server, self._url = server, server.url(server.create())
        Store.open(self._url).close()
        self.link = Link(self._url)
        self._cuts = self._crashes = 0
        self._random = np.random.default_rng(seed)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._disturb, name="disturbances", daemon=True)
        self._thread.start()

    def held_against(self, url: str, name: str) -> tuple[int, int, str]:
        """Rows lost, rows doubled, and what was done; the bench first hands in what is left."""
        self.end()
        with Store.open(url) as own, Store.open(self._url) as lab:
            hand = own.hand_in_to(lab, name)
            left = hand.waiting()
            for experiment_id in left:
                hand.hand_in(experiment_id)
            lost, doubled = compared(own, lab, name)
            rows = sum(trial.rows for trial in lab.trials())
            there = len(lab.experiments())
        told = f"link cut {self._cuts} times, server killed {self._crashes} times, {len(left)} of {there} experiments"
        return lost, doubled, f"{told} handed in at the end, {rows} rows"

    def end(self) -> None:
        """Disturb no more."""
        self._over.set()
        self._thread.join()
        self.link.mend()

    def _disturb(self) -> None:
        while not self._over.wait(float(self._random.uniform(0.0, BETWEEN_S))):
            if self._random.random() < KILLED:
                self._server.crash(float(self._random.uniform(0.0, DOWN_S)))
                self._crashes += 1
            else:
                self.link.cut()
                self._over.wait(float(self._random.uniform(0.0, CUT_S)))
                self.link.mend()
                self._cuts += 1


@contextmanager
def laboratory(seed: int) -> Iterator[Laboratory]:
    """A server of its own, gone afterwards."""
    with ExitStack() as stack:
        found = Laboratory(stack.enter_context(postgresql_server()), seed)
        stack.callback(found.link.close)
        stack.callback(found.end)
        yield found
