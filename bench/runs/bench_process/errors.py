"""Errors of the way to the bench process."""

from bench.errors import BenchError


class BenchProcessError(BenchError, ConnectionError):
    """Raised when the process that runs the control loop does not start, or has ended.

    - it was killed, or crashed; the next start of an experiment starts it again
    - its software is of another version than the service: files were updated under a running service
    """


class NotBegunError(BenchProcessError):
    """Raised when the process has ended before it accepted a call: another one may be asked the same."""
