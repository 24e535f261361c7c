"""Bytes spoilt as files and lines spoil them: bits flipped, pieces cut out, doubled, put in from elsewhere."""

from collections.abc import Callable
from random import Random
from typing import NamedTuple

from hypothesis import strategies as st

TELLING = (
    b"\x00", b"\xff", b"\n", b"\r", b'"', b",", b";", b"nan", b"-1e999", b"1e400", b"0x", b"\xef\xbb\xbf", b"\xff\xfe",
    b"[[[[", b"{", b"\x1b[2J", b"\xf0\x9f\x98\x80", b"PK\x03\x04", b"99999999999999999999", b"\x7f\xff\xff\xff",
)  # fmt: skip
_HEAD = 0.02  # of a file: where formats say what they are
_MOST = 8  # bytes that are put in


class Edit(NamedTuple):
    """One edit of some bytes.

    Attributes:
        share: where, from 0 at the beginning to 1 at the end.
        piece: what is put there; empty: a bit is flipped, or bytes are cut out or doubled.
        doing: which, of `_DOING`.
        number: of the bit, or of the bytes.
    """

    share: float
    piece: bytes
    doing: str
    number: int

    def of(self, data: bytes) -> bytes:
        """The data after it."""
        place = int(self.share * len(data))
        return data[:place] + _DOING[self.doing](data[place:], self)


_DOING: dict[str, Callable[[bytes, Edit], bytes]] = {
    "flip": lambda rest, edit: bytes((rest[0] ^ 1 << edit.number % 8,)) + rest[1:] if rest else rest,
    "put": lambda rest, edit: edit.piece + rest,
    "put over": lambda rest, edit: edit.piece + rest[len(edit.piece) :],
    "cut": lambda rest, edit: rest[edit.number :],
    "double": lambda rest, edit: rest[: edit.number] + rest,
    "end": lambda _rest, _edit: b"",
}

EDITS: st.SearchStrategy[Edit] = st.builds(
    Edit,
    st.one_of(st.floats(0.0, 1.0), st.floats(0.0, _HEAD)),
    st.one_of(st.binary(min_size=1, max_size=_MOST), st.sampled_from(TELLING)),
    st.sampled_from(sorted(_DOING)),
    st.integers(0, 64),
)
"""One edit each, as hypothesis draws it."""


def spoilt(data: bytes, edits: list[Edit]) -> bytes:
    """The data after some edits."""
    for edit in edits:
        data = edit.of(data)
    return data


def spoilt_by(chance: Random, data: bytes) -> bytes:
    """The data after one to four edits; drawn so, they cost less than those of hypothesis."""
    for _ in range(chance.randint(1, 4)):
        piece = chance.choice(TELLING) if chance.random() < 0.5 else chance.randbytes(chance.randint(1, _MOST))
        data = Edit(chance.random(), piece, chance.choice(sorted(_DOING)), chance.randint(0, 64)).of(data)
    return data
