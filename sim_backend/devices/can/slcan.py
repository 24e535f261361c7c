"""The slcan (Lawicel) adapter: one command a line, ended by CR; answered by CR, or BEL where it is refused.

Sn  bit rate        O  open     L  open, listen only     C  close     V  version   N  serial number   F  status
tiiildd..  frame with 11-bit identifier, answered by z CR       riiil  remote request
Tiiiiiiiildd..  frame with 29-bit identifier, answered by Z CR  Riiiiiiiil  remote request
"""

from sim_backend.devices.can.frame import Frame

OK, REFUSED = b"\r", b"\a"
_LONGEST_LINE = 32
_FIXED = {"V": b"V1013\r", "N": b"NA123\r"}
_BIT_RATES = frozenset("012345678")
_HEX = frozenset("0123456789abcdefABCDEF")


class SlcanAdapter:
    """One adapter; it is closed at first."""

    def __init__(self) -> None:
        self._line = b""
        self._has_bit_rate = False
        self._open = False
        self._listens_only = False

    def greet(self) -> bytes:
        """Say nothing."""
        return b""

    def feed(self, data: bytes) -> tuple[bytes, list[Frame]]:
        """Take bytes of the host."""
        answers, frames = b"", []
        *lines, self._line = (self._line + data).split(b"\r")
        for line in lines:
            answer, frame = self._obey(line.decode("ascii", "replace"))
            answers += answer
            if frame is not None:
                frames.append(frame)
        if len(self._line) > _LONGEST_LINE:
            self._line = b""
            answers += REFUSED
        return answers, frames

    def tell(self, frame: Frame) -> bytes:
        """Return the line of a frame."""
        if not self._open:
            return b""
        letter = "r" if frame.remote else "t"
        data = "" if frame.remote else frame.data.hex().upper()
        head = f"{letter.upper()}{frame.can_id:08X}" if frame.extended else f"{letter}{frame.can_id:03X}"
        return f"{head}{len(frame.data)}{data}\r".encode("ascii")

    def _obey(self, line: str) -> tuple[bytes, Frame | None]:
        if not line:
            return OK, None
        command, rest = line[0], line[1:]
        if command in _FIXED and not rest:
            return _FIXED[command], None
        if command in "trTR":
            return self._transmit(command, rest)
        return (OK if self._configure(command, rest) else REFUSED) if command != "F" else self._flags(), None

    def _flags(self) -> bytes:
        return b"F00\r" if self._open else REFUSED

    def _configure(self, command: str, rest: str) -> bool:
        """Obey a command that is answered with CR alone; tell whether that could be done."""
        match command:
            case "S" if not self._open and rest in _BIT_RATES:
                self._has_bit_rate = True
            case "s" if not self._open and len(rest) in (4, 6):
                self._has_bit_rate = True
            case "O" | "L" if not self._open and self._has_bit_rate and not rest:
                self._open, self._listens_only = True, command == "L"
            case "C" if self._open and not rest:
                self._open = False
            case "Z" if not self._open and rest in ("0", "1"):
                return rest == "0"  # it has no time stamps
            case "M" | "m" if not self._open and len(rest) == 8:
                pass  # filters let everything through
            case _:
                return False
        return True

    def _transmit(self, command: str, rest: str) -> tuple[bytes, Frame | None]:
        extended, remote = command in "TR", command in "rR"
        digits, highest = (8, 0x1FFF_FFFF) if extended else (3, 0x7FF)
        if not self._open or self._listens_only or len(rest) <= digits or not set(rest) <= _HEX:
            return REFUSED, None
        can_id, length, data = int(rest[:digits], 16), int(rest[digits], 16), rest[digits + 1 :]
        if can_id > highest or length > 8 or len(data) != (0 if remote else 2 * length):
            return REFUSED, None
        frame = Frame(can_id, bytes(length) if remote else bytes.fromhex(data), remote, extended)
        return (b"Z\r" if extended else b"z\r"), frame
