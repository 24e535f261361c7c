"""An item of the queue: checked before it is taken in, as a start would be."""

from dataclasses import dataclass, field
from itertools import groupby

from bench.config.configuration import BenchConfiguration
from bench.experiments.registry import find_kind, parse_parameters
from bench.json_types import Json
from bench.runs.runner import Pace
from bench.store.tables.queue import NewItem
from bench.store.tables.tags import checked


@dataclass(frozen=True, slots=True)
class Order:
    """What a user asks for.

    Attributes:
        kind, parameters: as `Runner.start` takes them.
        operator, note, tags: given to the experiment.
        pace: of the experiment; None: as a start without one.
    """

    kind: str
    parameters: Json
    operator: str = ""
    note: str = ""
    tags: list[str] = field(default_factory=list)
    pace: Pace | None = None


def checked_item(order: Order, configuration: BenchConfiguration) -> NewItem:
    """An order as an item, with what it takes.

    Raises:
        UnknownKindError, ParameterError, LimitError, ConfigurationError: as a start would.
        StoreValueError: a tag that cannot be kept.
    """
    kind = find_kind(order.kind)
    parameters = parse_parameters(kind, order.parameters)
    kind.refuse(parameters, configuration)
    loads = [(plan.load_kg, plan.balanced) for plan in kind.plan(parameters, configuration)]
    return NewItem(
        kind=order.kind,
        parameters=order.parameters,
        operator=order.operator,
        note=order.note,
        tags=checked(order.tags),
        pace=order.pace,
        duration_s=kind.duration_s(parameters, configuration),
        loads=[list(load) for load, _ in groupby(loads)],
    )
