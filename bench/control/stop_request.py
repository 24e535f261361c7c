"""The wish that a run ends, and who has it."""

import threading

UNNAMED = "stop was asked for"


class StopRequest(threading.Event):
    """Set once; the first reason is the one that is kept. Waits for nothing: safe in a signal handler.

    Attributes:
        reason: who asks, and why.
    """

    def __init__(self) -> None:
        super().__init__()
        self.reason = UNNAMED

    def ask(self, reason: str = "") -> None:
        """Ask for the end."""
        if not self.is_set():
            self.reason = reason or self.reason
            self.set()
