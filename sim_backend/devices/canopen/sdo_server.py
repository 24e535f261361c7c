"""The SDO server: expedited and segmented transfers (CiA 301). Block transfers are refused."""

from dataclasses import dataclass
from struct import pack, unpack

from sim_backend.devices.canopen.abort import Abort, AbortCode
from sim_backend.devices.canopen.dictionary import Dictionary

_LONGEST = 8
_EXPEDITED = 4
_SEGMENT = 7


@dataclass
class _Transfer:
    """A segmented transfer under way."""

    index: int
    subindex: int
    data: bytes
    upload: bool
    toggle: int = 0
    announced: int | None = None  # length of a download, where the client has told


class SdoServer:
    """Answers the requests of one client."""

    def __init__(self, dictionary: Dictionary) -> None:
        self._dictionary = dictionary
        self._transfer: _Transfer | None = None

    def reset(self) -> None:
        """Forget a transfer under way."""
        self._transfer = None

    def answer(self, request: bytes) -> bytes | None:
        """Return the answer to a request of eight bytes; None where there is none."""
        if len(request) != _LONGEST:
            return None
        command, index, subindex = unpack("<BHB", request[:4])
        specifier = command >> 5
        if specifier == 4:  # the client has given up
            self._transfer = None
            return None
        try:
            return self._dispatch(specifier, request, index, subindex)
        except Abort as abort:
            if self._transfer is not None and specifier in (0, 3):
                index, subindex = self._transfer.index, self._transfer.subindex
            self._transfer = None
            return pack("<BHBI", 0x80, index, subindex, abort.code)

    def _dispatch(self, specifier: int, request: bytes, index: int, subindex: int) -> bytes:
        match specifier:
            case 0:
                return self._download_segment(request)
            case 1:
                return self._begin_download(request, index, subindex)
            case 2:
                return self._begin_upload(index, subindex)
            case 3:
                return self._upload_segment(request)
        raise Abort(AbortCode.UNKNOWN_COMMAND)

    def _begin_upload(self, index: int, subindex: int) -> bytes:
        data = self._dictionary.read(index, subindex)
        if 0 < len(data) <= _EXPEDITED:
            unused = _EXPEDITED - len(data)
            return pack("<BHB", 0x43 | unused << 2, index, subindex) + data.ljust(_EXPEDITED, b"\0")
        self._transfer = _Transfer(index, subindex, data, upload=True)
        return pack("<BHBI", 0x41, index, subindex, len(data))

    def _upload_segment(self, request: bytes) -> bytes:
        transfer = self._under_way(request, upload=True)
        piece, transfer.data = transfer.data[:_SEGMENT], transfer.data[_SEGMENT:]
        last = not transfer.data
        header = transfer.toggle << 4 | (_SEGMENT - len(piece)) << 1 | last
        transfer.toggle ^= 1
        if last:
            self._transfer = None
        return bytes([header]) + piece.ljust(_SEGMENT, b"\0")

    def _begin_download(self, request: bytes, index: int, subindex: int) -> bytes:
        expedited, sized = request[0] & 0x2, request[0] & 0x1
        if expedited:
            kind = self._dictionary.entry(index, subindex).kind
            length = _EXPEDITED - (request[0] >> 2 & 0x3) if sized else kind.length or _EXPEDITED
            self._dictionary.write(index, subindex, request[4 : 4 + length])
        else:
            self._dictionary.entry(index, subindex)
            announced = unpack("<I", request[4:])[0] if sized else None
            self._transfer = _Transfer(index, subindex, b"", upload=False, announced=announced)
        return pack("<BHBI", 0x60, index, subindex, 0)

    def _download_segment(self, request: bytes) -> bytes:
        transfer = self._under_way(request, upload=False)
        transfer.data += request[1 : 1 + _SEGMENT - (request[0] >> 1 & 0x7)]
        answer = bytes([0x20 | transfer.toggle << 4]).ljust(_LONGEST, b"\0")
        transfer.toggle ^= 1
        if request[0] & 0x1:
            self._end_download(transfer)
            self._transfer = None
        return answer

    def _end_download(self, transfer: _Transfer) -> None:
        if transfer.announced is not None and transfer.announced != len(transfer.data):
            short = len(transfer.data) < transfer.announced
            raise Abort(AbortCode.LENGTH_TOO_LOW if short else AbortCode.LENGTH_TOO_HIGH)
        self._dictionary.write(transfer.index, transfer.subindex, transfer.data)

    def _under_way(self, request: bytes, upload: bool) -> _Transfer:
        transfer = self._transfer
        if transfer is None or transfer.upload is not upload:
            raise Abort(AbortCode.UNKNOWN_COMMAND)
        if request[0] >> 4 & 0x1 != transfer.toggle:
            raise Abort(AbortCode.TOGGLE_BIT)
        return transfer
