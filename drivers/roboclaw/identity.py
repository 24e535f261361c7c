"""Who answers: the text of command 21."""

import re
from typing import NamedTuple

_VERSION = re.compile(r"(?P<product>.*roboclaw.*?)\s+v(?P<firmware>\d[\w.]*)", re.IGNORECASE)


class Identity(NamedTuple):
    """Product and firmware of a controller."""

    product: str
    firmware: str
    simulated: bool


def parse_version(text: str) -> Identity | None:
    """Take "USB Roboclaw 2x15a v4.1.34" apart; None where it is no RoboClaw."""
    found = _VERSION.match(text.strip())
    if found is None:
        return None
    return Identity(found["product"].strip(), found["firmware"], "simulated" in text.lower())
