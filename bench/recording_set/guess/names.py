"""What the name of a column says: words, a unit, and the quantity that they stand for."""

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

from bench.recording_set.conditions import KNOWN
from bench.recording_set.units import ENDINGS, Unit, unit_named
from compensator.lab.recordings.recording import CHANNELS

_BRACKET = re.compile(r"^(?P<base>.*?)\s*[\[({<](?P<unit>[^\])}>]*)[\])}>]\s*$")
LOOKED_AT = 200  # characters of a name
MOTION = ("position", "velocity")
_WORD = re.compile(r"[A-ZÄÖÜ]?[a-zäöüßàâéèêíóúñùµθωτφ]+|[A-ZÄÖÜ]+(?![a-z])|\d+")
# SI unit -> quantity, where the words say nothing
BY_UNIT = {
    "s": "time", "rad": "position", "m": "position", "rad/s": "velocity", "m/s": "velocity", "A": "current",
    "V": "voltage", "N m": "torque", "N": "force", "degC": "temperature",
}  # fmt: skip
UNITS_OF = {
    "time": ("s",), "position": ("rad", "m"), "target": ("rad", "m"), "velocity": ("rad/s", "m/s"), "current": ("A",),
    "current_command": ("A",), "voltage": ("V",), "supply": ("V",), "duty": ("1",), "torque": ("N m",),
    "load_torque": ("N m",), "force": ("N",), "temperature": ("degC",), "enabled": ("1",),
}  # fmt: skip
LOAD = "load_kg"
TAKEN = UNITS_OF | {name: (si,) if si else () for name, si in KNOWN.items()}
"""What a column may be said to be, quantities of a channel and conditions of a trial, with their SI units."""
_OF_CHANNEL = {f"{quantity}{ENDINGS[si]}": quantity for quantity, units in UNITS_OF.items() for si in units}


def _listed(text: str) -> frozenset[str]:
    return frozenset(text.split())


# the first quantity that a word of a name belongs to is taken: what is more special stands before
WORDS: tuple[tuple[str, frozenset[str]], ...] = (
    ("temperature", _listed("temperature temp temperatur température temperatura tmp tmot tmotor")),
    ("enabled", _listed("enabled enable enb")),
    ("duty", _listed("duty pwm dutycycle tastgrad")),
    (
        "supply",
        _listed(
            "supply vbus ubus udc vdc vin battery batt vbat dclink zwischenkreis zwischenkreisspannung versorgung "
            "versorgungsspannung bus"
        ),
    ),
    ("acceleration", _listed("acc accel acceleration beschleunigung accélération aceleración ddq qdd")),
    ("torque", _listed("torque tau trq drehmoment moment couple par torsion koppel coppia effort")),
    ("force", _listed("force kraft fuerza forza fz fx fy")),
    ("current", _listed("current curr cur i iq amps amp strom motorstrom courant corriente corrente")),
    ("voltage", _listed("voltage volt volts u uq vq spannung tension tensión voltaje tensione")),
    (
        "velocity",
        _listed(
            "vel velocity speed omega ω w dq qd qdot dtheta thetadot rpm drehzahl geschwindigkeit "
            "winkelgeschwindigkeit vitesse velocidad velocità spd xdot"
        ),
    ),
    (
        "position",
        _listed(
            "pos position angle ang winkel drehwinkel lage weg q theta phi posición posicion ángulo angulo posizione "
            "enc encoder counts count ticks displacement stroke x"
        ),
    ),
    (
        "time",
        _listed(
            "t time zeit temps tiempo tempo timestamp stamp clock millis micros seconds secs sec date datum uhrzeit "
            "zeitstempel zeitpunkt elapsed datetime hora heure fecha ms us nanosec nsec nsecs"
        ),
    ),
)
WEIGHT = _listed(
    "payload load mass weight hung hanging nutzlast last zusatzlast masse gewicht zusatzmasse zuladung charge carga "
    "carico"
)
TARGET = _listed(
    "target ref reference setpoint set sp soll sollwert desired des cmd command commanded goal demand consigne wanted "
    "objetivo referencia dem"
)
ERROR = _listed("error err deviation abweichung fehler schleppfehler erreur residual std rms var covariance status")
PRESENT = _listed("current curr cur")
MEASURED = _listed("actual act measured meas ist istwert feedback fb present real mes mesuré medido encoder")
DERIVED = _listed("filtered filt lp smooth estimate estimated est sim simulated model hat pred predicted")
SENSOR = _listed("sensor cell loadcell transducer messwelle external extern output load brake bremse")
DRIVE = _listed("motor drive servo actuator antrieb")
OTHER_AXIS = _listed("d id ia ib ic phase a b c")  # of a vector drive: not what makes torque, as that of the supply
OWN_MASS = DRIVE | _listed("arm link rotor body own gear gripper tool eigen cell loadcell sensor")
JOINT_SIDE = _listed("joint output link arm load abtrieb gelenk")


@dataclass(frozen=True)
class Reading:
    """What a name says.

    Attributes:
        quantity: of a channel, or the condition of a load; "" where nothing is known, or it is none that is used.
        unit: None where it says none.
        score: how sure and how direct; the best of several columns of one quantity is taken.
        words: of the name.
        unfit: the unit that it says and that is none of its quantity; "" where there is none.
    """

    quantity: str
    unit: Unit | None
    score: float
    words: frozenset[str]
    unfit: str = ""


