"""Buses that several actuators share: opened by the first of this process, closed by the last; no two have one id."""

from collections.abc import Callable
from threading import Lock
from typing import Any, Generic, Protocol, TypeVar

from drivers.errors import DriveConfigurationError


class Closable(Protocol):
    """A bus."""

    def close(self) -> None:
        """Give the port back."""


BusT = TypeVar("BusT", bound=Closable)
MadeT = TypeVar("MadeT")
Make = Callable[[BusT, Callable[[], None]], MadeT]


class OpenBuses(Generic[BusT]):
    """The open buses of one protocol, by what they are reached by."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._open: dict[Any, tuple[BusT, int]] = {}

    def lend(self, key: object, connect: Callable[[], BusT], make: Make[BusT, MadeT]) -> MadeT:
        """What is made of the bus, opened where nobody has it open, and of what gives it back, which an error does."""
        bus = self._enter(key, connect)
        try:
            return make(bus, lambda: self._leave(key))
        except BaseException:
            self._leave(key)
            raise

    def _enter(self, key: object, connect: Callable[[], BusT]) -> BusT:
        with self._lock:
            bus, users = self._open.get(key, (None, 0))
            made = connect() if bus is None else bus
            self._open[key] = made, users + 1
            return made

    def _leave(self, key: object) -> None:
        """One user less; the bus is closed with the last."""
        with self._lock:
            bus, users = self._open.pop(key)
            if users > 1:
                self._open[key] = bus, users - 1
            else:
                bus.close()


def check_alone(device: str, addresses: str, answers: Callable[[], int]) -> None:
    """See that one answers.

    Args:
        device: name used in messages.
        addresses: its addresses as the settings name them.
        answers: asks one question that moves nothing; how many answers came. Asked again where there are several: one
            that was late is no second actuator.

    Raises:
        DriveConfigurationError: more than one does.
    """
    count = answers()
    if count > 1:
        count = answers()
    if count > 1:
        raise DriveConfigurationError(
            device,
            f"{count} answers came to one question: there are two actuators with {addresses} on the bus. Give each an "
            "id of its own",
        )
