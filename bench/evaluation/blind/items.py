"""What is asked of the lab: families of items, and how each is drawn. The same seed draws the same items."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.errors import ParameterError
from bench.evaluation.blind.memory_protocol import memory_protocol
from bench.evaluation.challenge.hidden_plant import MECHANISMS, DrawnPlant, Wanted, draw_plant
from bench.evaluation.challenge.names import ABSORBED, ACCEPTED, accepted
from bench.evaluation.challenge.session import Protocol
from bench.json_types import Value

MEMORY = ("bristle", "backlash", "dwell", "shaft")
OUTSIDE = tuple(name for name, names in ACCEPTED.items() if not names)
SINGLE = tuple(name for name in ACCEPTED if name not in (*MEMORY, *OUTSIDE, *ABSORBED, "latency"))
SIZES = (-0.7, 1.0)  # share of the range: down to what no data of this length can show
LARGE = (0.3, 1.0)
NOISES = (0.002, 0.005, 0.02)  # of the current measurement, as a share of the peak current
MODERATE = (0.3, 1.0)  # of r: where something outside the catalogue is small enough to be mistaken or passed over
DURATION_S = 6.0
PERIOD_S = 0.01


@dataclass(frozen=True)
class Family:
    """A kind of item.

    Attributes:
        name: as in the table of results.
        per_plant: how many for each plant asked for.
        names: mechanisms that are drawn from.
        count: how many are hidden.
        sizes: part of each one's range, as shares of it (log).
        ratios: r of what is hidden, drawn from here (log), by scaling its size; None: it is what the size makes it.
        memory: recorded by motions that show what happens at rest and at reversals.
        imperfect: late, jittered and lossy recordings.
        withheld: asked once more, as if the catalogue had no name for what is hidden.
        settled: recorded in a few trials; then the lab's own suggestions are recorded too.
    """

    name: str
    per_plant: int
    names: tuple[str, ...]
    count: int
    sizes: tuple[float, float] = SIZES
    memory: bool = False
    imperfect: bool = False
    settled: bool = False
    ratios: tuple[float, float] | None = None
    withheld: bool = False


FAMILIES: dict[str, Family] = {
    family.name: family
    for family in (
        Family("complete", 2, (), 0),
        Family("imperfect", 1, (), 0, imperfect=True),
        Family("single", 3, SINGLE, 1, withheld=True),
        Family("pair", 3, SINGLE, 2, LARGE),
        Family("outside", 1, OUTSIDE, 1, LARGE),
        Family("memory", 1, MEMORY, 1, LARGE, memory=True),
        Family("settle", 1, SINGLE, 1, LARGE, settled=True),
        Family("at-rest", 1, (), 0, memory=True),
        Family("outside-moderate", 2, OUTSIDE, 1, LARGE, ratios=MODERATE),
    )
}


@dataclass(frozen=True)
class Item:
    """One joint to be diagnosed.

    Attributes:
        key: of the item, in a file of results.
        family: its name.
        seed: that everything of it is drawn from.
        turn: which of its family's mechanisms is hidden: each in turn, so that all come equally often.
    """

    key: str
    family: str
    seed: int
    turn: int


def items_of(seed: int, plants: int, only: Sequence[str] = ()) -> list[Item]:
    """Every item of a run; a longer run begins with the items of a shorter one.

    Args:
        seed: of the run.
        plants: rounds.
        only: families that are asked; all where none is named. Their items are those of a run of all.

    Raises:
        ParameterError: no such family.
    """
    return listed({name: family.per_plant for name, family in FAMILIES.items()}, seed, plants, only)


def listed(
    per_plant: Mapping[str, int],
    seed: int,
    plants: int,
    only: Sequence[str],
    prefix: str = "",
    salt: tuple[int, ...] = (),
) -> list[Item]:
    """As `items_of`, by how many of each family there are for each plant; `salt` tells seeds of two plants apart."""
    for name in only:
        if name not in per_plant:
            raise ParameterError(f"there is no family '{name}' of items; known are {', '.join(per_plant)}")
    found = []
    for plant in range(plants):
        for number, (name, count) in enumerate(per_plant.items()):
            for repeat in range(count if not only or name in only else 0):
                drawn = np.random.SeedSequence((seed, plant, number, repeat, *salt)).generate_state(1)
                key = f"{prefix}{seed}-{plant}-{name}-{repeat}"
                found.append(Item(key, name, int(drawn[0]), plant * count + repeat))
    return found


def draw_item(item: Item, attempt: int, scale: float = 1.0) -> DrawnPlant:
    """The joint of an item; another one at each attempt. `scale` makes what it hides larger or smaller."""
    family = FAMILIES[item.family]
    random = np.random.default_rng((item.seed, attempt))
    noise = float(random.choice(NOISES))
    names: tuple[str, ...] | None = family.names
    if family.count > 1:
        names = tuple(name for name in family.names if accepted(name))
    if family.count == 1:
        names = (family.names[item.turn % len(family.names)],)
    wanted = Wanted(family.count, family.sizes, noise, names or tuple(MECHANISMS), scale)
    return draw_plant(int(random.integers(2**31)), wanted)


def wanted_ratio(item: Item, attempt: int) -> float | None:
    """The r that what is hidden should have; None where the family does not ask for one."""
    ratios = FAMILIES[item.family].ratios
    if ratios is None:
        return None
    return float(np.exp(np.random.default_rng((item.seed, attempt, 2)).uniform(*np.log(ratios))))


def protocol_of(item: Item, heaviest_kg: float, top_rad_s: float, configuration: BenchConfiguration) -> Protocol:
    """What is recorded: three loads and all motions; for memory, what shows rests, starts, reversals and twist."""
    if FAMILIES[item.family].memory:
        return memory_protocol(configuration, heaviest_kg, top_rad_s, DURATION_S)
    loads: dict[str, Value] = {"loads_kg": [0.0, round(0.5 * heaviest_kg, 4), heaviest_kg], "repeats": 1}
    motions = {**loads, "speed_rad_s": round(top_rad_s, 2), "duration_s": DURATION_S}
    if FAMILIES[item.family].settled:
        few: dict[str, Value] = {
            "loads_kg": [0.0, round(0.5 * heaviest_kg, 4)],
            "waveforms": ["slow-sine", "multisine", "triangles"],
        }
        return [("excitation", {**motions, **few})]
    return [("excitation", motions)]
