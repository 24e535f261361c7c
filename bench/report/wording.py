"""Sentences and cells of a report as people read them: signs and intervals, whatever wrote them."""

import re

_SIGNS = (
    (re.compile(r"(?<=\d)%"), " %"),
    (re.compile(r"(?<=\d)( %)? \.\. (?=[-−\d])"), r"\1 to "),
    (re.compile(r"<= ?(?=\d)"), "≤ "),
    (re.compile(r"\bvelocity\b"), "speed"),
)
_SQUARE = re.compile(r"(?<=[a-z])2(?![\w.])")
_IN_BRACKETS = re.compile(r"\[[^\]]*\]")


def spoken(text: str) -> str:
    """`1.69% .. 2.10%` as `1.69 % to 2.10 %`, `<= 0.001` as `≤ 0.001`, velocity as speed, `[m/s2]` as `[m/s²]`."""
    for found, wanted in _SIGNS:
        text = found.sub(wanted, text)
    return _IN_BRACKETS.sub(lambda one: unit_text(one[0]), text)


def unit_text(unit: str) -> str:
    """`N m s2/rad` as `N m s²/rad`; nothing for a number without a unit."""
    return "" if unit == "1" else _SQUARE.sub("²", unit)
