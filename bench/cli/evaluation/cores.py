"""Options of commands that do the same work on many items: on all cores, or on a cluster; and how far they are."""

from typing import Annotated

import typer

Workers = Annotated[int | None, typer.Option(min=0, help="Processes; without it, one for each core.")]
Cluster = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Dask scheduler whose workers are used, for instance tcp://10.0.0.5:8786; needs the extra `cluster`.",
    ),
]


def progress(done: int, whole: int) -> None:
    """Say how many items are done, on stderr, in one line."""
    typer.echo(f"\r{done} of {whole} items", nl=done == whole, err=True)
