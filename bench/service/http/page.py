"""The page and what it needs: files of `web/`, and plotly's JavaScript out of its pip package."""

import importlib.util
from pathlib import Path

from fastapi import APIRouter, FastAPI
from fastapi.responses import FileResponse
from starlette.staticfiles import StaticFiles

from bench.errors import ConfigurationError

WEB = Path(__file__).resolve().parents[3] / "web"
_DAY_S = 86_400
router = APIRouter(include_in_schema=False)


def plotly_file() -> Path:
    """plotly's JavaScript, as the installed pip package carries it.

    Raises:
        ConfigurationError: the package is not installed, or carries no such file.
    """
    found = importlib.util.find_spec("plotly")
    path = Path(found.origin).parent / "package_data" / "plotly.min.js" if found and found.origin else None
    if path is None or not path.is_file():
        raise ConfigurationError(
            "package 'plotly' is missing or has no package_data/plotly.min.js; run: pip install plotly"
        )
    return path


@router.get("/")
async def index() -> FileResponse:
    """The page."""
    return FileResponse(WEB / "index.html", headers={"Cache-Control": "no-cache"})


@router.get("/static/plotly.min.js")
async def plotly() -> FileResponse:
    """plotly's JavaScript; kept by the browser for a day, because it is large."""
    return FileResponse(plotly_file(), media_type="text/javascript", headers={"Cache-Control": f"max-age={_DAY_S}"})


class _Fresh(StaticFiles):
    """Static files that the browser checks for a newer version each time."""

    def file_response(self, *args: object, **kwargs: object) -> object:  # type: ignore[override]
        response = super().file_response(*args, **kwargs)  # type: ignore[arg-type]
        response.headers["Cache-Control"] = "no-cache"
        return response


def install(app: FastAPI) -> None:
    """Serve the page at / and its files under /static."""
    app.include_router(router)
    app.mount("/static", _Fresh(directory=WEB), name="static")
