"""`friction-bench commission`: from a joint of which little is known to a bench.toml that compensates."""

from contextlib import closing
from functools import partial
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.operation.drives import found_at
from bench.cli.output import say, table, text
from bench.errors import ConfigurationError

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.commission.evidence import Evidence
    from bench.commission.questions import Person, Question
    from bench.config.drives.simulated_device import DriveTable

_TRAVEL = "How far the arm may turn to either side of straight down [degrees]."


def commission(
    context: typer.Context,
    drive: Annotated[Path | None, typer.Option(help="TOML file with the section [drive].")] = None,
    port: Annotated[str, typer.Option(help="Serial port to look for the drive on, such as /dev/ttyUSB0.")] = "",
    bus: Annotated[str, typer.Option(help="CAN bus to look for it on, as INTERFACE:CHANNEL.")] = "",
    out: Annotated[Path, typer.Option(help="Where to write bench.toml; the evidence goes beside it.")] = Path(
        "bench.toml"
    ),
    name: Annotated[str, typer.Option(help="Name of the bench.")] = "bench",
    travel_deg: Annotated[float, typer.Option(min=60.0, max=360.0, help=_TRAVEL)] = 120.0,
    answers: Annotated[
        Path | None, typer.Option(help="TOML file with answers by their keys; others are asked.")
    ] = None,
) -> None:
    """Find out what a joint is by small motions, and write a bench.toml that compensates, with its evidence.

    Asks what is known, turns nothing before a person says so, and ends with a load found. Ctrl-C stops the joint.
    """
    from bench.cli.operation.signals import stoppable_command, stopping_on_signals
    from bench.commission.bench_file import refuse_taken, write_bench
    from bench.commission.bench_table import BenchTable
    from bench.commission.evidence import Evidence
    from bench.commission.flow import Commission
    from bench.commission.motions import Motions
    from bench.control import scheduling
    from bench.runs.runner import HostProcess, Runner

    refuse_taken(out)
    section = _section(drive, port, bus)
    person, evidence = _person(section, answers), Evidence()
    bench_table = BenchTable(name, section, radians(travel_deg))
    with (
        session_of(context).open_store() as store,
        stoppable_command("commission", name),
        closing(Runner(bench_table.looking(), store, HostProcess(during_run=scheduling.undisturbed))) as runner,
    ):
        motions = Motions(runner, store, partial(person.done, "hang"), stopping_on_signals)
        flow = Commission(bench_table, person, motions, evidence)
        try:
            ended = flow.run()
        finally:
            _show(evidence)
    write_bench(out, ended.bench, evidence)
    if ended.first_kg == ended.first_kg:  # not NaN
        say(f"The trial load of {1e3 * ended.first_kg:g} g was found as {1e3 * ended.found_kg:.1f} g.")
    say(f"Written: {out}. Next: friction-bench --config {out} run load-sweep")


def _section(drive: Path | None, port: str, bus: str) -> "DriveTable":
    """The section of the drive: as given, or of the one drive that answers."""
    from bench.commission.drive_section import read_section

    if sum(map(bool, (drive, port, bus))) != 1:
        raise typer.BadParameter("one of --drive FILE, --port PORT and --bus INTERFACE:CHANNEL is wanted")
    if drive is not None:
        return read_section(drive)
    found = list(found_at(port, (), bus, 1_000_000))
    if len(found) != 1:
        seen = ", ".join(one.title for one in found) or "nothing"
        raise ConfigurationError(
            f"{port or bus}: {seen} answers, and one drive is wanted; write its section into a file and give --drive"
        )
    say(f"Found: {found[0].title}")
    return found[0].drive


def _person(section: "DriveTable", answers: Path | None) -> "Person":
    from bench.commission.simulated_hand import hands_at
    from bench.config.toml_text import read_toml

    return hands_at(section, _Terminal({} if answers is None else read_toml(answers)))


class _Terminal:
    """The person at the terminal; answers that a file holds are not asked for."""

    def __init__(self, known: "DriveTable") -> None:
        self._known = known

    def number(self, question: "Question") -> float | None:
        if question.key in self._known:
            return self._done_as_known(question, float(self._known[question.key]))
        hint = "; Enter where it is not known" if question.optional else ""
        unit = f" [{question.unit}]" if question.unit else ""
        while True:
            typed: str = typer.prompt(f"{question.sentence}{unit}{hint}", default="", show_default=False, err=True)
            if not typed.strip() and question.optional:
                return None
            try:
                return float(typed)
            except ValueError:
                say(f"'{typed}' is no number.")

    def _done_as_known(self, question: "Question", answer: float) -> float | None:
        """An answer from the file; where it is about a deed, once the person has done that (a load of 0 is none)."""
        from bench.commission.questions import CommissionError

        checked = question.check(answer)
        if question.deed and checked:
            known = f"The answers say {checked:g} {question.unit}."
            if not self.done(question.key, f"{question.sentence} {known}"):
                raise CommissionError(f"given up at: {question.sentence}")
        return checked

    def done(self, key: str, sentence: str) -> bool:  # noqa: ARG002
        typed: str = typer.prompt(f"{sentence} Enter when done, q to give up", default="", show_default=False, err=True)
        return typed.strip().lower() != "q"


def _show(evidence: "Evidence") -> None:
    rows = [
        (
            one.name,
            one.value if isinstance(one.value, str) else text(float(one.value)),
            one.unit,
            _ends(one.low, one.high),
            one.how,
        )
        for one in evidence
    ]
    table("Found", ["what", "value#", "unit", "95 %", "from"], rows)


def _ends(low: float | None, high: float | None) -> str:
    return "" if low is None or high is None else f"{low:.4g} .. {high:.4g}"
