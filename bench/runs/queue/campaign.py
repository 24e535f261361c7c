"""A campaign: one kind of experiment over a grid of parameters, as items in an order that spares the person."""

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from bench.config.configuration import BenchConfiguration
from bench.config.toml_text import read_toml
from bench.config.validation import problems
from bench.control.drive_factory import has_hardware
from bench.errors import ConfigurationError, ParameterError
from bench.json_types import Json
from bench.runs.bench_control import Pace
from bench.runs.queue.items import HANG_S, checked_item, fewest_changes, load_changes
from bench.store.tables.queue import NewItem
from bench.store.tables.tags import LONGEST_TAG, MOST_TAGS

MOST_ITEMS = 1000
LOADS = ("load_kg", "loads_kg")


class Campaign(BaseModel):
    """Experiments over every combination of some parameters."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        allow_inf_nan=False,
        json_schema_extra={
            "examples": [
                {
                    "name": "friction over load and speed",
                    "kind": "reversals",
                    "parameters": {"strokes": 4},
                    "grid": {"load_kg": [0.0, 0.05, 0.1], "speed_rad_s": [0.5, 1.0, 2.0]},
                    "repeats": 2,
                    "order": "random",
                    "seed": 7,
                    "tags": ["winter"],
                }
            ]
        },
    )
    name: str = Field(min_length=1, max_length=200)
    kind: str = Field(max_length=100, description="name from GET /experiment-kinds")
    parameters: Json = Field(default={}, description="parameters that all share")
    grid: dict[str, list[Any]] = Field(
        default={}, description="parameters that differ: name -> values; every combination is run"
    )
    repeats: int = Field(default=1, ge=1, le=1000, description="experiments of each combination")
    order: Literal["as-given", "random", "boustrophedon"] = Field(
        default="as-given",
        description="as-given: the last parameter of the grid changes fastest; random: shuffled by `seed`; "
        "boustrophedon: there and back, so that neighbours differ in one step. Loads are changed as seldom as "
        "possible in each",
    )
    seed: int = Field(default=1, ge=0, le=2**31, description="of order 'random'")
    operator: str = Field(default="", max_length=200)
    note: str = Field(default="", max_length=2000)
    tags: list[str] = Field(default=[], max_length=MOST_TAGS, description=f"each 1 .. {LONGEST_TAG} characters")
    pace: Pace | None = Field(default=None, description="as for POST /experiments")

    @model_validator(mode="after")
    def _check_grid(self) -> Self:
        both = sorted(set(self.grid) & set(self.parameters))
        if both:
            raise ValueError(f"{', '.join(both)} stands in grid and in parameters; leave it in one of them")
        empty = sorted(name for name, values in self.grid.items() if not values)
        if empty:
            raise ValueError(f"grid.{empty[0]} has no values; give one or more")
        if (count := self.count) > MOST_ITEMS:
            raise ValueError(f"{count} experiments; allowed are {MOST_ITEMS}. Make several campaigns")
        return self

    @property
    def count(self) -> int:
        """Of its experiments."""
        count = self.repeats
        for values in self.grid.values():
            count *= len(values)
        return count


@dataclass(frozen=True, slots=True)
class CampaignPlan:
    """What a campaign comes to.

    Attributes:
        items: in the order in which they are run.
        duration_s: estimate of the whole, the hanging of loads included.
        load_changes: how often something else has to be hung, the first load included.
    """

    items: list[NewItem]
    duration_s: float
    load_changes: int


def plan_campaign(campaign: Campaign, configuration: BenchConfiguration) -> CampaignPlan:
    """Check every experiment, and put them in order. Nothing is kept or moved.

    Raises:
        UnknownKindError, ParameterError, LimitError, ConfigurationError: naming the combination that is refused.
    """
    items = [_item(campaign, chosen, configuration) for chosen in _combinations(campaign)]
    ordered = fewest_changes(items)
    changes = load_changes(ordered)
    hanging_s = HANG_S * changes if has_hardware(configuration) else 0.0
    return CampaignPlan(ordered, sum(item.duration_s for item in ordered) + hanging_s, changes)


def _item(campaign: Campaign, chosen: Json, configuration: BenchConfiguration) -> NewItem:
    order = NewItem(
        campaign.kind, {**campaign.parameters, **chosen}, campaign.operator, campaign.note, campaign.tags, campaign.pace
    )
    try:
        return checked_item(order, configuration)
    except ParameterError as error:
        where = ", ".join(f"{name} = {value}" for name, value in chosen.items())
        raise ParameterError(f"campaign '{campaign.name}'{f', at {where}' if where else ''}: {error}") from error


def _combinations(campaign: Campaign) -> list[Json]:
    """Every combination, each as often as it is repeated, in the wanted order; loads change slowest."""
    names = sorted(campaign.grid, key=lambda name: name not in LOADS)
    axes = [campaign.grid[name] for name in names]
    snake = campaign.order == "boustrophedon"
    found: list[Json] = [
        dict(zip(names, values, strict=True)) for values in _product(axes, snake) for _ in range(campaign.repeats)
    ]
    if campaign.order == "random":
        random.Random(campaign.seed).shuffle(found)  # noqa: S311  an order, no secret
    return found


def _product(axes: Sequence[Sequence[Any]], snake: bool) -> Iterator[tuple[Any, ...]]:
    """All combinations, the last axis fastest; a snake turns round at each end."""
    if not axes:
        yield ()
        return
    for index, value in enumerate(axes[0]):
        rest = list(_product(axes[1:], snake))
        for chosen in reversed(rest) if snake and index % 2 else rest:
            yield (value, *chosen)


def read_campaign(path: Path) -> Campaign:
    """Read a campaign; without a name it has that of its file.

    Raises:
        ConfigurationError: naming the file, each key, what was found and what is wanted.
    """
    values = read_toml(path)
    try:
        return Campaign.model_validate({"name": path.stem} | values)
    except ValidationError as error:
        raise ConfigurationError(
            "\n".join(f"{path}: {problem}" for problem in problems(error, model=Campaign))
        ) from error
