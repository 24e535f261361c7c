"""Routers of the interface: each has whole paths, and describes a route to FastAPI when it is first asked for."""

from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any

from fastapi import APIRouter
from fastapi.params import Depends
from fastapi.routing import APIRoute
from starlette.routing import compile_path, get_name

PREFIX = "/api/v1"  # of every path


class LateRoute(APIRoute):
    """A route that is known by path and methods, and looked through when anything else of it is wanted.

    To read the types of all routes, and to build what checks them, takes longer than the first page. What is wrong in a
    declaration shows when the description of the interface is asked for, which has them all.

    Args:
        path: whole.
        endpoint: what answers.
        methods: of HTTP; GET where left out.
        settings: as of `APIRoute`.
    """

    def __init__(
        self, path: str, endpoint: Callable[..., Any], *, methods: Sequence[str] | None = None, **settings: Any
    ) -> None:
        self._settings = settings | {"methods": methods}
        self.path, self.endpoint, self.name = path, endpoint, settings.get("name") or get_name(endpoint)
        self.methods = set(methods or ["GET"])
        self.path_regex, self.path_format, self.param_convertors = compile_path(path)

    def __getattr__(self, name: str) -> Any:
        # asked for what is not there yet alone; a name of Python's own is no reason to build
        if name.startswith("__") or "dependant" in self.__dict__:
            raise AttributeError(name)
        super().__init__(self.path, self.endpoint, **self._settings)
        return getattr(self, name)


def api_router(prefix: str = "", *, tags: Sequence[str | Enum] = (), dependencies: Sequence[Depends] = ()) -> APIRouter:
    """A router whose paths begin with that of the interface and `prefix`.

    FastAPI would describe each route again for every router that it is included in, so none is.
    """
    return APIRouter(prefix=PREFIX + prefix, tags=list(tags), dependencies=list(dependencies), route_class=LateRoute)
