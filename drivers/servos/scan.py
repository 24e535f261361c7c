"""Which servos are on a line: asked by pings, which move nothing."""

from collections.abc import Iterator

from drivers.servos.bus import ServoBus
from drivers.servos.frames import Frames, StatusPacket

_ANSWER_S = 0.006  # of one servo
_ALL_S = 0.1  # of a further one, where everybody was asked


def answering(port: str, baud_rate: int, frames: Frames, servo_ids: range | None) -> Iterator[StatusPacket]:
    """The answers to pings.

    Args:
        port: "/dev/ttyUSB0".
        baud_rate: of the line.
        frames: of the protocol.
        servo_ids: asked one after the other; None: everybody at once, where the protocol lets them answer in turn.

    Raises:
        DriveConnectionError: the port is not there, or in use.
    """
    bus = ServoBus(port, baud_rate, _ANSWER_S if servo_ids else _ALL_S, frames)
    try:
        if servo_ids is None:
            yield from bus.listen(frames.ping(frames.broadcast), _ALL_S)
            return
        for servo_id in servo_ids:
            yield from (one for one in bus.listen(frames.ping(servo_id), _ANSWER_S) if one.servo_id == servo_id)
    finally:
        bus.close()
