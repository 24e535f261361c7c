"""The page and what it needs: files of `web/`, and plotly's JavaScript out of its pip package.

The page asks for its files under a fingerprint of all of them: a browser keeps them for good, compressed, and asks for
new ones when any has changed. Without a fingerprint they are served as they are, checked each time.
"""

import gzip
import hashlib
import importlib.util
import json
import mimetypes
import os
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from fastapi import APIRouter, FastAPI, HTTPException, Request, Response
from fastapi.responses import FileResponse, HTMLResponse
from starlette.staticfiles import StaticFiles

from bench.config.channels import CHANNELS
from bench.config.quantities import UNITS
from bench.errors import ConfigurationError
from bench.service.http.api_router import LateRoute

WEB = Path(__file__).resolve().parents[3] / "web"
PLOTLY = "plotly.min.js"
NAMES = '<script type="application/json" id="names">'
FINGERPRINT_LENGTH = 12
FOR_GOOD = "public, max-age=31536000, immutable"
FRESH = "no-cache"
_DAY_S = 86_400
router = APIRouter(include_in_schema=False, route_class=LateRoute)


def plotly_file() -> Path:
    """plotly's JavaScript, as the installed pip package carries it.

    Raises:
        ConfigurationError: the package is not installed, or carries no such file.
    """
    found = importlib.util.find_spec("plotly")
    path = Path(found.origin).parent / "package_data" / PLOTLY if found and found.origin else None
    if path is None or not path.is_file():
        raise ConfigurationError(
            f"package 'plotly' is missing or has no package_data/{PLOTLY}; run: pip install plotly"
        )
    return path


def page_files() -> dict[str, Path]:
    """Every file that the page may ask for, by its path below /static; nothing else is served."""
    # asked with each file that a browser fetches: rglob takes six times as long
    paths = sorted(os.path.join(folder, name) for folder, _, names in os.walk(WEB) for name in names)
    found = {path[len(str(WEB)) + 1 :].replace(os.sep, "/"): Path(path) for path in paths if os.path.isfile(path)}
    return {**found, PLOTLY: plotly_file()}


def fingerprint(files: Mapping[str, Path]) -> str:
    """What changes when any of the files does: from their names, sizes and times.

    Args:
        files: as `page_files` finds them.
    """
    found = ((name, path.stat()) for name, path in files.items())
    told = [f"{name} {stat.st_size} {stat.st_mtime_ns}" for name, stat in found]
    return hashlib.sha256("\n".join(told).encode()).hexdigest()[:FINGERPRINT_LENGTH]


@lru_cache(maxsize=256)
def compressed(path: Path, fingerprinted: str) -> bytes:  # noqa: ARG001 - a changed file is compressed anew
    """A file, compressed once."""
    return gzip.compress(path.read_bytes(), mtime=0)


def names() -> str:
    """What the page calls channels and units, by the one table of each: JSON."""
    return json.dumps(
        {
            "units": UNITS,
            "channels": {name: channel.label for name, channel in CHANNELS.items()},
            "plotted": [name for name, channel in CHANNELS.items() if channel.plotted],
        }
    )


@router.get("/")
def index() -> HTMLResponse:
    """The page; its modules are asked for at once, not one after the other as they name each other."""
    text = (WEB / "index.html").read_text(encoding="utf-8")
    files = page_files()
    known = fingerprint(files)
    modules = [name for name in files if name.startswith("modules/")]
    preload = "\n".join(f'  <link rel="modulepreload" href="/static/{known}/{name}">' for name in modules)
    text = text.replace('"/static/', f'"/static/{known}/').replace("</head>", f"{preload}\n</head>")
    text = text.replace(f"{NAMES}{{}}", NAMES + names())
    return HTMLResponse(text, headers={"Cache-Control": FRESH})


@router.get("/static/plotly.min.js")
def plotly() -> FileResponse:
    """plotly's JavaScript by its own name; kept by the browser for a day, because it is large."""
    return FileResponse(plotly_file(), media_type="text/javascript", headers={"Cache-Control": f"max-age={_DAY_S}"})


@router.get("/static/{known:str}/{name:path}")
def fingerprinted(request: Request, known: str, name: str) -> Response:
    """A file under a fingerprint. One of another fingerprint, of a page from before an update, is not kept."""
    files = page_files()
    if len(known) != FINGERPRINT_LENGTH or name not in files:
        plain = files.get(f"{known}/{name}")
        if plain is None:
            raise HTTPException(404, f"the page has no file {known}/{name}")
        return FileResponse(plain, headers={"Cache-Control": FRESH})
    kept = FOR_GOOD if known == fingerprint(files) else FRESH
    headers = {"Cache-Control": kept, "Vary": "Accept-Encoding"}
    media_type = "text/javascript" if name.endswith(".js") else mimetypes.guess_type(name)[0]
    if "gzip" not in request.headers.get("accept-encoding", ""):
        return FileResponse(files[name], media_type=media_type, headers=headers)
    packed = compressed(files[name], fingerprint(files))
    return Response(packed, media_type=media_type, headers={**headers, "Content-Encoding": "gzip"})


class _Fresh(StaticFiles):
    """Static files that the browser checks for a newer version each time."""

    def file_response(self, *args: object, **kwargs: object) -> object:  # type: ignore[override]
        response = super().file_response(*args, **kwargs)  # type: ignore[arg-type]
        response.headers["Cache-Control"] = FRESH
        return response


def install(app: FastAPI) -> None:
    """Serve the files of the page as they are, where the router has none under their name."""
    app.mount("/static", _Fresh(directory=WEB), name="static")
