"""Draws a plant with mechanisms hidden in it."""

from dataclasses import dataclass

import numpy as np

from sim_backend.challenge.joint import Joint, Tables, draw_joint
from sim_backend.challenge.mechanisms import MECHANISMS, Mechanism
from sim_backend.challenge.ranges import DATA_SHEET, GEAR_SHEET

SENSOR_SHARE = 0.5  # of the drives that measure their current


@dataclass(frozen=True)
class Hidden:
    """A mechanism of a drawn plant.

    Attributes:
        name: of `mechanisms.MECHANISMS`; title: in words.
        size: how much of it; `measure` says of what, in `unit`.
        tables: plant parameters that make it.
    """

    name: str
    title: str
    size: float
    measure: str
    unit: str
    tables: Tables


@dataclass(frozen=True)
class DrawnPlant:
    """A plant and what is hidden in it.

    Attributes:
        joint: drawn, nothing hidden in it.
        sheet: how far the owner's value of a quantity is from the true one, as a share of it.
    """

    joint: Joint
    hidden: tuple[Hidden, ...]
    sheet: dict[str, float]

    def tables(self, without: str | None = None) -> Tables:
        """Plant parameters, complete; with one of the hidden mechanisms left out where it is named."""
        kept = [hidden.tables for hidden in self.hidden if hidden.name != without]
        return merged(self.joint.tables, *kept)


@dataclass(frozen=True)
class Wanted:
    """What to draw.

    Attributes:
        count: of mechanisms, 0 .. 2.
        sizes: the part of each mechanism's range that its size comes from, as shares of it (log).
        noise: standard deviation of the current measurement, as a share of the peak current.
        names: that mechanisms are drawn from; None: all.
        scale: of the sizes that are drawn: the same joint with more or less of what it hides.
    """

    count: int
    sizes: tuple[float, float] = (0.0, 1.0)
    noise: float = 0.002
    names: tuple[str, ...] | None = None
    scale: float = 1.0


def draw_plant(seed: int, wanted: Wanted) -> DrawnPlant:
    """Draw joint, mechanisms and data sheet, each from a stream of its own: a joint looks alike whatever it hides."""
    joints, choices, sheets, gears = np.random.SeedSequence(seed).spawn(4)
    joint = draw_joint(np.random.default_rng(joints))
    hidden = draw_hidden(joint, wanted, np.random.default_rng(choices))
    sheet = np.random.default_rng(sheets)
    tolerance = {name: range_.draw(sheet) for name, range_ in DATA_SHEET.items()}
    gear = np.random.default_rng(gears)
    tolerance |= {name: range_.draw(gear) for name, range_ in GEAR_SHEET.items()}
    measures = bool(sheet.random() < SENSOR_SHARE)
    for one in hidden:
        asked = MECHANISMS[one.name].current
        measures = measures if asked is None else asked
    sensor = {"present": measures, "noise_a": wanted.noise * joint.peak_a, "resolution_a": joint.peak_a / 2000.0}
    equipped = Joint(**{**vars(joint), "tables": merged(joint.tables, {"current_sensor": sensor})})
    return DrawnPlant(equipped, hidden, tolerance)


def draw_hidden(joint: Joint, wanted: Wanted, random: np.random.Generator) -> tuple[Hidden, ...]:
    """Draw mechanisms for a joint; two of them can be there together."""
    names = list(wanted.names or MECHANISMS)
    found: list[Mechanism] = []
    while len(found) < wanted.count:
        mechanism = MECHANISMS[names[int(random.integers(len(names)))]]
        if mechanism not in found and all(_agree(mechanism, other) for other in found):
            found.append(mechanism)
    low, high = wanted.sizes
    return tuple(
        hide(one, wanted.scale * one.size.at(float(random.uniform(low, high))), joint, random) for one in found
    )


def hide(mechanism: Mechanism, size: float, joint: Joint, random: np.random.Generator) -> Hidden:
    """Return a mechanism of a size, made for a joint."""
    tables = mechanism.make(size, joint, random)
    return Hidden(mechanism.name, mechanism.title, size, mechanism.measure, mechanism.size.unit, tables)


def merged(*parts: Tables) -> Tables:
    """Return plant tables laid over each other, later ones on top."""
    found: Tables = {}
    for part in parts:
        for name, table in part.items():
            found[name] = {**found.get(name, {}), **table}
    return found


def _agree(one: Mechanism, other: Mechanism) -> bool:
    """Tell whether both can show with one and the same drive."""
    return None in (one.current, other.current) or one.current == other.current
