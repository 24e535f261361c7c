"""/recording-sets: trials of other benches come in. (They leave under /experiments/{id}/recording-set.)"""

import asyncio
import errno
import tempfile
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Annotated

import anyio
from fastapi import Depends, HTTPException, Query, Request

from bench.service.auth.access import require_token
from bench.service.auth.audit_trail import note
from bench.service.compute import in_lab
from bench.service.http.api_router import api_router
from bench.service.http.openapi import Document
from bench.service.http.problems import problems
from bench.service.uploads import GuessedColumns, Imported, guess_upload, import_upload

MOST_BYTES = 2 * 1024**3
LONGEST_FILE_NAME = 200  # bytes
GRACE_S = 60.0  # that an upload may take, whatever its size ...
LEAST_B_S = 1e6 / 60.0  # ... and what it has to bring beyond [bytes/s]
NO_ROOM = (errno.ENOSPC, errno.EDQUOT)
router = api_router("/recording-sets", tags=["recording sets"], dependencies=[Depends(require_token)])
UploadName = Annotated[
    str, Query(min_length=1, max_length=100, pattern=r"^[^/\\\x00-\x1f]+$", examples=["bench 3, gear 12"])
]


def _zip_body(description: str) -> Document:
    content = {"application/zip": {"schema": {"type": "string", "format": "binary"}}}
    return {"requestBody": {"required": True, "description": description, "content": content}}


@router.post(
    "",
    status_code=201,
    summary="Import a recording set (zip)",
    responses=problems(401, 408, 413, 415, 422, 503),
    openapi_extra=_zip_body(
        "A zipped recording set: rig.toml, trials.csv, one CSV per trial; SI, the unit in the name."
    ),
)
async def import_set(request: Request, name: UploadName) -> Imported:
    """All or nothing: an error names file, line and column, what was found and what is wanted.

    Files of other shapes need a `mapping.toml` in the zip: ask POST /recording-sets/guess for one.
    """
    async with _upload(request, name) as path:
        made = await in_lab(request, import_upload, path, name)
    note(request, f"imported experiment {made.experiment_id} ({name})")
    return made


@router.post(
    "/guess",
    summary="What the columns of unknown files may be (zip)",
    responses=problems(401, 408, 413, 415, 422, 503),
    openapi_extra=_zip_body("Zipped files of any bench, each a trial: CSV, MAT, NPZ, HDF5, Parquet, JSON lines."),
)
async def guess_set(
    request: Request,
    name: UploadName,
    take: Annotated[list[str] | None, Query(description="what a column is: NAME=QUANTITY[UNIT]", max_length=50)] = None,
    counts_per_turn: Annotated[float | None, Query(gt=0, description="of the joint, for columns in counts")] = None,
    rate_hz: Annotated[float | None, Query(gt=0, description="samples a second, where no column is a time")] = None,
    supply_v: Annotated[float | None, Query(description="supply voltage [V], where no column holds it")] = None,
) -> GuessedColumns:
    """Keeps nothing. Where no question is left, put `mapping` and `rig` into the zip as mapping.toml and rig.toml."""
    async with _upload(request, name) as path:
        return await in_lab(request, guess_upload, path, take or [], counts_per_turn, rate_hz, supply_v)


@asynccontextmanager
async def _upload(request: Request, name: str) -> AsyncIterator[Path]:
    """The body as a file, which is removed afterwards; errors name it as its sender does."""
    _check_is_zip(request)
    try:
        with tempfile.TemporaryDirectory(prefix="friction-bench-") as folder:
            path = Path(folder) / f"{_shortened(name)}.zip"
            await _receive(request.stream(), path)
            yield path
    except OSError as error:
        if error.errno not in NO_ROOM:
            raise
        raise HTTPException(
            503, f"there is no room for the upload in {tempfile.gettempdir()} of the service; make some, or set TMPDIR"
        ) from error


def _check_is_zip(request: Request) -> None:
    kind = request.headers.get("content-type", "").partition(";")[0].strip()
    if kind not in {"application/zip", "application/x-zip-compressed", "application/octet-stream"}:
        raise HTTPException(415, f"Content-Type is '{kind}'; wanted is application/zip")


def _shortened(name: str) -> str:
    """A name that fits in a file system: they count bytes, and 255 of them at most."""
    return name.encode()[:LONGEST_FILE_NAME].decode(errors="ignore")


async def _receive(chunks: AsyncIterator[bytes], path: Path) -> None:
    received, begun_s = 0, asyncio.get_running_loop().time()
    try:
        async with asyncio.timeout(GRACE_S) as limit, await anyio.open_file(path, "wb") as file:
            async for chunk in chunks:
                received += len(chunk)
                if received > MOST_BYTES:
                    raise HTTPException(
                        413, f"the upload is larger than {MOST_BYTES} bytes; split the set, or import its path"
                    )
                await file.write(chunk)
                limit.reschedule(begun_s + GRACE_S + received / LEAST_B_S)
    except TimeoutError:
        raise HTTPException(
            408,
            f"the upload has brought {received} bytes and goes on too slowly; wanted are {60.0 * LEAST_B_S / 1e6:g} MB "
            f"a minute after the first {GRACE_S:g} s. Send it over a faster line, in pieces, or import its path",
            {"Connection": "close"},
        ) from None
