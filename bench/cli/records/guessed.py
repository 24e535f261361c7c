"""What `import --guess` and `explain` print of unknown files, and the options with which a user answers."""

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.output import FileError, refuse_taken, remark, say, table, write_whole

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.config.rig import Rig
    from bench.recording_set import RecordingSet
    from bench.recording_set.guess import Guess, Known
    from bench.store import Store

Take = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=QUANTITY[UNIT]", help="What a column is, such as pos=position[deg] or mark=ignore; repeatable."
    ),
]
CountsPerTurn = Annotated[float | None, typer.Option(min=0, help="Counts per turn of the joint, of columns in counts.")]
RateHz = Annotated[float | None, typer.Option(min=0, help="Samples a second, where no column is a time.")]
SupplyV = Annotated[float | None, typer.Option(help="Supply voltage [V], where no column holds it.")]
_BARS = "▁▂▃▄▅▆▇█"
_BAR_COUNT = 24


def known_of(
    take: list[str] | None, counts_per_turn: float | None, rate_hz: float | None, supply_v: float | None
) -> "Known":
    """The answers of a user."""
    from bench.recording_set.guess import Known, read_said

    return Known(read_said(take or []), counts_per_turn or None, rate_hz or None, supply_v)


def show(guess: "Guess", notes: tuple[str, ...]) -> None:
    """A guess: how the files were read, what each column is taken for, and what is asked."""
    for note in notes:
        say(note)
    rows = [
        (one.column, one.channel or "-", one.unit, one.low, one.high, _picture(one.outline), one.why)
        for one in guess.taken
    ]
    table("Columns", ["column", "taken for", "in", "from#", "to#", "over time", "because"], rows)
    for note in guess.notes:
        say(note)


def write_guess(guess: "Guess", rig: "Rig | None", mapping_file: Path, rig_file: Path) -> None:
    """The mapping as a file, and the rig where the files have none: both, or neither.

    Raises:
        FileError: a place is taken or cannot be written, or both files would have one name.
    """
    from bench.recording_set.guess import mapping_text, rig_text

    if rig is not None and mapping_file == rig_file:
        raise FileError(f"{mapping_file}: the rig is written there; name another file with --mapping")
    refuse_taken(mapping_file, "name another file with --mapping")
    if rig is not None:
        refuse_taken(rig_file, f"use it, --rig {rig_file}")
    head = ("written by friction-bench import --guess; read it before you use it", *guess.notes)
    write_whole(mapping_file, [mapping_text(guess.mapping, head, guess.files).encode()])
    say(f"written: {mapping_file}")
    if rig is not None:
        write_whole(rig_file, [rig_text(rig).encode()])
        say(f"written: {rig_file}; add what is known of motor, gear and arm")


def remark_imported_before(store: "Store", recordings: "RecordingSet") -> None:
    """Say, on stderr, which experiment has these recordings already."""
    from bench.recording_set import imported_before

    for note in imported_before(store, recordings):
        remark(note)


def remark_mapping_beside(paths: Sequence[Path]) -> None:
    """Say, on stderr, that a mapping which lies here or beside them is not used; a folder brings its own along."""
    beside = [folder / "mapping.toml" for folder in (Path(), paths[0].parent)]
    found = next((one for one in beside if one.exists()), None)
    if found and not any((one / "mapping.toml").exists() for one in paths):
        remark(f"{found} is not used; where it is of these files, add: --mapping {shlex.quote(str(found))}")


def _picture(outline: tuple[float, ...]) -> str:
    """A row of bars: the values over time, from lowest to highest."""
    step = max(1, len(outline) // _BAR_COUNT)
    values = outline[::step][:_BAR_COUNT]
    low, high = min(values, default=0.0), max(values, default=0.0)
    if high <= low:
        return _BARS[0] * len(values)
    return "".join(_BARS[round((value - low) / (high - low) * (len(_BARS) - 1))] for value in values)
