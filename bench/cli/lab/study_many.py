"""What `study diagnose-many` does: ask, print one line for each study."""

from typing import Any

from bench.cli.bench_session import BenchSession
from bench.cli.evaluation.cores import progress
from bench.cli.output import percent, table
from compensator.lab.chance import chance_cell


def diagnose_studies(
    session: BenchSession, studies: list[int], workers: int | None, cluster: str | None
) -> list[dict[str, Any]]:
    """The diagnoses of these studies, or of all."""
    from bench.study.diagnose_many import diagnose_many

    with session.open_store() as store:
        chosen = studies or sorted(row.id for row in store.studies())
        return diagnose_many(store, chosen, progress, workers, cluster)


def show(found: list[dict[str, Any]]) -> None:
    """One line for each study."""
    table("Diagnoses", ["study#", "verdict", "first", "held out before#", "after#", "p#", "sentence"], map(_row, found))


def _row(one: dict[str, Any]) -> tuple[object, ...]:
    if "error" in one:
        return one["study_id"], "not judged", None, None, None, None, one["error"]
    first = one["ranking"][0] if one["ranking"] else None
    errors = (None, None) if first is None else (percent(first["held_out_before"]), percent(first["held_out_after"]))
    return (
        one["study_id"],
        one["verdict"],
        first and first["effect"],
        *errors,
        chance_cell(one["p_value"]),
        one["sentence"],
    )
