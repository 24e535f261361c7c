"""`friction-bench explain FILE...`: from files of any bench to a report that says what the model lacks."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.lab.study_tables import GAIN, gain_text
from bench.cli.output import Json, console, free_page, percent, print_json, refuse_taken, say, table, write_whole
from bench.cli.records.guessed import (
    CountsPerTurn,
    RateHz,
    SupplyV,
    Take,
    known_of,
    remark_imported_before,
    remark_mapping_beside,
    show,
)

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from rich.progress import Progress

    from bench.recording_set.guess import Guess
    from bench.report import Section
    from bench.study.explanation.explain import Explained
    from bench.study.models.ladder import Rung

_REPORT = "Report to write; without it explain-NAME.html, or explain-NAME-2.html and so on where that is there."
_HOLD_OUT = "Trials that judge the model instead of being fitted; repeatable. Without it, each is left out in turn."


def explain(
    context: typer.Context,
    path: Annotated[
        list[Path], typer.Argument(metavar="PATH...", help="Files of any bench, each a trial; or a folder or zip.")
    ],
    rig: Annotated[Path | None, typer.Option(help="rig.toml: what is known of motor, gear and arm.")] = None,
    mapping: Annotated[Path | None, typer.Option(help="mapping.toml; without it, columns are guessed.")] = None,
    take: Take = None,
    counts_per_turn: CountsPerTurn = None,
    rate_hz: RateHz = None,
    supply_v: SupplyV = None,
    hold_out: Annotated[list[str] | None, typer.Option(metavar="KEY=VALUE", help=_HOLD_OUT)] = None,
    html: Annotated[
        Path | None,
        typer.Option(help=_REPORT),
    ] = None,
    name: Annotated[str | None, typer.Option(help="Name; without it, that of the files.")] = None,
    as_json: Json = False,
) -> None:
    """Import files of any bench, say what a model of the joint lacks, and write a report for a colleague."""
    from bench.recording_set import import_recording_set, read_mapping, read_rig
    from bench.recording_set.guess import read_unknown
    from bench.study.explanation.explain import STEPS, NeverSlidError
    from bench.study.explanation.explain import explain as explain_experiment

    chosen_rig = None if rig is None else read_rig(rig)
    if mapping is None:
        remark_mapping_beside(path)
    known = known_of(take, counts_per_turn, rate_hz, supply_v)
    recordings, guess = read_unknown(path, chosen_rig, known, None if mapping is None else read_mapping(mapping))
    called = name or recordings.name
    report = html or free_page(f"explain-{re.sub(r'[^A-Za-z0-9._-]+', '-', called)}")
    refuse_taken(report, "name another file with --html")
    if guess is not None and not as_json:
        show(guess, recordings.notes)
    elif not as_json:
        for note in recordings.notes:
            say(note)
    with session_of(context).open_store() as store, _progress(hidden=as_json) as bar:
        remark_imported_before(store, recordings)
        task = bar.add_task("import", total=len(STEPS) + 1)
        experiment_id = import_recording_set(store, recordings, called)

        def tell(step: str, number: int) -> None:
            bar.update(task, description=step, completed=number + 1)

        came_in = None if guess is None else _came_in(guess, recordings.notes)
        try:
            found = explain_experiment(store, experiment_id, called, tell, hold_out or [], came_in)
        except NeverSlidError as told:
            bar.stop()
            write_whole(report, [told.html.encode()])
            _say_what_holds(str(told), report, experiment_id, as_json)
            return
        bar.update(task, description="done", completed=len(STEPS) + 1)
    write_whole(report, [found.html.encode()])
    if as_json:
        print_json({"report": str(report), **found.as_json()})
        return
    _say_tables(found)
    for sentence in found.sentences:
        say(sentence)
    if count := len(found.not_judged):
        were = "effect was" if count == 1 else "effects were"
        say(f"{count} {were} not judged, the report says why: {', '.join(found.not_judged)}.")
    say(f"written: {report}; kept as study {found.study_id}")


def _say_tables(found: "Explained") -> None:
    """What the data can tell, and the error from model to model."""
    from bench.study.report.model_sections import change_of, marked_change, uncounted_in_words

    table(
        "What these data can and cannot tell",
        ["of", "found", "what that leaves open"],
        [(one.quantity, one.found, one.lacking or "-") for one in found.coverage.held],
    )
    say(found.coverage.sentence)
    table(
        "Error from model to model",
        ["model#", "change", "training#", "held out#", "90 % interval", f"{GAIN}#"],
        [
            (
                one.model_id,
                marked_change(one, change_of(one)),
                percent(one.training),
                percent(one.held_out),
                _interval(one),
                gain_text(one),
            )
            for one in found.rungs.rungs
        ],
    )
    for sentence in uncounted_in_words(found.rungs):
        say(sentence)


def _say_what_holds(sentence: str, report: Path, experiment_id: int, as_json: bool) -> None:
    """Of a joint that never slid."""
    if as_json:
        print_json({"report": str(report), "study_id": None, "sentences": [sentence]})
        return
    say(f"{sentence[:1].upper()}{sentence[1:]}.")
    say(f"written: {report}; the trials are kept as experiment {experiment_id}")


def _interval(rung: "Rung") -> str:
    return f"{percent(rung.held_out_low)} to {percent(rung.held_out_high)}"


def _progress(hidden: bool) -> "Progress":
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    return Progress(*columns, TimeElapsedColumn(), console=console(), disable=hidden)


def _came_in(guess: "Guess", notes: tuple[str, ...]) -> "Section":
    """How the files were read, with a picture of each column that is used."""
    from bench.report import Figure, Line, Section, Table

    rows = [(one.column, one.channel or "-", one.unit, one.low, one.high, one.why) for one in guess.taken]
    figures = [
        Figure(
            f"{one.column} as {one.channel}",
            "sample",
            f"{one.column} [{one.unit}]",
            [Line("first file", list(range(len(one.outline))), one.outline)],
        )
        for one in guess.taken
        if one.channel and one.channel != "time_s" and one.outline
    ]
    columns = ["column", "taken for", "in", "from#", "to#", "because"]
    return Section("How the files were read", [*notes, *guess.notes], [Table("Columns", columns, rows)], figures)
