"""Errors from one process to the other, with their class and text."""

import pickle
import traceback

from bench.runs.bench_process.messages import Failure


def failure_of(number: int, error: BaseException) -> Failure:
    """An error as it is sent.

    Args:
        number: of the call that raised it.
        error: what it raised.
    """
    attributes = {name: value for name, value in vars(error).items() if _can_be_sent(value)}
    kind = type(error) if _can_be_sent(type(error)) else RuntimeError
    trace = "".join(traceback.format_exception(error))
    return Failure(number, kind, str(error), attributes, trace)


def error_of(failure: Failure) -> BaseException:
    """The error again. Its class is not called: those of the drives take more than the text."""
    error: BaseException = failure.kind.__new__(failure.kind, failure.text)
    error.args = (failure.text,)
    vars(error).update(failure.attributes)
    error.add_note(f"raised in the other process:\n{failure.trace}")
    return error


def _can_be_sent(value: object) -> bool:
    try:
        pickle.dumps(value)
    except Exception:  # whatever a class of somebody else's raises: it is left out
        return False
    return True
