"""A serial line with servos on it. Every servo hears every packet."""

from collections.abc import Iterable, Sequence
from threading import RLock
from typing import Generic, Protocol, TypeVar

from sim_backend.devices.axis import Axis

RequestT = TypeVar("RequestT")
RequestIn = TypeVar("RequestIn", contravariant=True)
RequestOut = TypeVar("RequestOut", covariant=True)


class Reader(Protocol[RequestOut]):
    """From bytes to the packets of hosts."""

    def forget(self) -> None:
        """Drop half a packet."""

    def feed(self, data: bytes, time_s: float) -> Iterable[RequestOut]:
        """Return the packets that are complete with bytes that arrived at a time [s]."""


class Servo(Protocol[RequestIn]):
    """One servo on the line."""

    @property
    def axis(self) -> Axis:
        """Its power stage and its joint."""

    @property
    def servo_id(self) -> int:
        """To what it answers."""

    def hear(self, request: RequestIn, time_s: float) -> bytes:
        """Take a packet, whoever it is for; return the answer, b'' for none."""

    def report(self) -> dict[str, object]:
        """Say what the servo is about."""


class ServoBus(Generic[RequestT]):
    """The device behind the port. Loads, faults and truth of the side channel are the first servo's."""

    def __init__(self, servos: Sequence[Servo[RequestT]], reader: Reader[RequestT]) -> None:
        self.axis = servos[0].axis
        self.lock = RLock()
        self._servos = servos
        self._reader = reader

    def advance_to(self, time_s: float) -> None:
        """Let time pass."""
        for servo in self._servos:
            servo.axis.advance_to(time_s)

    def connect(self) -> None:
        """Forget half a packet."""
        self._reader.forget()

    def receive(self, data: bytes, time_s: float) -> bytes:
        """Take bytes; return the answers, one after the other."""
        return b"".join(self._answer(request, time_s) for request in self._reader.feed(data, time_s))

    def _answer(self, request: RequestT, time_s: float) -> bytes:
        """Every servo hears it; two of one id answer at the same time, and spoil each other's bits."""
        answers: dict[int, bytes] = {}
        for servo in self._servos:
            answer = servo.hear(request, time_s)
            if answer:
                known = answers.get(servo.servo_id)
                answers[servo.servo_id] = answer if known is None else _collided(known, answer)
        return b"".join(answers.values())

    def report(self) -> dict[str, object]:
        """Say what the first servo is about."""
        return self._servos[0].report()


def _collided(one: bytes, other: bytes) -> bytes:
    """Return what is on the line while two send: a 0 of either wins."""
    shared = min(len(one), len(other))
    both = bytes(left & right for left, right in zip(one, other, strict=False))
    return both + one[shared:] + other[shared:]
