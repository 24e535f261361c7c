"""`trials.csv`: one row per trial: file, kind, conditions, free tags."""

from collections.abc import Sequence
from dataclasses import dataclass

from bench.recording_set.conditions import RESERVED, condition_problem
from bench.recording_set.container import check_name
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats.registry import BINARY_ENDINGS
from bench.recording_set.mapping import Mapping, Renamed
from bench.recording_set.text import values
from bench.recording_set.text.table import Row, Table, quoted
from compensator.lab.recordings.recording import Condition

TRIALS_FILE = "trials.csv"
DEFAULT_KIND = "recording"
TEXT_ENDINGS = (".csv", ".tsv", ".txt", ".dat", ".asc", ".log")
ENDINGS = (*TEXT_ENDINGS, *BINARY_ENDINGS)


@dataclass(frozen=True)
class TrialEntry:
    """A trial of a set, before its CSV is read.

    Attributes:
        rows: how many rows its CSV has; None where it is not said.
        line: where it stands in trials.csv; None where there is none.
    """

    file: str
    name: str
    kind: str
    conditions: dict[str, Condition]
    rows: int | None = None
    line: int | None = None


def name_of(file: str) -> str:
    """The name of a trial without a name of its own: its file, without the ending."""
    stem, point, ending = file.rpartition(".")
    return stem if point and stem and f".{ending.lower()}" in ENDINGS else file


def read_trials_csv(table: Table, mapping: Mapping) -> list[TrialEntry]:
    """The trials that a set names, in its order.

    Raises:
        RecordingSetError: no column `file`, a file named twice or outside the set, a count that is no number.
    """
    places = _places(table, mapping)
    entries: list[TrialEntry] = []
    for chunk in table.chunks():
        for line, cells in chunk.records(len(table.header)):
            entries.append(_entry(table, line, cells, places, mapping))
    if not entries:
        raise table.error("names no trial; wanted one row per trial below the header")
    _check_once(table, entries)
    return entries


def trials_csv_lines(entries: Sequence[TrialEntry]) -> list[str]:
    """The lines of a trials.csv; `name` only where a file could not be called so.

    Raises:
        RecordingSetError: a condition whose name cannot be a column.
    """
    keys = list(dict.fromkeys(key for entry in entries for key in entry.conditions))
    for key in keys:
        if key in RESERVED or key != key.strip() or not key or not key.isprintable():
            raise RecordingSetError(TRIALS_FILE, f"a condition cannot be called {key!r}; rename it")
    named = ["name"] if any(entry.name != name_of(entry.file) for entry in entries) else []
    lines = [["file", *named, "kind", *map(values.shield, keys), "rows"]]
    for entry in entries:
        conditions = [values.write(entry.conditions.get(key)) for key in keys]
        names = [values.shield(entry.name) for _ in named]
        lines.append([entry.file, *names, values.shield(entry.kind), *conditions, str(entry.rows)])
    return [",".join(map(quoted, line)) + "\n" for line in lines]


def _places(table: Table, mapping: Mapping) -> dict[str, tuple[int, Renamed]]:
    """Where each column comes from: its index, and the conversion."""
    renamed = {name: column for name in mapping.trials_columns if (column := mapping.trials_column(name))}
    for name, column in renamed.items():
        if column.source not in table.header:
            message = f"the mapping takes '{name}' from a column '{column.source}', which is not there; it has "
            raise RecordingSetError(table.place, message + ", ".join(table.header), 1)
        if name in table.header and column.source != name:
            raise RecordingSetError(table.place, f"is a column, and is mapped from '{column.source}' too", 1, name)
    moved = {column.source for name, column in renamed.items() if name != "kind"}
    kept = {name: Renamed(source=name) for name in table.header if name not in moved}
    if "file" not in kept | renamed:
        message = f"has no column 'file'; it has {', '.join(table.header)}. Name it in a mapping: [trials_columns]"
        raise RecordingSetError(table.place, message, 1)
    return {name: (table.header.index(column.source), column) for name, column in (kept | renamed).items()}


def _entry(table: Table, line: int, cells: Row, places: dict[str, tuple[int, Renamed]], mapping: Mapping) -> TrialEntry:
    text = {name: cells[index] for name, (index, _) in places.items()}
    file = text["file"].strip()
    check_name(file, table.place, line, "file")
    conditions: dict[str, Condition] = {}
    for name, (_, column) in places.items():
        value = values.parse(text[name], table.dialect.decimal)
        if name not in RESERVED and not (name in mapping.ignore and mapping.ignore != "rest") and value is not None:
            conditions[values.unshield(name)] = _checked(
                table, line, name, _converted(table, line, value, column), column
            )
    name = values.unshield(text.get("name", "")) or name_of(file)
    rows = _rows(table, line, values.parse(text.get("rows", "")))
    return TrialEntry(file, name, values.unshield(text.get("kind", DEFAULT_KIND)), conditions, rows, line)


def _checked(table: Table, line: int, name: str, value: Condition, column: Renamed) -> Condition:
    if problem := condition_problem(name, value):
        raise RecordingSetError(table.place, problem, line, column.source)
    return value


def _converted(table: Table, line: int, value: Condition, column: Renamed) -> Condition:
    if column.scale == 1.0 and column.offset == 0.0:
        return value
    if isinstance(value, (str, bool)):
        raise RecordingSetError(table.place, f"found '{value}'; wanted a number to convert", line, column.source)
    return value * column.scale + column.offset


def _rows(table: Table, line: int, value: Condition | None) -> int | None:
    if value is None:
        return None
    if isinstance(value, (str, bool)) or value < 0 or value != int(value):
        raise RecordingSetError(table.place, f"found '{value}'; wanted the number of rows", line, "rows")
    return int(value)


def _check_once(table: Table, entries: Sequence[TrialEntry]) -> None:
    for column, names in (("file", [entry.file for entry in entries]), ("name", [entry.name for entry in entries])):
        seen: dict[str, int | None] = {}
        for entry, name in zip(entries, names, strict=True):
            if name in seen:
                message = f"'{name}' is named in line {seen[name]} already; wanted each trial once"
                raise RecordingSetError(table.place, message, entry.line, column)
            seen[name] = entry.line
