"""Reading and writing objects of the drive by SDO, blocking: for opening and switching, not for control cycles."""

from time import perf_counter
from typing import Final

import canopen
from canopen.sdo.client import SdoClient
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from drivers.canopen.cia301.link import CanLink
from drivers.canopen.cia301.objects import DataType, DriveObject
from drivers.errors import DriveConfigurationError, DriveConnectionError

_ATTEMPTS: Final = 2
_SDO_BYTES: Final = 8
_BEGINS: Final = (1, 2)  # download, upload: command specifiers of the client (CiA 301, 7.2.4.3)
_NAMES_OBJECT: Final = (2, 3, 4)  # upload, download, abort: of the server
_NO_OBJECT: Final = bytes(3)  # of an abort, where a drive does not say what it aborts
_WRITE_ONLY: Final = 0x0601_0001
_OTHER_TYPE: Final = 0x0607_0010
_UNSIZED: Final = 0b0100_0010  # of an answer to an upload: expedited, its length not told


class ObjectRefusedError(DriveConfigurationError):
    """Raised when the drive refuses to read or write an object.

    Attributes:
        code: abort code of CiA 301, 7.2.4.3.17.
    """

    def __init__(self, device: str, message: str, code: int, why: str = "") -> None:
        super().__init__(device, message)
        self.code = code
        self.why = why or message

    @property
    def write_only(self) -> bool:
        """Whether the object is there and may not be read."""
        return self.code == _WRITE_ONLY

    @property
    def other_type(self) -> bool:
        """Whether the object is there and of another data type than CiA 402 gives it."""
        return self.code == _OTHER_TYPE


class ObjectAccess:
    """The SDO client of one drive."""

    def __init__(self, link: CanLink, node_id: int, device: str, answer_s: float) -> None:
        self._device = device
        self._answer_s = answer_s
        self._client = _Client(link, node_id, answer_s)

    def take(self, data: bytes) -> None:
        """Receive an answer of the drive's SDO server."""
        self._client.on_response(0, data, 0.0)

    def read(self, item: DriveObject) -> int:
        """Value of an object [counts].

        Raises:
            ObjectRefusedError: the drive refuses, or has something else in its place.
            DriveConnectionError: it does not answer.
        """
        data = self._transfer(item, None)
        value = item.read(data[: item.type.size] if self._client.unsized else data)
        if value is None:
            why = f"{len(data)} bytes came (0x{data[::-1].hex().upper()}), {item.type.size} are allowed by CiA 402"
            raise ObjectRefusedError(
                self._device,
                f"{item} is of another data type: {why}. Nobody knows what it counts; look in the drive's manual for "
                "a firmware that keeps to the profile",
                _OTHER_TYPE,
                why,
            )
        return value

    def read_if_present(self, item: DriveObject) -> int | None:
        """Value of an object [counts], None where the drive does not tell it, for whatever reason."""
        try:
            return self.read(item)
        except ObjectRefusedError:
            return None

    def read_unsigned(self, index: int, subindex: int) -> int:
        """An object as a number without sign, of whatever length.

        Raises:
            ObjectRefusedError: the drive refuses.
            DriveConnectionError: it does not answer.
        """
        return int.from_bytes(self._transfer(DriveObject(index, subindex, DataType.U8, "object"), None), "little")

    def read_text(self, index: int) -> str:
        """A visible string; empty where the drive does not have it."""
        try:
            data = self._transfer(DriveObject(index, 0, DataType.U8, "text"), None)
        except ObjectRefusedError:
            return ""
        return data.split(b"\0")[0].decode("ascii", errors="replace").strip()

    def write(self, item: DriveObject, value: int) -> None:
        """Write an object.

        Raises:
            ObjectRefusedError: the drive refuses.
            DriveConnectionError: it does not answer.
        """
        self._transfer(item, item.pack(value))

    def _transfer(self, item: DriveObject, data: bytes | None) -> bytes:
        """Download `data`, or upload where there is none. Both may be repeated without harm."""
        what = "reading" if data is None else f"writing {item.words(item.unpack(data))} to"
        problem: Exception | None = None
        for _ in range(_ATTEMPTS):
            try:
                if data is None:
                    return self._client.upload(item.index, item.subindex)
                self._client.download(item.index, item.subindex, data)
                return b""
            except SdoAbortedError as error:
                raise ObjectRefusedError(
                    self._device, f"{what} {item}: refused, {error}", error.code, str(error)
                ) from error
            except SdoCommunicationError as error:
                problem = error
        raise DriveConnectionError(
            self._device,
            f"{what} {item}: {problem} (SDO, {_ATTEMPTS} times {self._answer_s:g} s); is the drive on, the cable in, "
            "node ID and bit rate right?",
        )


class _Client(SdoClient):
    """canopen's client, which takes the answers in itself: there is no receiving thread.

    An answer that begins a transfer names its object. One that names another belongs to a request that was given up,
    by this host or by the one before it: it is let go.
    """

    RETRY_DELAY = 0.0

    def __init__(self, link: CanLink, node_id: int, answer_s: float) -> None:
        super().__init__(0x600 + node_id, 0x580 + node_id, canopen.ObjectDictionary())  # type: ignore[no-untyped-call]
        self.network = link
        self.RESPONSE_TIMEOUT = answer_s
        self._link = link
        self._asked = b""  # index and subindex of the transfer
        self.unsized = False  # the last answer did not tell how many of its bytes count

    def send_request(self, request: bytes) -> None:
        if request[0] >> 5 in _BEGINS:
            self._asked = bytes(request[1:4])
        super().send_request(request)  # type: ignore[no-untyped-call]

    def on_response(self, can_id: int, data: bytes, timestamp: float) -> None:
        if len(data) < _SDO_BYTES:
            return
        if data[0] >> 5 not in _NAMES_OBJECT or bytes(data[1:4]) in (self._asked, _NO_OBJECT):
            self.unsized = data[0] & ~0b1100 == _UNSIZED
            super().on_response(can_id, data, timestamp)  # type: ignore[no-untyped-call]

    def read_response(self) -> bytes:
        deadline_s = perf_counter() + self.RESPONSE_TIMEOUT
        while self.responses.empty():
            remaining_s = deadline_s - perf_counter()
            if remaining_s <= 0.0:
                self._link.drain()
                break
            self._link.receive(remaining_s)
        if self.responses.empty():
            raise SdoCommunicationError("no answer")
        response: bytes = super().read_response()  # type: ignore[no-untyped-call]
        return response
