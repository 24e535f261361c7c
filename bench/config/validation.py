"""What pydantic found wrong, in words that name the place, the key, the value, what is allowed and the unit."""

from collections.abc import Iterator
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from bench.config.quantities import unit_of

_SHOWN_CHARACTERS = 60
_MOST_ALLOWED = 20  # keys that are listed


def problems(error: ValidationError, prefix: str = "", model: type[BaseModel] | None = None) -> list[str]:
    """One line per problem.

    Args:
        error: as pydantic raised it.
        prefix: put before each key ("limits").
        model: what was read; with it, the keys that are allowed stand beside one that is not.
    """
    return [_problem(detail, prefix, model) for detail in error.errors(include_url=False)]


def _problem(detail: Any, prefix: str, model: type[BaseModel] | None) -> str:
    location = [part for part in detail["loc"] if not _is_tag(part)]
    key = ".".join(str(part) for part in ([prefix] if prefix else []) + location) or "the whole"
    name = str(location[-1]) if location else ""
    unit = unit_of(name)
    if detail["type"] == "extra_forbidden":
        allowed = _allowed(model, detail["loc"]) if model is not None else []
        listed = f" (allowed: {', '.join(allowed)})" if 0 < len(allowed) <= _MOST_ALLOWED else ""
        return f"{key}: unknown key; remove it or correct its spelling{listed}"
    if detail["type"] == "missing":
        return f"{key}: missing; give a value{f' in {unit}' if unit else ''}"
    wanted = detail["msg"].removeprefix("Value error, ").removeprefix("Input ")
    wanted = wanted[0].lower() + wanted[1:]
    if unit and detail["type"] != "value_error":
        wanted = f"{wanted} {unit}" if detail["type"].startswith(("greater", "less")) else f"{wanted}, in {unit}"
    return f"{key}: found {_shown(detail.get('input'))}; {wanted}"


def _allowed(model: type[BaseModel], location: tuple[int | str, ...]) -> list[str]:
    """The keys beside an unknown one; none where several shapes are possible there."""
    here = [model]
    for part in location[:-1]:
        inner = [
            one
            for outer in here
            for name, field in outer.model_fields.items()
            if part in (name, field.alias)
            for one in _models_in(field.annotation)
        ]
        here = inner or here  # an index, or the key of a dictionary, leads no deeper
    return [field.alias or name for name, field in here[0].model_fields.items()] if len(here) == 1 else []


def _models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    """The models that a field can hold, in a list or a dictionary, too."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in get_args(annotation):
        yield from _models_in(inner)


def _is_tag(part: Any) -> bool:
    """Whether a part of a location is pydantic's own, such as the name of a union's branch."""
    return isinstance(part, str) and (part.startswith(("function-", "tagged-")) or "[" in part)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN_CHARACTERS else f"{text[:_SHOWN_CHARACTERS]}..."
