"""One question at a time to the person at the bench: asked by the run, answered from terminal, page or program."""

import threading
from collections.abc import Callable
from dataclasses import dataclass

from bench.errors import PromptError

_POLL_S = 0.05  # a stop comes without waking anybody: a signal handler may take no lock


@dataclass(frozen=True, slots=True)
class Prompt:
    """What is asked now.

    Attributes:
        number: given back with the answer, so that an answer that comes late does not count for the next question.
        sentence: what to do before going on.
    """

    number: int
    sentence: str


class PromptDesk:
    """Where questions are laid down and answered. Any thread may do either."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._number = 0
        self._pending: Prompt | None = None

    @property
    def pending(self) -> Prompt | None:
        """What is asked now; None where nobody waits."""
        return self._pending

    def ask(self, sentence: str, given_up: Callable[[], bool]) -> bool:
        """Wait for the answer; False where it was given up before it came."""
        with self._changed:
            self._number += 1
            mine = self._pending = Prompt(self._number, sentence)
            try:
                while self._pending is mine:
                    if given_up():
                        return False
                    self._changed.wait(_POLL_S)
                return True
            finally:
                self._pending = None

    def answer(self, number: int) -> None:
        """It is done; go on.

        Raises:
            PromptError: nothing is asked, or something else.
        """
        with self._changed:
            pending = self._pending
            if pending is None:
                raise PromptError(f"prompt {number} is not open: nothing is asked now; look at the bench's state")
            if pending.number != number:
                raise PromptError(
                    f"prompt {number} is not open, prompt {pending.number} is: {pending.sentence} Read it, then answer"
                )
            self._pending = None
            self._changed.notify_all()
