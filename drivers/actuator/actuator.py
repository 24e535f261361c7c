"""What a kind of actuator has to bring: its protocol, in raw words, without any state of its own."""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, Protocol

from drivers.actuator.reading import Reading
from drivers.contract import Mode
from drivers.polled_drive import Identity


class Actuator(Protocol):
    """A connected actuator. Each call raises `DriveConnectionError` where it is not answered in time.

    Attributes:
        notes: what the user should know, a sentence each.
        bus: that it is on, and others may be.
    """

    identity: Identity
    notes: tuple[str, ...]
    bus: Any
    _leave: Callable[[], None]  # gives the bus back

    @property
    def modes(self) -> frozenset[Mode]:
        """That it has."""

    @property
    def measured(self) -> frozenset[str]:
        """Names of the `Sample` fields that are measured."""

    @property
    def steps(self) -> dict[str, float]:
        """Smallest step of a quantity, by `Sample` field, in its unit; of position and speed in counts."""

    def begin(self) -> None:
        """A call of the contract begins: from now on its questions share one time limit."""

    def switch_on(self, mode: Mode, here: Reading) -> None:
        """Power the stage with a demand that moves nothing; `here` is what it has just said."""

    def switch_off(self) -> None:
        """Power off."""

    @staticmethod
    @abstractmethod
    def exchange_all(demands: Sequence[tuple[Any, Mode, float]]) -> list[Reading]:
        """One cycle of several actuators of the kind on one bus.

        Args:
            demands: of each a demand [duty, A, N m or counts]; with `Mode.OFF` none.

        Raises:
            DriveConnectionError: one of them does not answer.
        """

    def exchange(self, mode: Mode, value: float) -> Reading:
        """One cycle of this one alone."""
        [reading] = self.exchange_all([(self, mode, value)])
        return reading

    def braking(self) -> tuple[Mode, float]:
        """The demand of its quick stop."""

    def ask(self) -> Reading:
        """What it says of itself, by questions alone."""
        return self.exchange(Mode.OFF, 0.0)

    def clear_fault(self) -> None:
        """Acknowledge what has switched it off, and leave the power off."""

    def shout_off(self) -> None:
        """Say once that it shall be off, and wait for no answer. Never raises."""

    def close(self) -> None:
        """Give the bus back, where nobody else uses it. Never raises."""
        self._leave()
