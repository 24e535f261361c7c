"""Values as JSON has them: what users and files give in free form, and numbers that may be unknown."""

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite, nan
from typing import Annotated, TypeAlias, Union

from pydantic import BeforeValidator, JsonValue, WithJsonSchema

Json = Mapping[str, JsonValue]
"""An object of JSON or TOML whose keys this program does not prescribe, as it was read: parameters, provenance."""

Value: TypeAlias = Union[bool, int, float, str, Sequence["Value"], Mapping[str, "Value"], None]  # noqa: UP007
"""What can be written as JSON; a number that is not known is NaN or None."""

Values = Mapping[str, Value]
"""What is written as an object of JSON: results of a trial by name, the unit in the name."""


def number(value: Value) -> float:
    """A value that is a number.

    Raises:
        TypeError: it is none.
    """
    if isinstance(value, int | float):
        return value
    raise TypeError(f"{value!r} is no number")


def known(value: float) -> float | None:
    """The same; None where it is NaN or infinite."""
    return value if isfinite(value) else None


def objects(value: Value) -> list[Values]:
    """A list of objects; none where there is no list."""
    return [one for one in value or () if isinstance(one, Mapping)] if isinstance(value, list | tuple | None) else []


def numbers(objects: Iterable[Values], name: str) -> list[float]:
    """The values of one name that are known."""
    return [number(one[name]) for one in objects if one.get(name) is not None]


def as_option(value: object) -> str:
    """As an option of a command has it: lists with commas, six digits of a number."""
    if isinstance(value, list | tuple):
        return ",".join(map(as_option, value))
    return f"{value:g}" if isinstance(value, float) else str(value)


def _known(value: object) -> object:
    return nan if value is None else value


def _all_known(values: object) -> object:
    return [nan if one is None else one for one in values] if isinstance(values, list | tuple) else values


Number = Annotated[float, BeforeValidator(_known), WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "null"}]})]
"""NaN in Python, null in JSON, where it is not known."""

Numbers = Annotated[
    list[float],
    BeforeValidator(_all_known),
    WithJsonSchema({"type": "array", "items": {"anyOf": [{"type": "number"}, {"type": "null"}]}}),
]
"""A list of the same."""
