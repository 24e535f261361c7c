"""The line that a controller is on: a serial port or a CAN-FD bus, shared by those that are on one."""

from collections.abc import Callable, Mapping
from typing import Protocol, TypeVar

from drivers.actuator.open_buses import OpenBuses
from drivers.moteus.can_line import MoteusCanLine
from drivers.moteus.line import MoteusLine
from drivers.moteus.settings import MoteusSettings


class Line(Protocol):
    """What carries frames to controllers."""

    def ask(self, questions: Mapping[int, bytes], what: str) -> dict[int, bytes]:
        """Send a frame to each of some controllers, and take the answer of each."""

    def listen(self, questions: Mapping[int, bytes], wait_s: float) -> list[tuple[int, bytes]]:
        """Ask some controllers, of which any may not be there, or twice; every answer that comes within a time [s]."""

    def tell(self, servo_id: int, data: bytes) -> None:
        """Send a frame that is not answered. Never raises."""

    def close(self) -> None:
        """Give it back. Never raises."""


MadeT = TypeVar("MadeT")
_LINES: OpenBuses[Line] = OpenBuses()


def on_line(settings: MoteusSettings, make: Callable[[Line, Callable[[], None]], MadeT]) -> MadeT:
    """A controller on a line, which is opened where no other controller has it open.

    Raises:
        DriveError: the line does not open, or the controller cannot be opened; the line is given back then.
    """

    def opened() -> Line:
        if settings.bus is not None:
            return MoteusCanLine(settings.bus, settings.answer_timeout_s)
        return MoteusLine(settings.port, settings.over_uart, settings.answer_timeout_s)

    return _LINES.lend(settings.place, opened, make)
