"""`bench.toml` and `rig.toml`: every table and key, from the models that read them."""

from collections.abc import Iterator

from bench.config.configuration import BenchConfiguration
from bench.config.rig import Rig
from docs.generate.markdown import code
from docs.generate.schema import Schema, alternatives, keys, models_in, name_of

BEGIN = """\
# Settings: {file}

{what}

Every table refuses keys that it does not know. Where a default is given the key can be left out. "left out" as a
default means that the value is unknown, or is found in another way; the meaning says which.

"""
BENCH = (
    "One bench: its joint, drive, limits and store. `friction-bench --config bench.toml` reads it. Examples for each "
    "kind of drive are in `examples/`. Without a file the simulated bench of the paper is used."
)
RIG = (
    "One joint as its owner knows it. It is the `[rig]` table of `bench.toml`, a file named there "
    '(`rig = "rig.toml"`), and a file of every recording set.'
)


def bench_toml() -> str:
    """The page of `bench.toml`."""
    return _page("bench.toml", BENCH, BenchConfiguration.model_json_schema())


def rig_toml() -> str:
    """The page of `rig.toml`."""
    return _page("rig.toml", RIG, Rig.model_json_schema())


def _page(file: str, what: str, whole: Schema) -> str:
    sections = "\n".join(_sections("", whole, whole.get("$defs", {}), {}))
    return BEGIN.format(file=file, what=what) + sections


def _sections(path: str, schema: Schema, models: dict[str, Schema], seen: dict[str, str]) -> Iterator[str]:
    """The tables of a file, each with its keys, outermost first; a model that comes again is named by its first place.

    Args:
        path: of the table, dots between; in brackets where it may come several times; "" for the file itself.
        schema: of the table.
        models: all of the file, by name.
        seen: the path at which each model was described; filled here.
    """
    values, tables = _split(schema)
    if path or values["properties"]:
        table = keys(values) if values["properties"] else ""
        yield f"## {_title(path, values)}\n\n{schema.get('description', '')}\n\n{table}"
    for name, one in tables.items():
        place = f"{path.strip('[]')}.{name}".lstrip(".")
        place = f"[{place}]" if one.get("type") == "array" else place
        found = list(models_in(one))
        if known := seen.get(found[0]):
            yield f"## {code(f'[{place}]')}\n\n{_words(one)}Keys as of {code(f'[{known}]')}.\n"
            continue
        for model in found:
            seen[model] = place
            whole = {**models[model], "description": _words(one) + models[model].get("description", "")}
            yield from _sections(place, whole, models, seen)


def _words(table: Schema) -> str:
    """What the file that holds a table says of it."""
    may_miss = any(one.get("type") == "null" for one in table.get("anyOf", ()))
    words = f"{table['description']}. " if table.get("description") else ""
    return words + ("The table may be left out. " if may_miss else "")


def _title(path: str, values: Schema) -> str:
    kind = values["properties"].get("kind", {}).get("const")
    title = code(f"[{path}]") if path else "Outside any table"
    return f"{title} of kind {code(kind)}" if kind else title


def _split(schema: Schema) -> tuple[Schema, dict[str, Schema]]:
    """The keys that hold values, and those that hold tables."""
    properties = schema.get("properties", {})
    tables = {name: one for name, one in properties.items() if any(map(_is_table, alternatives(one)))}
    values = {name: one for name, one in properties.items() if name not in tables}
    return {**schema, "properties": values}, tables


def _is_table(schema: Schema) -> bool:
    items = schema.get("items")
    return bool(name_of(schema)) or (isinstance(items, dict) and any(True for _ in models_in(items)))
