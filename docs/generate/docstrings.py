"""Makes reStructuredText of docstrings, which are plain text with names between backquotes and indented code."""

import re
from collections.abc import Iterator, Sequence

SECTION = re.compile(r"(Args|Attributes|Returns|Raises|Yields):\s*$")
NAMED = re.compile(r"(`[^`]*`)")
SIGNS = re.compile(r"([*|\\]|_\b)")


def escaped(line: str) -> str:
    """A line whose signs mean themselves, except between backquotes."""
    parts = NAMED.split(line)
    return "".join(part if part.startswith("`") else SIGNS.sub(r"\\\1", part) for part in parts)


def restructured(lines: Sequence[str]) -> Iterator[str]:
    """A docstring, line by line: an indented paragraph is code, unless it belongs to a section such as `Args:`."""
    in_section = in_code = False
    previous = ""
    for line in lines:
        indented = line.startswith("  ")
        if line and not indented:
            in_section, in_code = bool(SECTION.match(line)), False
        elif indented and not (in_section or in_code or previous):
            in_code = True
            yield "::"
            yield ""
        yield line if in_code else escaped(line)
        previous = line


def process(_app: object, _what: str, _name: str, _found: object, _options: object, lines: list[str]) -> None:
    """What autodoc calls for each docstring; changes `lines`."""
    lines[:] = restructured(lines)
