"""Error codes in words: a table of CiA, and one of each vendor that has a file in `error_codes`."""

import tomllib
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any, Final

HOST_LOST: Final = (0x8130, 0x8250)
"""Codes that say only that the host was silent: heartbeat or guarding, RPDO timeout."""

Table = dict[str, Any]
"""A file of codes as TOML has it."""

_FOLDER = resources.files("drivers.canopen") / "error_codes"
_STANDARD: Final = "cia.toml"


@dataclass(frozen=True, slots=True)
class ErrorCodes:
    """The codes of one vendor, and the standard's.

    Attributes:
        classes: of the standard, by the first digit.
    """

    names: dict[int, str] = field(default_factory=dict)
    classes: dict[int, str] = field(default_factory=dict)

    def name(self, code: int) -> str:
        """A code in words; by its class where it has no name of its own."""
        words = self.names.get(code) or self.classes.get(code >> 12, "not in CiA 301 or 402")
        return f"0x{code:04X}, {words}"


@cache
def error_codes(vendor_id: int | None = None) -> ErrorCodes:
    """The codes of a vendor; those of the standard alone where there is no file of the vendor's."""
    standard = _read(_STANDARD)
    own = next((table for table in _vendors() if table.get("vendor_id") == vendor_id), {})
    return ErrorCodes(_numbered(standard["codes"]) | _numbered(own.get("codes", {})), _numbered(standard["classes"]))


@cache
def _vendors() -> tuple[Table, ...]:
    names = sorted(item.name for item in _FOLDER.iterdir() if item.name.endswith(".toml"))
    return tuple(_read(name) for name in names if name != _STANDARD)


def _read(name: str) -> Table:
    return tomllib.loads((_FOLDER / name).read_text(encoding="utf-8"))


def _numbered(table: dict[str, str]) -> dict[int, str]:
    return {int(code, 16): words for code, words in table.items()}
