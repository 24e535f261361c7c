"""Buses that several actuators of this process share: opened by the first, closed by the last."""

from collections.abc import Callable
from threading import Lock
from typing import Any, Generic, Protocol, TypeVar


class Closable(Protocol):
    """A bus."""

    def close(self) -> None:
        """Give the port back."""


BusT = TypeVar("BusT", bound=Closable)


class OpenBuses(Generic[BusT]):
    """The open buses of one protocol, by what they are reached by."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._open: dict[Any, tuple[BusT, int]] = {}

    def enter(self, key: object, connect: Callable[[], BusT]) -> BusT:
        """The bus, opened where nobody has it open. Raises what `connect` raises."""
        with self._lock:
            bus, users = self._open.get(key, (None, 0))
            made = connect() if bus is None else bus
            self._open[key] = made, users + 1
            return made

    def leave(self, key: object) -> None:
        """One user less; the bus is closed with the last."""
        with self._lock:
            bus, users = self._open.pop(key)
            if users > 1:
                self._open[key] = bus, users - 1
            else:
                bus.close()
