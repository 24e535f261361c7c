"""The text of a rig.toml: what is known of a joint, and every other key as a comment, as the model of a rig has it."""

from collections.abc import Iterator
from typing import get_args

import tomli_w
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from bench.config.rig import Rig

HEAD = """\
# What is known of the joint, in numbers of your own: take the # away from a table and from those of its keys that you
# know, and leave the others as they are. After each key: its unit, and what it is.
"""
OF_ROTARY_JOINTS = ("gear", "arm", "sensor")


def rig_text(rig: Rig) -> str:
    """The text of a rig.toml: what a rig tells, and comments that show the keys which it does not."""
    told = rig.model_dump(mode="json", exclude_defaults=True, exclude_none=True)
    plain, tables = {}, {}
    for name, field in Rig.model_fields.items():
        if (table := _table(field)) is None:
            plain[name] = field
        elif rig.joint == "rotary" or name in told or name not in OF_ROTARY_JOINTS:
            tables[name] = table
    lines = [*_keys(plain, told), "", *HEAD.splitlines()]
    for name, table in tables.items():
        values = told.get(name, {})
        mark = "" if values else "# "
        what = (table.__doc__ or "").partition("\n")[0].rstrip(".")
        lines += [f"{mark}[{name}]  # {what}", *_keys(table.model_fields, values), ""]
    return "\n".join(lines).rstrip("\n") + "\n"


def _table(field: FieldInfo) -> type[BaseModel] | None:
    """The model of a table; None of a key that holds a value."""
    kinds = (field.annotation, *get_args(field.annotation))
    return next((kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)), None)


def _keys(fields: dict[str, FieldInfo], told: dict[str, object]) -> Iterator[str]:
    """A line for each key: as it is told, else a comment with an example."""
    for name, field in fields.items():
        if name in told:
            yield tomli_w.dumps({name: told[name]}).rstrip("\n")
            continue
        example = next(iter(field.examples or ()), field.default)
        extra = field.json_schema_extra
        unit = str(extra.get("unit", "")) if isinstance(extra, dict) else ""
        what = (field.description or "").partition(". ")[0]
        entry = tomli_w.dumps({name: example}).rstrip("\n")
        yield f"# {entry}  # {unit}: {what}" if unit else f"# {entry}  # {what}"
