"""The events of a row in one cell: "name: detail", several with "; " between them.

What cannot be written so (a time between two rows, a detail with "; " in it) is written as JSON,
[[time_s, name, detail], ...], and both forms are read. A cell that a spreadsheet would run as a formula
gets an apostrophe before it, see `values.py`.
"""

import json
from collections.abc import Sequence

from bench.recording_set.text.values import shield, unshield
from compensator.lab.recordings.recording import Event

BETWEEN = "; "
BEFORE_DETAIL = ": "


def encode(events: Sequence[Event], time_s: float) -> str:
    """The cell for the events of a row at a time [s]; "" for none."""
    cell = shield(BETWEEN.join(event.name + (BEFORE_DETAIL + event.detail if event.detail else "") for event in events))
    if decode(cell, time_s) == list(events):
        return cell
    return json.dumps([list(event) for event in events], ensure_ascii=False)


def decode(cell: str, time_s: float) -> list[Event]:
    """The events of a cell in a row at a time [s]. Any text is an event's name."""
    if cell.startswith("[["):
        try:
            return [Event(float(time), str(name), str(detail)) for time, name, detail in json.loads(cell)]
        except (ValueError, TypeError):
            pass  # somebody's own text, which happens to begin so
    if not cell.strip():
        return []
    pairs = (part.partition(BEFORE_DETAIL) for part in unshield(cell).split(BETWEEN))
    return [Event(time_s, name, detail) for name, _, detail in pairs]
