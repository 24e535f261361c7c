"""Functions of the model lab by name: the service hands them to the processes of the lab, and never imports the lab.

Fits take scipy and half a second to import; whoever opens the first page waits for none of it. Each is imported by the
process that calls it first. A module that names them imports theirs for the type checker, and `bench` from here else:

    if TYPE_CHECKING:
        import bench.study.ladder
    else:
        from bench.service.later import bench

    await in_lab(request, bench.study.ladder.ladder, study_id)
"""

from dataclasses import dataclass
from pkgutil import resolve_name
from typing import Any


@dataclass(frozen=True, slots=True)
class Later:
    """A package, a module or a function by its place; another process finds it there, too."""

    place: str

    @property
    def __name__(self) -> str:
        return self.place.rpartition(".")[2]

    def __getattr__(self, name: str) -> "Later":
        if name.startswith("_"):  # no name of ours: Python asks for it, as to copy the object
            raise AttributeError(name)
        return Later(f"{self.place}.{name}")

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """What the function returns; the first call imports it."""
        module, _, function = self.place.rpartition(".")
        return resolve_name(f"{module}:{function}")(*args, **kwargs)


bench = Later("bench")
