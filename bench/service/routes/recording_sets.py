"""/recording-sets: trials of other benches come in. (They leave under /experiments/{id}/recording-set.)"""

import tempfile
from collections.abc import AsyncIterator
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Literal

import anyio
from fastapi import Depends, HTTPException, Query, Request
from pydantic import BaseModel, Field

from bench.service.auth.access import require_token
from bench.service.auth.audit_trail import note
from bench.service.compute import in_worker
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.services import StoreOf
from bench.store import Store

MOST_BYTES = 2 * 1024**3
LONGEST_FILE_NAME = 200  # bytes
router = api_router("/recording-sets", tags=["recording sets"], dependencies=[Depends(require_token)])
ZIP_BODY = {
    "requestBody": {
        "required": True,
        "description": "A zipped recording set: rig.toml, trials.csv, one CSV per trial; SI, the unit in the name.",
        "content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}},
    }
}


FILES_BODY = {
    "requestBody": {
        "required": True,
        "description": "Zipped files of any bench, each a trial: CSV, MAT, NPZ, HDF5, Parquet, JSON lines.",
        "content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}},
    }
}


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
    channel: str = Field(description="channel of the recording; empty where it is not used")
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


@router.post(
    "",
    status_code=201,
    summary="Import a recording set (zip)",
    responses=problems(401, 413, 415, 422),
    openapi_extra=ZIP_BODY,
)
async def import_set(
    request: Request,
    store: StoreOf,
    name: Annotated[
        str, Query(min_length=1, max_length=100, pattern=r"^[^/\\\x00-\x1f]+$", examples=["bench 3, gear 12"])
    ],
) -> Imported:
    """All or nothing: an error names file, line and column, what was found and what is wanted.

    Files of other shapes need a `mapping.toml` in the zip: ask POST /recording-sets/guess for one.
    """
    _check_is_zip(request)
    with tempfile.TemporaryDirectory(prefix="friction-bench-") as folder:
        path = Path(folder) / f"{_shortened(name)}.zip"  # errors name the set as its sender does
        await _receive(request.stream(), path)
        made = await in_worker(request, _import, store, path, name)
    note(request, f"imported experiment {made.experiment_id} ({name})")
    return made


@router.post(
    "/guess",
    summary="What the columns of unknown files may be (zip)",
    responses=problems(401, 413, 415, 422),
    openapi_extra=FILES_BODY,
)
async def guess_set(
    request: Request,
    name: Annotated[
        str, Query(min_length=1, max_length=100, pattern=r"^[^/\\\x00-\x1f]+$", examples=["bench 3, gear 12"])
    ],
    take: Annotated[list[str] | None, Query(description="what a column is: NAME=QUANTITY[UNIT]", max_length=50)] = None,
    counts_per_turn: Annotated[float | None, Query(gt=0, description="of the joint, for columns in counts")] = None,
    rate_hz: Annotated[float | None, Query(gt=0, description="samples a second, where no column is a time")] = None,
    supply_v: Annotated[float | None, Query(description="supply voltage [V], where no column holds it")] = None,
) -> GuessedColumns:
    """Keeps nothing. Where no question is left, put `mapping` and `rig` into the zip as mapping.toml and rig.toml."""
    _check_is_zip(request)
    with tempfile.TemporaryDirectory(prefix="friction-bench-") as folder:
        path = Path(folder) / f"{_shortened(name)}.zip"
        await _receive(request.stream(), path)
        return await in_worker(request, _guess, path, take or [], counts_per_turn, rate_hz, supply_v)


def _check_is_zip(request: Request) -> None:
    kind = request.headers.get("content-type", "").partition(";")[0].strip()
    if kind not in {"application/zip", "application/x-zip-compressed", "application/octet-stream"}:
        raise HTTPException(415, f"Content-Type is '{kind}'; wanted is application/zip")


# what reads foreign files is imported when the first one comes: the service starts without it


def _guess(
    path: Path, take: list[str], counts_per_turn: float | None, rate_hz: float | None, supply_v: float | None
) -> GuessedColumns:
    from bench.recording_set.guess import Known, guess_of, mapping_text, read_said, rig_text
    from bench.recording_set.guess.names import UNITS_OF
    from bench.recording_set.units import units_of

    guess, rig, notes = guess_of([path], None, Known(read_said(take), counts_per_turn, rate_hz, supply_v))
    return GuessedColumns(
        joint=guess.joint,
        columns=[GuessedColumn(**{**asdict(one), "outline": list(one.outline)}) for one in guess.taken],
        quantities={one: [name for si in units for name in units_of(si)] for one, units in UNITS_OF.items()},
        questions=list(guess.questions),
        notes=[*notes, *guess.notes],
        mapping=mapping_text(guess.mapping),
        rig=rig_text(rig),
    )


def _shortened(name: str) -> str:
    """A name that fits in a file system: they count bytes, and 255 of them at most."""
    return name.encode()[:LONGEST_FILE_NAME].decode(errors="ignore")


async def _receive(chunks: AsyncIterator[bytes], path: Path) -> None:
    received = 0
    async with await anyio.open_file(path, "wb") as file:
        async for chunk in chunks:
            received += len(chunk)
            if received > MOST_BYTES:
                raise HTTPException(
                    413, f"the upload is larger than {MOST_BYTES} bytes; split the set, or import its path"
                )
            await file.write(chunk)


def _import(store: Store, path: Path, name: str) -> Imported:
    from bench.recording_set import import_recording_set, imported_before, read_recording_set

    recording_set = read_recording_set(path, None, None)
    notes = [*recording_set.notes, *imported_before(store, recording_set)]
    experiment_id = import_recording_set(store, recording_set, name)
    rows = sum(len(recording) for recording in recording_set.recordings)
    trials = len(recording_set.recordings)
    return Imported(experiment_id=experiment_id, name=name, trials=trials, rows=rows, notes=notes)
