"""/recording-sets: trials of other benches come in. (They leave under /experiments/{id}/recording-set.)"""

import tempfile
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Annotated

import anyio
from fastapi import APIRouter, Depends, HTTPException, Query, Request
from pydantic import BaseModel, Field

from bench.recording_set import import_recording_set, read_recording_set
from bench.service.auth.access import require_token
from bench.service.auth.audit_trail import note
from bench.service.compute import in_worker
from bench.service.http.problems import problems
from bench.service.services import StoreOf
from bench.store import Store

MOST_BYTES = 2 * 1024**3
LONGEST_FILE_NAME = 200  # bytes
router = APIRouter(prefix="/recording-sets", tags=["recording sets"], dependencies=[Depends(require_token)])
ZIP_BODY = {
    "requestBody": {
        "required": True,
        "description": "A zipped recording set: rig.toml, trials.csv, one CSV per trial; SI, the unit in the name.",
        "content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}},
    }
}


class Imported(BaseModel):
    """What an import made."""

    experiment_id: int = Field(description="the experiment under which the trials are kept")
    name: str
    trials: int = Field(description="how many trials came in")
    rows: int = Field(description="how many rows came in, all trials together")


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

    Files of other shapes need a mapping file: use `friction-bench import PATH --mapping mapping.toml`.
    """
    kind = request.headers.get("content-type", "").partition(";")[0].strip()
    if kind not in {"application/zip", "application/x-zip-compressed", "application/octet-stream"}:
        raise HTTPException(415, f"Content-Type is '{kind}'; wanted is application/zip")
    with tempfile.TemporaryDirectory(prefix="friction-bench-") as folder:
        path = Path(folder) / f"{_shortened(name)}.zip"  # errors name the set as its sender does
        await _receive(request.stream(), path)
        made = await in_worker(request, _import, store, path, name)
    note(request, f"imported experiment {made.experiment_id} ({name})")
    return made


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
    recording_set = read_recording_set(path, None, None)
    experiment_id = import_recording_set(store, recording_set, name)
    rows = sum(len(recording) for recording in recording_set.recordings)
    return Imported(experiment_id=experiment_id, name=name, trials=len(recording_set.recordings), rows=rows)
