"""Where the questions of a commissioning are laid down, and answered from outside: by the page, or by a program."""

import threading
from collections.abc import Callable
from dataclasses import dataclass

from bench.commission.questions import CommissionError, Question
from bench.control.prompt import PromptDesk
from bench.errors import PromptError


@dataclass(frozen=True, slots=True)
class Asked:
    """What is asked now.

    Attributes:
        number: given back with the answer, so that an answer that comes late does not count for the next question.
        question: what number is wanted; None where something is to be done.
    """

    number: int
    key: str
    sentence: str
    question: Question | None


class Desk:
    """A `Person` who answers from elsewhere. Any thread may answer; the one of the commissioning waits.

    Args:
        given_up: why nobody answers any more; "" as long as somebody may.
    """

    def __init__(self, given_up: Callable[[], str]) -> None:
        self._given_up, self._prompts, self._answering = given_up, PromptDesk(), threading.Lock()
        self._key, self._question, self._value = "", None, None  # type: str, Question | None, float | None

    @property
    def asked(self) -> Asked | None:
        """What is asked now; None where nobody waits."""
        found = self._prompts.pending
        return None if found is None else Asked(found.number, self._key, found.sentence, self._question)

    def number(self, question: Question) -> float | None:
        """Wait for a number; None where it is not known.

        Raises:
            CommissionError: it was given up before the answer came.
        """
        self._wait(question.key, question.sentence, question)
        return self._value

    def done(self, key: str, sentence: str) -> bool:
        """Wait until it is done.

        Raises:
            CommissionError: it was given up before.
        """
        self._wait(key, sentence, None)
        return True

    def answer(self, number: int, value: float | None) -> str:
        """Answer question `number`: with a value, or with None where it is done, or not known.

        Returns:
            The key of the question.

        Raises:
            PromptError: nothing is asked, or something else.
            AnswerError: the value is missing, or out of what is allowed; the question stays.
        """
        with self._answering:
            asked = self.asked
            if asked is not None and asked.number == number and asked.question is not None:
                asked.question.check(value)
                self._value = value
            elif value is not None and asked is not None and asked.number == number:
                raise PromptError(f"question {number} takes no value: {asked.sentence}")
            self._prompts.answer(number)
            return self._key

    def _wait(self, key: str, sentence: str, question: Question | None) -> None:
        self._key, self._question, self._value = key, question, None
        if not self._prompts.ask(sentence, lambda: bool(self._given_up())):
            raise CommissionError(self._given_up())
