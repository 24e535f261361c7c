"""`friction-bench bench-report`: has a change made the bench worse?"""

import time
from pathlib import Path
from typing import Annotated

import typer

from bench.cli.exit_codes import ExitCode
from bench.cli.output import Json, complain, print_json, say, table


def bench_report(
    baseline: Annotated[Path, typer.Option(help="JSON file with what the campaign gave before.")] = Path(
        "bench-baseline.json"
    ),
    update_baseline: Annotated[
        bool, typer.Option("--update-baseline", help="Keep what is measured now as the baseline; compare nothing.")
    ] = False,
    seeds: Annotated[int, typer.Option(min=2, max=10, help="How often it is run, each time with another seed.")] = 8,
    first_seed: Annotated[int, typer.Option(min=1, help="The first of them; the others follow.")] = 1,
    junit: Annotated[Path | None, typer.Option(help="Write a JUnit XML file, too.")] = None,
    html: Annotated[Path | None, typer.Option(help="Write an HTML report, too.")] = None,
    as_json: Json = False,
) -> None:
    """Run a small campaign on the simulated bench, and compare it with a baseline, seed by seed.

    Exit code 0: as before, or better. 1: something is worse, has changed, or was not measured. 3: no fitting baseline.
    """
    from bench.evaluation.bench_report.baseline import read_baseline, write_baseline
    from bench.evaluation.bench_report.campaign import run_seed
    from bench.evaluation.bench_report.comparison import compare
    from bench.evaluation.bench_report.documents import (
        BAD,
        COLUMNS,
        EXPLANATION,
        cells,
        is_bad,
        sections,
        write_junit,
    )
    from bench.parallel.over_cores import over_cores

    before = None if update_baseline else read_baseline(baseline)
    begun_s = time.monotonic()
    found = list(over_cores(run_seed, range(first_seed, first_seed + seeds)))
    if before is None:
        write_baseline(baseline, found)
        say(f"the baseline of {seeds} seeds is in {baseline}")
        return
    lines = compare(before, found)
    if junit is not None:
        write_junit(junit, lines, time.monotonic() - begun_s)
    if html is not None:
        from bench.report.html import write_html

        write_html(html, "Bench report", sections(lines))
    if as_json:
        named = [name.removesuffix("#") for name in COLUMNS]
        print_json([dict(zip(named, cells(line), strict=True)) | {"sentence": line.sentence} for line in lines])
    else:
        table("Before and now", COLUMNS, map(cells, lines))
        say(EXPLANATION)
    for line in lines:
        if line.verdict in BAD:
            complain(f"{line.metric.name} {line.sentence}")
    if is_bad(lines):
        raise typer.Exit(ExitCode.NOT_COMPLETED)
