"""`friction-bench demo`: the main job, end to end, on the simulated bench."""

from pathlib import Path
from typing import Annotated

import typer

from bench.cli.output import say


def demo(
    report: Annotated[Path, typer.Option(help="Where the HTML report is written.")] = Path("out/demo.html"),
) -> None:
    """Run the main job end to end: steps, load sweep, a hidden effect found. Prints tables, writes one HTML report."""
    from bench.demo import run_demo

    raise typer.Exit(run_demo(report, say))
