"""Files of other benches that were uploaded: read in a process of the lab, whatever they do to whoever reads them.

A process that hangs, or runs out of memory, on a file takes neither STOP nor the control loop with it. What reads
foreign files is imported when the first one comes: the service starts without it.
"""

from dataclasses import asdict
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, Field

from bench.store import Store


class Imported(BaseModel):
    """What an import made."""

    experiment_id: int = Field(description="the experiment under which the trials are kept")
    name: str
    trials: int = Field(description="how many trials came in")
    rows: int = Field(description="how many rows came in, all trials together")
    notes: list[str] = Field(
        description="what is to be known of them: how files were read, what is not told, what is there already",
        examples=[["experiment 4 has the same recordings already; they come in once more"]],
    )


class GuessedColumn(BaseModel):
    """What a column of an unknown file is taken for."""

    column: str = Field(description="its name")
    channel: str = Field(description="channel of the recording, or condition of the trial; empty where it is not used")
    unit: str = Field(description="of the column")
    low: float | None = Field(description="of its values, in that unit; null of text")
    high: float | None
    why: str = Field(description="in words")
    outline: list[float] = Field(description="some of its values over time; empty of text")


EXAMPLE_COLUMN = GuessedColumn(
    column="iq", channel="current_a", unit="mA", low=-830.0, high=790.0, why="its name", outline=[-830.0, 12.0, 790.0]
).model_dump()


class GuessedColumns(BaseModel):
    """What files of an unknown bench may be."""

    joint: Literal["rotary", "linear"] = Field(examples=["rotary"])
    columns: list[GuessedColumn] = Field(examples=[[EXAMPLE_COLUMN]])
    quantities: dict[str, list[str]] = Field(
        description="what a column may be, each with its units; for `take`", examples=[{"position": ["rad", "deg"]}]
    )
    questions: list[str] = Field(
        description="what has to be said first; empty where nothing is left open",
        examples=[["'enc' is in counts: say --counts-per-turn N (of the joint), or --take 'enc=position[deg]'"]],
    )
    notes: list[str] = Field(
        description="how the files were read", examples=[["set/a.csv: columns between ';', decimal comma"]]
    )
    mapping: str = Field(
        description="the text of a mapping.toml", examples=['[columns.current_a]\nfrom = "iq"\nunit = "mA"\n']
    )
    rig: str = Field(description="the text of a rig.toml", examples=['name = "bench 3"\n'])


def guess_upload(
    _store: Store,
    path: Path,
    take: list[str],
    counts_per_turn: float | None,
    rate_hz: float | None,
    supply_v: float | None,
) -> GuessedColumns:
    """What the columns of an upload may be; keeps nothing. Arguments as those of POST /recording-sets/guess.

    Raises:
        RecordingSetError: naming file and column, what was found and what is wanted.
    """
    from bench.recording_set.guess import Known, guess_of, mapping_text, read_said, rig_text
    from bench.recording_set.guess.names import TAKEN
    from bench.recording_set.units import units_of

    guess, rig, notes = guess_of([path], None, Known(read_said(take), counts_per_turn, rate_hz, supply_v))
    return GuessedColumns(
        joint=guess.joint,
        columns=[GuessedColumn(**{**asdict(one), "outline": list(one.outline)}) for one in guess.taken],
        quantities={one: [name for si in units for name in units_of(si)] for one, units in TAKEN.items()},
        questions=list(guess.questions),
        notes=[*notes, *guess.notes],
        mapping=mapping_text(guess.mapping),
        rig=rig_text(rig),
    )


def import_upload(store: Store, path: Path, name: str) -> Imported:
    """An upload as an experiment of the store: all of it, or nothing.

    Raises:
        RecordingSetError: naming file, line and column, what was found and what is wanted.
    """
    from bench.recording_set import import_recording_set, imported_before, read_recording_set

    recording_set = read_recording_set(path, None, None)
    notes = [*recording_set.notes, *imported_before(store, recording_set)]
    experiment_id = import_recording_set(store, recording_set, name)
    rows = sum(len(recording) for recording in recording_set.recordings)
    trials = len(recording_set.recordings)
    return Imported(experiment_id=experiment_id, name=name, trials=trials, rows=rows, notes=notes)
