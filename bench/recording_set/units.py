"""Units by the names that people give them, and their factors to SI."""

import math
import re
from dataclasses import dataclass

from bench.config import quantities

TURN = 2.0 * math.pi
ENDINGS = {unit: ending for ending, unit in quantities.UNITS.items()} | {"1": ""}
"""What the name of a channel ends in, by its SI unit."""


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit: SI value = factor x value + offset.

    Attributes:
        si: the SI unit, as in the table of channels.
        factor, offset: to SI.
        counts: the factor is to be multiplied by the turn of one count of the sensor.
    """

    name: str
    si: str
    factor: float = 1.0
    offset: float = 0.0
    counts: bool = False


# SI unit -> name -> (factor, other spellings); spellings are without blanks, in lower case
_TABLE: dict[str, dict[str, tuple[float, str]]] = {
    "s": {
        "s": (1.0, "sec secs second seconds sek sekunden sekunde"),
        "ms": (1e-3, "msec msecs millis millisecond milliseconds millisekunden"),
        "us": (1e-6, "usec usecs micros microsecond microseconds mikrosekunden"),
        "ns": (1e-9, "nsec nsecs nanos nanosecond nanoseconds"),
        "min": (60.0, "minutes minuten"),
    },
    "rad": {
        "rad": (1.0, "radian radians"),
        "mrad": (1e-3, "milliradian"),
        "deg": (math.pi / 180.0, "degree degrees grad deg. altgrad"),
        "arcmin": (math.pi / 10800.0, ""),
        "turn": (TURN, "turns rev revs revolution revolutions rot u umdr umdrehungen tours"),
    },
    "rad/s": {
        "rad/s": (1.0, "rads rads-1 rad/sec radpersec"),
        "mrad/s": (1e-3, "mrads"),
        "deg/s": (math.pi / 180.0, "degs degs-1 dps deg/sec degpersec grad/s"),
        "rpm": (TURN / 60.0, "1/min min-1 u/min umin tr/min r/min rev/min revmin min^-1 giri/min"),
        "turn/s": (TURN, "rps turns/s revs rev/s revs/s u/s hz 1/s"),
    },
    "m": {"m": (1.0, "meter metre"), "mm": (1e-3, "millimeter"), "cm": (1e-2, ""), "um": (1e-6, "micron")},
    "m/s": {"m/s": (1.0, "m/sec ms-1"), "mm/s": (1e-3, "mm/sec mms-1"), "m/min": (1.0 / 60.0, ""), "cm/s": (1e-2, "")},
    "A": {
        "A": (1.0, "a amp amps ampere arms apk"),
        "mA": (1e-3, "ma milliamp milliamps milliampere"),
        "uA": (1e-6, ""),
    },
    "V": {"V": (1.0, "v volt volts"), "mV": (1e-3, "mv millivolt millivolts"), "kV": (1e3, "")},
    "N m": {
        "N m": (1.0, "nm newtonmeter newton-meter n-m"),
        "mN m": (1e-3, "mnm"),
        "N cm": (1e-2, "ncm"),
        "N mm": (1e-3, "nmm"),
        "kN m": (1e3, "knm"),
        "kgf cm": (0.0980665, "kgfcm kgcm kg-cm"),
        "ozf in": (0.00706155181, "ozfin ozin oz-in"),
        "lbf ft": (1.3558179483, "lbfft ftlb lbft ft-lb"),
    },
    "kg": {
        "kg": (1.0, "kilogram kilograms kilogramm kilo"),
        "g": (1e-3, "gram grams gramm gr"),
        "lb": (0.45359237, "lbs pound pounds"),
        "oz": (0.028349523125, "ounce ounces"),
    },
    "N": {"N": (1.0, "n newton newtons"), "mN": (1e-3, "mn"), "kN": (1e3, "kn"), "kgf": (9.80665, "kp")},
    "1": {"1": (1.0, "- norm pu"), "%": (1e-2, "percent pct prozent pourcent"), "permille": (1e-3, "")},
    "degC": {"degC": (1.0, "c celsius"), "K": (1.0, "k kelvin"), "degF": (5.0 / 9.0, "f fahrenheit")},
}
_OFFSETS = {"K": -273.15, "degF": -160.0 / 9.0}
_COUNTS = "counts count cts inc ticks tick increments inkremente pulses steps lsb"


def _spelt(text: str) -> str:
    """A unit as it is looked up: without blanks, dots and underscores; in lower case."""
    for sign, plain in (("µ", "u"), ("μ", "u"), ("°", "deg"), ("º", "deg"), ("⁻¹", "-1")):
        text = text.replace(sign, plain)
    text = re.sub("per(?!cent)", "/", text)
    if text.endswith("_s") and not text.startswith("_"):
        text = text.removesuffix("_s") + "/s"
    for sign in " ·⋅*._^":
        text = text.replace(sign, "")
    return text.lower()


def _known() -> dict[str, Unit]:
    found: dict[str, Unit] = {}
    for si, units in _TABLE.items():
        for name, (factor, spellings) in units.items():
            unit = Unit(name, si, factor, _OFFSETS.get(name, 0.0))
            for spelling in (_spelt(name), *spellings.split()):
                found.setdefault(spelling, unit)
    for spelling in _COUNTS.split():
        found[spelling] = Unit("counts", "rad", 1.0, counts=True)
        found[f"{spelling}/s"] = Unit("counts/s", "rad/s", 1.0, counts=True)
    return found


UNITS = _known()


def unit_named(text: str) -> Unit | None:
    """The unit that a text stands for, such as "deg", "°/s", "mA", "U/min"; None where it is none."""
    return UNITS.get(_spelt(text))


def units_of(si: str) -> list[str]:
    """Names of the units of a quantity, by its SI unit."""
    found = [unit.name for unit in UNITS.values() if unit.si == si]
    return list(dict.fromkeys(found))
