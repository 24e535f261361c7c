"""A serial port for hosts, in front of a server of somebody else's."""

from collections.abc import Callable
from pathlib import Path

from sim_backend.devices.link.line import Line
from sim_backend.devices.link.passage import Passage
from sim_backend.devices.link.port import PortThread
from sim_backend.devices.link.pseudo_terminal import PseudoTerminal
from sim_backend.devices.wall_time import WallTime


class SerialRelay(PortThread):
    """A pseudo-terminal for hosts; the server has opened `inner`."""

    def __init__(self, line: Line, clock: WallTime, link: Path | None = None) -> None:
        super().__init__(line, clock, "serial relay")
        self._link = link
        self._server = _Kept(PseudoTerminal())
        self.inner = self._server.path
        self._passage: Passage | None = None
        self.path = self._plug()

    def close(self) -> None:
        """End the thread and the ports."""
        super().close()
        self._server.end()

    def _serve(self) -> None:
        if self._passage is None:
            self.path = self._plug()
        self._pass_time()

    def _plug(self) -> str:
        outer = PseudoTerminal(self._link)
        self._passage = Passage(outer, self._server, self._line, self._clock)
        return outer.path

    def _unplug(self) -> None:
        if self._passage is not None:
            self._passage.close()
            self._passage = None


class _Kept:
    """A pseudo-terminal that outlives the passages through it."""

    def __init__(self, terminal: PseudoTerminal) -> None:
        self._terminal = terminal
        self.path = terminal.path
        self.read: Callable[[float], bytes] = terminal.read
        self.write: Callable[[bytes], None] = terminal.write
        self.end = terminal.close

    def close(self) -> None:
        """Stay."""
