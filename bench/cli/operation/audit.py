"""`friction-bench audit`: who did what."""

from dataclasses import asdict
from typing import Annotated

import typer

from bench.cli.bench_session import session_of
from bench.cli.output import Json, print_json, table


def audit(
    context: typer.Context,
    token: Annotated[str | None, typer.Option(help="Only what was done with the token of this name.")] = None,
    limit: Annotated[int, typer.Option(min=1, help="How many at most.")] = 50,
    as_json: Json = False,
) -> None:
    """Show who changed what over the service, newest first. How long that is kept: [store.retention] audit_days."""
    with session_of(context).open_store() as store:
        found = store.access.audit.find(token, limit)
    if as_json:
        print_json([asdict(one) for one in found])
        return
    rows = [
        (one.at_utc, one.token or "-", one.role or "-", one.client or "-", f"{one.method} {one.path}",
         one.status or "-", one.detail)
        for one in found
    ]  # fmt: skip
    table("Audit log", ["time", "token", "role", "from", "request", "answer#", "what"], rows)