def read_name(name: str) -> Reading:
    """What the name of a column says of it."""
    if name in _OF_CHANNEL:
        return Reading(
            _OF_CHANNEL[name], unit_named(CHANNELS[name].unit) if name in CHANNELS else None, 10.0, frozenset()
        )
    base, unit, clear = _unit(name[:LOOKED_AT])
    told = unit if clear else None
    words = _present(_words(base), told)
    if unit is not None and unit.si == "kg" and is_weight(words):
        return Reading(LOAD, unit, _score(words, unit, LOAD), words)
    quantity, unfit = _quantity(words, told), ""
    if unit is not None and quantity and unit.si not in UNITS_OF.get(quantity, (unit.si,)):
        if is_named_by(words, quantity) or unit.si == "1":
            # "theta_m" is no length; what "torque [%]" is has to be asked
            unfit, unit = unit.name if clear else "", None
        else:
            quantity = ""
    if not quantity and unit is not None and not words & ERROR:
        quantity = BY_UNIT.get(unit.si, "")
    quantity = _told_apart(quantity, words)
    return Reading(quantity, unit, _score(words, unit, quantity) - 1.0 * bool(unfit), words, unfit)


def _unit(name: str) -> tuple[str, Unit | None, bool]:
    """The name without its unit, the unit, and whether it is clearly one: a letter at the end may be anything."""
    text = unicodedata.normalize("NFKC", name).strip()
    if match := _BRACKET.match(text):
        unit = unit_named(match["unit"])
        return match["base"] or text, unit, True
    for sign in ("/", ",", " in "):
        for place in (index for index in range(1, len(text)) if text.startswith(sign, index)):
            unit = unit_named(text[place + len(sign) :])
            if unit is not None and text[:place].strip():
                return text[:place], unit, True
    parts = re.split(r"[_ .]", text)
    for count in (3, 2, 1):
        if len(parts) > count and (unit := unit_named("_".join(parts[-count:]))):
            return "_".join(parts[:-count]), unit, not (len(parts[-1]) == count == 1 and parts[-1].isalnum())
    return text, unit_named(text) if len(text) > 1 else None, True


def _words(base: str) -> frozenset[str]:
    plain = base.replace("τ", " tau ").replace("θ", " theta ").replace("ω", " omega ").replace("φ", " phi ")
    return frozenset(word.lower() for word in _WORD.findall(plain) if not word.isdigit())


def _present(words: frozenset[str], unit: Unit | None) -> frozenset[str]:
    """The words, "present" for a "current" that is no ampere: "current position". ("current q" is one of a motor.)"""
    longer = {word for word in words if len(word) > 1}
    motion = unit is not None and not unit.counts and BY_UNIT.get(unit.si) in MOTION
    if words & PRESENT and (motion or any(longer & known for quantity, known in WORDS if quantity in MOTION)):
        return words - PRESENT | {"present"}
    return words


def _quantity(words: frozenset[str], unit: Unit | None) -> str:
    """The quantity of some words: the first that has the unit that is told, else the first."""
    if words & ERROR:
        return ""
    found = [quantity for quantity, known in WORDS if words & known]
    fitting = [quantity for quantity in found if unit is not None and unit.si in UNITS_OF.get(quantity, ())]
    return next(iter(fitting or found), "") or _compound(words)


def _compound(words: frozenset[str]) -> str:
    """Of a word that is made of several, as German ones are: "motordrehzahl", "antriebsmoment"."""
    for quantity, known in WORDS:
        endings = [one for one in known if len(one) > 4]
        if any(word.endswith(ending) for word in words for ending in endings):
            return quantity
    return ""


def is_named_by(words: frozenset[str], quantity: str) -> bool:
    """Whether a word names a quantity, and not only a letter or two."""
    known = next((known for name, known in WORDS if name == quantity), frozenset())
    return any(len(word) > 2 and word in known for word in words)


def _told_apart(quantity: str, words: frozenset[str]) -> str:
    """Set points apart from what is measured, and torque sensors apart from the torque of the motor."""
    wanted = bool(words & TARGET) or any(word.startswith("soll") for word in words)
    if wanted:
        return {"position": "target", "": "target", "current": "current_command", "torque": "torque"}.get(quantity, "")
    if quantity == "torque" and words & SENSOR and not words & DRIVE:
        return "load_torque"
    return quantity if quantity in UNITS_OF else ""


def _score(words: frozenset[str], unit: Unit | None, quantity: str) -> float:
    score = 2.0 * (unit is not None) + 2.0 * bool(words & MEASURED) - 1.0 * bool(words & DERIVED)
    score += 0.5 * bool(words & JOINT_SIDE)
    if quantity == "current":
        score -= 5.0 * bool(words & (OTHER_AXIS | dict(WORDS)["supply"]))
    if quantity == "torque" and words & TARGET:
        score -= 3.0
    return score


def is_weight(words: frozenset[str]) -> bool:
    """Whether words name what was hung on the joint, and no mass of its own."""
    return bool(words & WEIGHT) and not words & (OWN_MASS | TARGET | ERROR)


def same_kind(names: Sequence[str]) -> bool:
    """Whether names differ by a number alone, as columns of several joints do."""
    return len({re.sub(r"\d+", "#", name) for name in names}) == 1 and len(names) > 1
