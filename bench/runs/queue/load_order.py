"""In which order somebody has to hang a load least often."""

from collections.abc import Sequence

from bench.store.tables.queue import NewItem, QueueItem

HANG_S = 60.0  # what a person takes to hang a load, and to say so


def load_changes(items: Sequence[NewItem | QueueItem]) -> int:
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
