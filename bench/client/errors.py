"""What may go wrong between a program and the service."""

from bench.errors import BenchError


class ClientError(BenchError, RuntimeError):
    """Base of the errors of the client. Raised only through a subclass."""


class Unreachable(ClientError, ConnectionError):
    """Raised when the service does not answer, or not in time."""


class Refused(ClientError):
    """Raised when the service says no; the message is its own.

    Attributes:
        status: of the answer: 401, 403 (who asks), 404, 409 (not now), 422 (what is asked), 502 (the drive) ...
        kind: name of the error in the service, "LimitError".
        errors: field by field, see `Problem` in the interface's description.
    """

    def __init__(self, status: int, detail: str, kind: str = "", errors: list[dict[str, object]] | None = None) -> None:
        super().__init__(detail)
        self.status = status
        self.kind = kind
        self.errors = errors or []
