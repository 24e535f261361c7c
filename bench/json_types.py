"""Values as JSON has them: what users and files give in free form, and numbers that may be unknown."""

from collections.abc import Mapping
from math import nan
from typing import Annotated

from pydantic import BeforeValidator, JsonValue, WithJsonSchema

Json = Mapping[str, JsonValue]
"""An object of JSON or TOML whose keys this program does not prescribe: parameters, conditions, provenance, results."""


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
