"""`friction-bench demo`: the main job, end to end, on the simulated bench."""

from pathlib import Path
from typing import Annotated

import typer

from bench.cli.output import print_section, say


def demo(
    report: Annotated[Path, typer.Option(help="Where the HTML report is written; the trials go beside it.")] = Path(
        "out/demo.html"
    ),
    seed: Annotated[int, typer.Option(min=0, help="Draws the hidden effect.")] = 2,
) -> None:
    """Run the main job end to end: steps, load sweep, a hidden effect found. Prints tables, writes one HTML report."""
    from bench.evaluation.demo import run_demo  # the lab and the plant are loaded when they are first needed

    database = run_demo(report, print_section, seed)
    say(f"Report: {report}")
    say(f"Look at the trials and the study on the page: friction-bench --store sqlite:///{database} serve")
