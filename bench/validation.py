"""What pydantic found wrong, in words that name the place, the key, the value, what is allowed and the unit."""

from typing import Any

from pydantic import ValidationError

from bench.quantities import unit_of

_SHOWN_CHARACTERS = 60


def problems(error: ValidationError, prefix: str = "") -> list[str]:
    """One line per problem.

    Args:
        error: as pydantic raised it.
        prefix: put before each key ("limits").
    """
    return [_problem(detail, prefix) for detail in error.errors(include_url=False)]


def _problem(detail: Any, prefix: str) -> str:
    location = [part for part in detail["loc"] if not _is_tag(part)]
    key = ".".join(str(part) for part in ([prefix] if prefix else []) + location) or "the whole"
    name = str(location[-1]) if location else ""
    unit = unit_of(name)
    if detail["type"] == "extra_forbidden":
        return f"{key}: unknown key; remove it or correct its spelling"
    if detail["type"] == "missing":
        return f"{key}: missing; give a value{f' in {unit}' if unit else ''}"
    wanted = detail["msg"].removeprefix("Value error, ").removeprefix("Input ")
    wanted = wanted[0].lower() + wanted[1:]
    if unit and detail["type"] != "value_error":
        wanted = f"{wanted} {unit}" if detail["type"].startswith(("greater", "less")) else f"{wanted}, in {unit}"
    return f"{key}: found {_shown(detail.get('input'))}; {wanted}"


def _is_tag(part: Any) -> bool:
    """Whether a part of a location is pydantic's own, such as the name of a union's branch."""
    return isinstance(part, str) and (part.startswith(("function-", "tagged-")) or "[" in part)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN_CHARACTERS else f"{text[:_SHOWN_CHARACTERS]}..."
