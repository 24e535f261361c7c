"""What keeps a report from being made."""

from bench.errors import BenchError


class BaselineError(BenchError, ValueError):
    """Raised when there is no baseline, or one that these measurements cannot be held against."""
