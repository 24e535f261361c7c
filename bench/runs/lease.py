"""Who has the bench: a lease that ends by itself unless its holder renews it."""

import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from bench.errors import BenchError, BusyError

DEFAULT_S = 60.0
SHORTEST_S, LONGEST_S = 5.0, 3600.0


class LeaseHeldError(BenchError, RuntimeError):
    """Raised when somebody else has the bench.

    Attributes:
        remaining_s: how long it lasts unless it is renewed; None: as long as the experiment that runs.
    """

    def __init__(self, message: str, remaining_s: float | None) -> None:
        super().__init__(message)
        self.remaining_s = remaining_s


class NoLeaseError(BenchError, RuntimeError):
    """Raised when a lease is renewed or given back that is held no more."""


@dataclass(frozen=True, slots=True)
class Held:
    """The lease as it is now.

    Attributes:
        holder: how the holder wants to be called; else the token's name.
        remaining_s: unless it is renewed; None: it lasts as long as the experiment that runs.
    """

    token: str
    holder: str
    remaining_s: float | None

    def in_words(self) -> str:
        """The holder, and the time left."""
        who = self.holder if self.holder == self.token else f"{self.holder} (token '{self.token}')"
        if self.remaining_s is None:
            return f"{who} until the experiment that runs has ended"
        return f"{who} for another {math.ceil(self.remaining_s)} s"


@dataclass(frozen=True, slots=True)
class _Grant:
    token: str
    holder: str
    until_s: float | None
    run: int | None = None  # of a lease without `until_s`: the experiment; None while it starts


class Lease:
    """The one lease of a bench. Any thread may call; nothing here waits. STOP never asks it.

    Args:
        run: the experiment that runs now, None where none does; a lease that a start took by itself lasts as long.
        now_s: a clock that never goes back [s].
        engaged: why nothing may start whoever has it, "" where it may: a commissioning is under way between motions.
    """

    def __init__(
        self,
        run: Callable[[], int | None],
        now_s: Callable[[], float] = time.monotonic,
        engaged: Callable[[], str] = lambda: "",
    ) -> None:
        self._run = run
        self._now_s = now_s
        self._engaged = engaged
        self._lock = threading.Lock()
        self._grant: _Grant | None = None

    def current(self) -> Held | None:
        """Who has it; None where it is free."""
        with self._lock:
            return self._current()

    def take(self, token: str, holder: str, duration_s: float, take_over: bool = False) -> Held:
        """Take it, or renew it where it is one's own.

        Args:
            token: name of the token.
            holder: name to be shown; "": the token's.
            duration_s: how long, unless it is renewed [s].
            take_over: take it from whoever has it.

        Raises:
            LeaseHeldError: somebody else has it.
        """
        with self._lock:
            if not take_over:
                self._require(token)
            self._grant = _Grant(token, holder or token, self._now_s() + duration_s)
            return Held(token, holder or token, duration_s)

    def renew(self, token: str, duration_s: float) -> Held:
        """The heartbeat.

        Raises:
            LeaseHeldError: somebody else has it.
            NoLeaseError: it has run out, or was never taken.
        """
        with self._lock:
            self._require(token)
            mine = self._current()
            if mine is None:
                raise NoLeaseError("the lease has run out, or was never taken; take it with POST /lease")
            self._grant = _Grant(token, mine.holder, self._now_s() + duration_s)
            return Held(token, mine.holder, duration_s)

    def release(self, token: str) -> None:
        """Give it back. An experiment that runs goes on.

        Raises:
            LeaseHeldError: somebody else has it.
        """
        with self._lock:
            self._require(token)
            self._grant = None

    def require(self, token: str) -> None:
        """Pass where nobody else has it.

        Raises:
            LeaseHeldError: names the holder and the time left.
        """
        with self._lock:
            self._require(token)

    @contextmanager
    def starting(self, token: str, engages: bool = False) -> Iterator[None]:
        """While an experiment starts, and as long as it then runs, the bench is this token's; a lease stays as it is.

        Args:
            token: name of the token.
            engages: it is a commissioning that starts, and asks by itself whether it may.

        Raises:
            LeaseHeldError: somebody else has it.
            BusyError: nothing may start now.
        """
        with self._lock:
            self._require(token)
            if not engages and (reason := self._engaged()):
                raise BusyError(reason)
            mine = self._current()
            if mine is None or mine.remaining_s is None:
                self._grant = _Grant(token, token, None)
        try:
            yield
        finally:
            with self._lock:
                if self._grant == _Grant(token, token, None):
                    run = self._run()
                    self._grant = None if run is None else _Grant(token, token, None, run)

    def _require(self, token: str) -> None:
        found = self._current()
        if found is not None and found.token != token:
            raise LeaseHeldError(
                f"the bench is held by {found.in_words()}; wait, or ask an admin to take it over. STOP works always",
                found.remaining_s,
            )

    def _current(self) -> Held | None:
        grant = self._grant
        if grant is None:
            return None
        if grant.until_s is None:
            lasts = grant.run is None or grant.run == self._run()
            return Held(grant.token, grant.holder, None) if lasts else None
        left_s = grant.until_s - self._now_s()
        return Held(grant.token, grant.holder, left_s) if left_s > 0 else None
