"""An experiment begun for a larger task, and followed to its end."""

from collections.abc import Callable

from bench.runs.bench_control import BenchControl, Request

_POLL_S = 0.05


def to_its_end(
    runner: BenchControl,
    request: Request,
    given_up: Callable[[], str],
    attend: Callable[[], None] = lambda: None,
) -> int:
    """Begin an experiment, and wait until it is over. Returns the id of its record.

    Args:
        runner: of the bench.
        request: what to begin.
        given_up: why the task goes on no more; "" as long as it does. Asked all the time, so that a stop that comes
            while the run is being started stops it, too.
        attend: called all the time.

    Raises:
        BenchError, DriveError: it is refused, or the drive cannot be opened.
    """
    number = runner.begin(request)
    while not runner.wait(_POLL_S):
        if reason := given_up():
            runner.stop(reason)
        attend()
    return number
