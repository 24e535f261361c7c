"""`friction-bench study suggest`: with --start runs what is suggested, adds it to the study, and diagnoses again; with
--queue has a service run it."""

from typing import TYPE_CHECKING, Any

import typer

from bench.cli import study_tables as tables
from bench.cli.bench_session import BenchSession
from bench.cli.exit_codes import ExitCode
from bench.cli.output import print_json, say
from bench.cli.run import carry_out
from bench.cli.service import ask

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.store import Experiment


def suggested(session: BenchSession, study_id: int, model_id: int | None, trials: int) -> dict[str, Any]:
    """What to record next."""
    from bench.study import suggest

    with session.open_store() as store:
        return suggest(store, study_id, session.configuration(), model_id, trials)


def carry_out_all(session: BenchSession, found: dict[str, Any], as_json: bool) -> None:
    """Run every suggested trial; what completed is added to the study, also where a later one did not."""
    done: list[Experiment] = []
    signal_code: int | None = None
    for one in found["trials"]:
        experiment, signal_code = carry_out(session, one["kind"], one["parameters"], "", found["note"], None, as_json)
        done.append(experiment)
        if experiment.outcome != "completed":
            break
    completed = [one.id for one in done if one.outcome == "completed"]
    answer = {"suggested": found, **_added(session, found["study_id"], completed)}
    if as_json:
        print_json(answer)
    else:
        _tell(answer, done)
    if signal_code is not None:
        raise typer.Exit(signal_code)
    if len(completed) < len(found["trials"]):
        raise typer.Exit(ExitCode.NOT_COMPLETED)


def queue_all(session: BenchSession, found: dict[str, Any], url: str, as_json: bool) -> None:
    """Put every suggested trial into the queue of a service: all or none."""
    names = ("kind", "parameters")
    items = [{**{name: one[name] for name in names}, "note": found["note"]} for one in found["trials"]]
    queued = ask(session, "POST", url, "/queue", {"items": items}) if items else {"item_ids": []}
    if as_json:
        print_json({"suggested": found, **queued})
        return
    tables.suggestion(found)
    if items:
        say(f"{len(items)} items are in the queue; when they are done: friction-bench study extend {found['study_id']}")


def _added(session: BenchSession, study_id: int, completed: list[int]) -> dict[str, Any]:
    from bench.study import diagnose, extend_study

    if not completed:
        return {}
    with session.open_store() as store:
        return {"extended": extend_study(store, study_id, completed), "diagnosis": diagnose(store, study_id)}


def _tell(answer: dict[str, Any], done: "list[Experiment]") -> None:
    for one in done:
        say(f"experiment {one.id}: {one.outcome}{f': {one.reason}' if one.reason else ''}")
    if "extended" in answer:
        tables.extended(answer["extended"])
        tables.diagnosis(answer["diagnosis"])
