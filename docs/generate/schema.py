"""Tables of a JSON schema: the keys of a model with unit, default, and what is allowed."""

from collections.abc import Callable, Iterator
from typing import Any

from docs.generate.markdown import as_json, code, table

Schema = dict[str, Any]
Link = Callable[[str], str]
COLUMNS = ("key", "unit", "default", "allowed", "meaning")
_BOUNDS = (
    ("exclusiveMinimum", "above"),
    ("minimum", "at least"),
    ("exclusiveMaximum", "below"),
    ("maximum", "at most"),
    ("minLength", "characters: at least"),
    ("maxLength", "characters: at most"),
    ("minItems", "entries: at least"),
    ("maxItems", "entries: at most"),
)
_TYPES = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false"}


def name_of(schema: Schema) -> str:
    """The model that a schema refers to; "" where it is no reference."""
    return str(schema.get("$ref", "")).rpartition("/")[2]


def alternatives(schema: Schema) -> list[Schema]:
    """What a value may be, without null."""
    found = schema.get("anyOf") or schema.get("oneOf") or [schema]
    return [one for one in found if one.get("type") != "null"]


def allowed(schema: Schema, link: Link = str) -> str:
    """What a value may be, in words.

    Args:
        schema: of the value.
        link: how a model is named.
    """
    return " or ".join(dict.fromkeys(filter(None, (_allowed(one, link) for one in alternatives(schema)))))


def _allowed(schema: Schema, link: Link) -> str:
    if name := name_of(schema):
        return link(name)
    if "const" in schema:
        return code(as_json(schema["const"]))
    if "enum" in schema:
        return ", ".join(code(as_json(one)) for one in schema["enum"])
    bounds = [f"{words} {schema[key]}" for key, words in _BOUNDS if key in schema]
    kind = str(schema.get("type", ""))
    if kind == "array":
        first = schema.get("items") or (schema.get("prefixItems") or [{}])[0]
        return "; ".join([f"list of {allowed(first, link) or 'values'}", *bounds])
    if kind == "object":
        inner = schema.get("additionalProperties")
        return f"table of {allowed(inner, link)}" if isinstance(inner, dict) and inner else "table"
    return "; ".join([_TYPES.get(kind, kind), *bounds]).strip("; ")


def keys(schema: Schema, link: Link = str) -> str:
    """The table of a model's keys, without columns that would be empty."""
    required = set(schema.get("required", ()))
    rows = []
    for name, one in schema.get("properties", {}).items():
        default = "required" if name in required else code(as_json(one["default"])) if "default" in one else ""
        default = "left out" if default == "`null`" else default
        meaning = one.get("description", "")
        unit = one.get("unit", "").replace(" ", "\u00a0")  # stays on one line
        rows.append((code(name), code(unit), default, allowed(one, link), meaning))
    filled = [column for column in range(len(COLUMNS)) if any(row[column] for row in rows)]
    return table([COLUMNS[one] for one in filled], [[row[one] for one in filled] for row in rows])


def models_in(schema: Schema) -> Iterator[str]:
    """The models that a value may be, or may hold."""
    for one in alternatives(schema):
        if name := name_of(one):
            yield name
        for inner in (one.get("items"), one.get("additionalProperties")):
            if isinstance(inner, dict):
                yield from models_in(inner)
