"""Which column of a table becomes which channel."""

import difflib
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from bench.recording_set.conditions import KNOWN, OTHER_UNITS, TEXTS
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.mapping import SPEED_UNITS, Column, ConditionColumn, Mapping
from bench.recording_set.units import ENDINGS, UNITS
from compensator.lab.recordings.recording import CHANNELS, EVENT_COLUMN

MASTER = "master_"
# what names of columns end in that are not SI
_SUFFIXES = (
    "deg_s", "mrad_s", "rpm", "mm_s", "n_mm", "mn_m", "kn", "mn", "deg", "mrad", "turn", "rev", "mm", "um", "ma", "mv",
    "ms", "us", "ns", "percent", "pct",
)  # fmt: skip
_UNITS = {suffix: UNITS[suffix.replace("_s", "/s").replace("_", "")] for suffix in _SUFFIXES}
TIME = "time_s"


def suggestion(name: str) -> str:
    """A sentence for a column that is no channel: a conversion, or the nearest names; "" where nothing is near."""
    lower = name.lower()
    if lower in KNOWN or lower in OTHER_UNITS:
        condition = lower if lower in KNOWN else OTHER_UNITS[lower][0]
        unit_told = "" if lower in KNOWN else f', unit = "{lower.rpartition("_")[2]}"'
        how = f'conditions.{condition} = {{ from = "{name}"{unit_told} }}'
        return f"{condition} is a condition of the whole trial; take it from the column with a mapping: {how}"
    for suffix, unit in _UNITS.items():
        channel = lower.removesuffix(f"_{suffix}") + ENDINGS[unit.si]
        if lower.endswith(f"_{suffix}") and channel in CHANNELS:
            entry = f'columns.{channel} = {{ from = "{name}", scale = {unit.factor:.10g} }}'
            return f"{channel} is known; convert with a mapping: {entry}"
    # the other joint of a pair is meant only where its name is in it
    known = [channel for channel in CHANNELS if channel.startswith(MASTER) == lower.startswith(MASTER)]
    near = [channel for channel in known if channel in lower or channel.startswith(f"{lower}_")]
    near += difflib.get_close_matches(lower, known, n=2, cutoff=0.7)
    if not near:
        return ""
    names = " or ".join(dict.fromkeys(near))
    return f'is {names} meant? Then rename it, or use a mapping: columns.{near[0]} = {{ from = "{name}" }}'


class Headed(Protocol):
    """A table with named columns, of any format."""

    @property
    def header(self) -> list[str]:
        """The names of the columns."""

    @property
    def header_line(self) -> int | None:
        """The line in which they stand; None where the format has no lines."""

    def error(self, message: str, line: int | None = None, column: str | None = None) -> RecordingSetError:
        """An error that names the file."""


@dataclass(frozen=True)
class Plan:
    """What is read of a table, and what becomes of it.

    Attributes:
        channels: channel -> the columns that it comes from; without constants and without the event.
        events: the column of events; None where there is none.
        conditions: condition -> the column that holds it.
    """

    channels: dict[str, Column]
    events: str | None
    conditions: dict[str, ConditionColumn] = field(default_factory=dict)

    @property
    def numbers(self) -> list[str]:
        """Columns of numbers."""
        held = [one.source for name, one in self.conditions.items() if name not in TEXTS]
        return _unique([*(name for one in self.channels.values() if not one.is_stamp for name in one.read), *held])

    @property
    def texts(self) -> list[str]:
        """Columns of text: dates and times, and conditions in words."""
        held = [one.source for name, one in self.conditions.items() if name in TEXTS]
        return _unique([*(name for one in self.channels.values() if one.is_stamp for name in one.sources), *held])


def _unique(names: Sequence[str]) -> list[str]:
    return list(dict.fromkeys(names))


def plan(table: Headed, mapping: Mapping) -> Plan:
    """The use of each wanted column.

    Raises:
        RecordingSetError: a column that is no channel, nor mapped, nor ignored; no time; nothing but time.
    """
    _check_known(table, mapping)
    mapped = {name: one for name, one in mapping.columns.items() if all(each in table.header for each in one.read)}
    _check_clash(table, mapped, mapping)
    taken = {name for one in mapped.values() for name in one.sources}
    unwanted = taken.union(() if mapping.ignore == "rest" else mapping.ignore)
    own = [name for name in table.header if _is_known(name) and name not in unwanted]
    channels = {name: Column(source=name) for name in own} | mapped
    if mapping.rate_hz is not None:
        channels.pop(TIME, None)
    events = channels.pop(EVENT_COLUMN, None)
    if mapping.rate_hz is None and TIME not in channels:
        there = ", ".join(table.header)
        message = f"has no column time_s, and none is mapped to it; it has {there}. Map one, or say rate_hz"
        raise table.error(message, table.header_line)
    if not set(channels) - {TIME}:
        message = "has no channel but time_s; wanted a position and what drives it as well"
        raise table.error(message, table.header_line)
    if mapping.position_from_speed and not set(SPEED_UNITS) & set(channels):
        raise table.error("has no speed that position_from_speed could integrate; map a velocity", table.header_line)
    held = {name: one for name, one in mapping.conditions.items() if one.source in table.header}
    return Plan(channels, events.sources[0] if events else None, held)


def _check_known(table: Headed, mapping: Mapping) -> None:
    wanted = {name for column in mapping.columns.values() for name in column.read}
    wanted |= {column.source for column in mapping.conditions.values()}
    unknown = [
        name for name in table.header if not _is_known(name) and name not in wanted and not mapping.ignores(name)
    ]
    if not unknown:
        return
    first = unknown[0]
    sign = next((sign for sign in ";\t|" if sign in first), None)
    if len(table.header) == 1 and sign is not None:
        entry = json.dumps(sign)
        message = f"is the only column; is the delimiter another sign? Then say so in a mapping: delimiter = {entry}"
        raise table.error(message, table.header_line, first)
    if len(table.header) == 1:
        message = "is the only column; wanted a table of a time, a position and what drives it. Is this a recording?"
        raise table.error(message, table.header_line, first)
    parts = ["is no known channel", *filter(None, [suggestion(first)])]
    if len(unknown) > 1:
        parts.append(f"Not known either: {', '.join(unknown[1:])}")
    parts.append(f"Known: {', '.join([*CHANNELS, EVENT_COLUMN])}. Map or ignore the column in a mapping file")
    parts.append("`friction-bench import --guess` writes one; a set may bring it along as mapping.toml")
    raise table.error(". ".join(parts), table.header_line, first)


def _check_clash(table: Headed, mapped: dict[str, Column], mapping: Mapping) -> None:
    for channel, column in mapped.items():
        if channel in table.header and channel not in column.sources and not mapping.ignores(channel):
            raise table.error(
                f"is a column, and is mapped from '{column.sources[0]}' too; ignore the column, or leave the mapping "
                "out",
                table.header_line,
                channel,
            )


def _is_known(name: str) -> bool:
    return name in CHANNELS or name == EVENT_COLUMN
