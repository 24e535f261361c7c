"""Command-line options out of the parameters of an experiment kind: one definition for REST, form and terminal."""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from bench.cli.output import Json
from bench.errors import ConfigurationError
from bench.experiments.kind import ExperimentKind
from bench.json_types import Value, as_option

Schema = dict[str, Any]
"""A part of a JSON schema, as pydantic makes it."""
_BOUNDS = (("minimum", ">="), ("exclusiveMinimum", ">"), ("maximum", "<="), ("exclusiveMaximum", "<"))


def parameter_command(kind: ExperimentKind, run: Callable[..., None], **common: Any) -> Any:
    """A command with one option per parameter of the kind.

    Args:
        kind: its parameters' JSON schema gives names, units, bounds and defaults.
        run: called as run(context, kind, parameters, <common options>); parameters as texts, none where not given.
        common: annotation of each further option, by name; all are optional.
    """
    schema = kind.parameters.model_json_schema()
    properties: dict[str, Schema] = schema.get("properties", {})

    def command(context: typer.Context, **options: Any) -> None:
        parameters: dict[str, list[str]] = {name: options.pop(name) or [] for name in properties}
        run(context, kind, parameters, **options)

    options = {name: _option(name, each, name in schema.get("required", [])) for name, each in properties.items()}
    annotations: dict[str, object] = {"context": typer.Context, **options, **common, "as_json": Json}
    defaults = {"as_json": False}
    command.__signature__ = inspect.Signature(  # type: ignore[attr-defined]  # what typer reads
        [
            inspect.Parameter(
                name,
                inspect.Parameter.KEYWORD_ONLY,
                annotation=annotation,
                default=inspect.Parameter.empty if name == "context" else defaults.get(name),
            )
            for name, annotation in annotations.items()
        ]
    )
    command.__annotations__ = annotations
    command.__doc__ = kind.summary
    made = typer.Typer(add_completion=False, rich_markup_mode="markdown", pretty_exceptions_enable=False)
    made.command(kind.name, help=f"{kind.title}. {kind.summary}")(command)
    return typer.main.get_command(made)


def given(kind: ExperimentKind, options: dict[str, list[str]]) -> "dict[str, Value]":
    """What was typed, as the values that the parameters' model reads.

    Lists are separated by commas, or given one by one. A parameter that holds a file is given as its path; the file's
    name goes along.

    Raises:
        BadParameter: one that is no list, given several times.
        ConfigurationError: a file that cannot be read.
    """
    properties = kind.parameters.model_json_schema().get("properties", {})
    values: dict[str, Value] = {}
    for name, texts in options.items():
        if not texts:
            continue
        text = ",".join(texts)
        if len(texts) > 1 and properties[name].get("type") != "array":
            raise typer.BadParameter(f"{name} is given {len(texts)} times, as {', '.join(texts)}; give one value")
        if "file" in properties[name]:
            values.setdefault(properties[name]["file"], Path(text).name)
        values[name] = _value(text, properties[name])
    return values


def _value(text: str, schema: Schema) -> Any:
    if schema.get("type") == "array":
        return [part.strip() for part in text.split(",") if part.strip()]
    return _read(Path(text)) if "file" in schema else text


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ConfigurationError(f"{path}: is not UTF-8; save it as CSV UTF-8") from error


def _option(name: str, schema: Schema, required: bool) -> Any:
    unit = schema.get("unit", "")
    hint = f"{schema.get('description', '')}{f' [{unit}]' if unit else ''}."
    limits = [f"{sign} {_bounded(schema)[key]:g}" for key, sign in _BOUNDS if key in _bounded(schema)]
    if limits:
        hint += f" {', '.join(limits)}."
    hint += " Required." if required else f" Default: {as_option(schema.get('default'))}."
    metavar = {"array": "A,B,...", "integer": "INTEGER", "number": "NUMBER", "boolean": "true|false"}
    flag = "--" + name.replace("_", "-")
    shown = "FILE" if "file" in schema else metavar.get(schema.get("type", ""), "TEXT")
    return Annotated[list[str] | None, typer.Option(flag, metavar=shown, help=hint)]


def _bounded(schema: Schema) -> Schema:
    """Where the bounds of a value stand: for a list, in its items."""
    items: Schema = schema.get("items", {}) if schema.get("type") == "array" else schema
    return items
