"""Which column of a CSV becomes which channel."""

import json
from dataclasses import dataclass

from bench.recording_set.mapping import Column, Mapping
from bench.recording_set.text.suggestions import suggestion
from bench.recording_set.text.table import Table
from compensator.lab.recordings.channels import CHANNELS, EVENT_COLUMN
from compensator.lab.recordings.recording import FloatArray


@dataclass(frozen=True)
class Use:
    """A channel, and the column that it comes from."""

    channel: str
    index: int
    source: str
    scale: float = 1.0
    offset: float = 0.0

    def convert(self, values: FloatArray) -> FloatArray:
        """The channel from the column. Without scale and offset not a bit is changed."""
        if self.scale == 1.0 and self.offset == 0.0:
            return values
        return values * self.scale + self.offset


def plan(table: Table, mapping: Mapping) -> tuple[list[Use], int | None]:
    """The use of each wanted column, and the index of the column of events.

    Raises:
        RecordingSetError: a column that is no channel, nor mapped, nor ignored; no time; nothing but time.
    """
    _check_known(table, mapping)
    mapped = {channel: column for channel, column in mapping.columns.items() if column.source in table.header}
    _check_clash(table, mapped, mapping)
    sources = {name: Column(source=name) for name in table.header if _is_known(name) and name not in mapping.ignore}
    uses, events = [], None
    for channel, column in (sources | mapped).items():
        index = table.header.index(column.source)
        if channel == EVENT_COLUMN:
            events = index
        else:
            uses.append(Use(channel, index, column.source, column.scale, column.offset))
    channels = {use.channel for use in uses}
    if "time_s" not in channels:
        raise table.error(f"has no column time_s, and none is mapped to it; it has {', '.join(table.header)}", 1)
    if channels == {"time_s"}:
        raise table.error("has no channel but time_s; wanted a position and what drives it as well", 1)
    return uses, events


def _check_known(table: Table, mapping: Mapping) -> None:
    wanted = {column.source for column in mapping.columns.values()} | set(mapping.ignore)
    unknown = [name for name in table.header if not _is_known(name) and name not in wanted]
    if not unknown:
        return
    first = unknown[0]
    sign = next((sign for sign in ";\t|" if sign in first), None)
    if len(table.header) == 1 and sign is not None:
        entry = json.dumps(sign)
        message = f"is the only column; is the delimiter another sign? Then say so in a mapping: delimiter = {entry}"
        raise table.error(message, 1, first)
    parts = ["is no known channel", *filter(None, [suggestion(first)])]
    if len(unknown) > 1:
        parts.append(f"Not known either: {', '.join(unknown[1:])}")
    parts.append(f"Known: {', '.join([*CHANNELS, EVENT_COLUMN])}. Map or ignore the column in a mapping file")
    raise table.error(". ".join(parts), 1, first)


def _check_clash(table: Table, mapped: dict[str, Column], mapping: Mapping) -> None:
    for channel, column in mapped.items():
        if channel in table.header and column.source != channel and channel not in mapping.ignore:
            raise table.error(
                f"is a column, and is mapped from '{column.source}' too; ignore the column, or leave the mapping out",
                1,
                channel,
            )


def _is_known(name: str) -> bool:
    return name in CHANNELS or name == EVENT_COLUMN
