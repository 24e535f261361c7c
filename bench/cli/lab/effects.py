"""`friction-bench effects`: the catalogue."""

from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.output import Json, print_json, say, table
from bench.errors import ParameterError

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.study.models.effects import Effect


def effects(
    name: Annotated[str | None, typer.Argument(help="One effect in full; without it, the list.")] = None,
    as_json: Json = False,
) -> None:
    """List the physical effects that a model can be made of."""
    from bench.study.effects import effects_catalogue, effects_left_out

    catalogue = effects_catalogue()
    if name is not None:
        catalogue = [one for one in catalogue if one.name == name]
        if not catalogue:
            raise ParameterError(f"there is no effect '{name}'; list them with: friction-bench effects")
    if as_json:
        print_json(catalogue)
    elif name is None:
        rows = [(one.name, one.title, one.driver, ", ".join(one.confused_with)) for one in catalogue]
        table("Effects", ["name", "title", "driven by", "confused with"], rows)
        for one in effects_left_out():
            say(f"left out: {one.entry_point}, of package {one.package}: {one.reason}")
    else:
        _describe(catalogue[0])


def _describe(effect: "Effect") -> None:
    say(f"{effect.title}\n\n{effect.physics}\n\n  {effect.equation}\n")
    say(f"driven by: {effect.driver}\nexcited by: {effect.excited_by}\nsource: {effect.source}")
    rows = [(one.name, one.unit, one.low, one.high) for one in effect.parameters]
    table("Parameters", ["name", "unit", "low#", "high#"], rows)
