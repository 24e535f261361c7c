"""The encoding of a text file: told by its first bytes, by its user, or UTF-8, or else what Windows writes."""

import codecs
import string

UTF_8 = "utf-8-sig"
WINDOWS = "cp1252"
_MARKS = {codecs.BOM_UTF8: UTF_8, codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
NOT_OF_FILES = ("idna", "punycode", "unicode_escape", "unicode-escape", "raw-unicode-escape", "utf-7")
_CONTROL = frozenset(range(32)) - {9, 10, 12, 13, 26}


def encoding_of(head: bytes) -> str | None:
    """The encoding of a file that begins so; None where it is no text.

    Args:
        head: the first bytes of the file; what is cut off at its end does no harm.
    """
    for mark, encoding in _MARKS.items():
        if head.startswith(mark):
            return encoding
    nulls = head[:400].count(0)
    if nulls > len(head[:400]) // 3:  # every second byte of Latin text in UTF-16
        return "utf-16-le" if head[1:2] == b"\0" else "utf-16-be"
    if nulls:
        return None
    try:
        codecs.getincrementaldecoder("utf-8")().decode(head)
    except UnicodeDecodeError:
        return None if _CONTROL.intersection(head) else WINDOWS
    return UTF_8


def is_text(encoding: str) -> str:
    """The encoding, if it is one of text files.

    Raises:
        ValueError: it is unknown, or not of files.
    """
    try:
        found = codecs.getincrementaldecoder(encoding)().decode(string.printable.encode(encoding), final=True)
    except (LookupError, UnicodeError, TypeError, AttributeError, ValueError):
        found = ""
    if found != string.printable or codecs.lookup(encoding).name in NOT_OF_FILES:
        raise ValueError(f"found '{encoding[:40]}'; wanted the encoding of a text file, such as utf-8 or cp1252")
    return encoding


def name_of(encoding: str) -> str:
    """An encoding as a user knows it."""
    return {UTF_8: "UTF-8", WINDOWS: "Windows-1252"}.get(encoding, encoding.upper())
