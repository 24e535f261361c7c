"""A socketcand server's side of its protocol (its doc/protocol.md): one bus, raw mode.

< hi >    < open can0 > < ok >    < rawmode > < ok >    < send 123 2 11 22 >    < frame 123 23.424242 1122 >
"""

import time
from collections.abc import Callable

from sim_backend.devices.can.frame import Frame

_OK = b"< ok >"
_LONGEST = 256
_SHORT = 3  # digits of an identifier of 11 bits
BUS = "can0"


class SocketcandSession:
    """One connection."""

    def __init__(self) -> None:
        self._text = ""
        self._open = False
        self._raw = False
        self._commands: dict[str, Callable[[list[str]], tuple[bytes, Frame | None]]] = {
            "open": self._open_bus,
            "rawmode": self._raw_mode,
            "echo": lambda _words: (b"< echo >", None),
            "send": self._send,
            "sendrtr": self._send_remote,
        }

    def greet(self) -> bytes:
        """Say hi."""
        return b"< hi >"

    def feed(self, data: bytes) -> tuple[bytes, list[Frame]]:
        """Take bytes of the host."""
        answers, frames = b"", []
        self._text = (self._text + data.decode("ascii", "replace"))[-_LONGEST * 8 :]
        while ">" in self._text:
            text, self._text = self._text.split(">", 1)
            answer, frame = self._obey(text.split("<")[-1].split())
            answers += answer
            if frame is not None:
                frames.append(frame)
        return answers, frames

    def tell(self, frame: Frame) -> bytes:
        """Return what a host is told of a frame. Three digits are an identifier of 11 bits; any other number, of 29."""
        if not self._raw:
            return b""
        now_s = time.time()
        name = f"{frame.can_id:08X}" if frame.extended else f"{frame.can_id:03X}"
        if frame.remote:
            return f"< rtr {name} {now_s:.6f} {len(frame.data)} >".encode("ascii")
        return f"< frame {name} {now_s:.6f} {frame.data.hex().upper()} >".encode("ascii")

    def _obey(self, words: list[str]) -> tuple[bytes, Frame | None]:
        command = self._commands.get(words[0]) if words else None
        if command is None:
            return b"< error unknown command >", None
        try:
            return command(words[1:])
        except (ValueError, IndexError):
            return b"< error could not parse the command >", None

    def _open_bus(self, words: list[str]) -> tuple[bytes, Frame | None]:
        if words != [BUS]:
            return b"< error could not open bus >", None
        self._open = True
        return _OK, None

    def _raw_mode(self, words: list[str]) -> tuple[bytes, Frame | None]:  # noqa: ARG002
        if not self._open:
            return b"< error no bus is open >", None
        self._raw = True
        return _OK, None

    def _send(self, words: list[str]) -> tuple[bytes, Frame | None]:
        can_id, length = int(words[0], 16), int(words[1])
        data = bytes(int(byte, 16) for byte in words[2:])
        return self._frame(Frame(can_id, data, extended=len(words[0]) > _SHORT), length == len(data) <= 8)

    def _send_remote(self, words: list[str]) -> tuple[bytes, Frame | None]:
        frame = Frame(int(words[0], 16), bytes(int(words[1])), remote=True, extended=len(words[0]) > _SHORT)
        return self._frame(frame, int(words[1]) <= 8)

    def _frame(self, frame: Frame, is_valid: bool) -> tuple[bytes, Frame | None]:
        if not self._raw or not is_valid or frame.can_id > (0x1FFF_FFFF if frame.extended else 0x7FF):
            return b"< error frame refused >", None
        return b"", frame
