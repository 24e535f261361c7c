"""Items of the queue: checked before they are taken in, as a start would be; and the order with the fewest loads."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

from bench.config.configuration import BenchConfiguration
from bench.experiments.registry import find_kind, parse_parameters
from bench.store.tables.lab_queue import NewLabItem
from bench.store.tables.queue import NewItem
from bench.store.tables.tags import checked

HANG_S = 60.0  # what a person takes to hang a load, and to say so


def checked_item(order: NewItem, configuration: BenchConfiguration) -> NewItem:
    """What a user asks for, with what it takes.

    Raises:
        UnknownKindError, ParameterError, LimitError, ConfigurationError: as a start would.
        StoreValueError: a tag that cannot be kept.
    """
    kind = find_kind(order.kind)
    parameters = parse_parameters(kind, order.parameters)
    kind.refuse(parameters, configuration)
    loads = [(plan.load_kg, plan.balanced) for plan in kind.plan(parameters, configuration)]
    return replace(
        order,
        tags=checked(order.tags),
        duration_s=kind.duration_s(parameters, configuration),
        loads=[list(load) for load, _ in groupby(loads)],
    )


def known_item(item: NewLabItem) -> NewLabItem:
    """An item for another bench, whose kind and parameters are known; the limits are that bench's to say.

    Raises:
        UnknownKindError, ParameterError: no such kind, or not its parameters.
        StoreValueError: a tag that cannot be kept.
    """
    parse_parameters(find_kind(item.kind), item.parameters)
    return replace(item, tags=checked(item.tags), for_tags=checked(item.for_tags))


def load_changes(items: Sequence[NewItem]) -> int:
    """How often something else has to be hung, the first load included."""
    loads = [load for item in items for load in item.loads]
    return sum(one != before for before, one in zip([None, *loads], loads, strict=False))


def fewest_changes(items: Sequence[NewItem]) -> list[NewItem]:
    """The items, those of one load one after the other; else in the order in which they are.

    After an item comes the first that begins with the load that hangs then, else the first of all. Where each item has
    one load, no order takes fewer changes. Where an item changes loads by itself, another order might.
    """
    left, ordered = list(items), list[NewItem]()
    while left:
        hangs = ordered[-1].loads[-1:] if ordered else []
        index = next((index for index, item in enumerate(left) if item.loads[:1] == hangs), 0)
        ordered.append(left.pop(index))
    return ordered
