"""`friction-bench token`: who may do what with the service; made and revoked by whoever can write the store."""

from datetime import timedelta
from typing import Annotated

import typer

from bench.cli.audit_note import note
from bench.cli.bench_session import session_of
from bench.cli.output import Json, print_json, remark, say, table
from bench.service.auth.tokens import Role

app = typer.Typer(no_args_is_help=True)
Name = Annotated[str, typer.Argument(help="Of the person or the program that gets it; never given twice.")]


@app.callback()
def _token() -> None:
    """Make, list and revoke the tokens of the service. A running service knows within two seconds."""


@app.command()
def new(
    context: typer.Context,
    name: Name,
    role: Annotated[
        Role, typer.Option(help="viewer: reads and stops. operator: runs and changes. admin: may all.")
    ] = Role.OPERATOR,
    expires_days: Annotated[
        float | None, typer.Option(min=1e-3, max=36500, help="After so many days it opens nothing; without it, never.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Make a token and print it, this once: the store keeps its digest alone."""
    from bench.service.auth.tokens import check_name, digest_of, make_token
    from bench.store.tables.experiments import now

    check_name(name)
    made = make_token()
    expires_utc = None if expires_days is None else now() + timedelta(days=expires_days)
    with session_of(context).open_store() as store:
        store.access.tokens.add(name, role, digest_of(made), expires_utc)
        where = store.where
        note(store, f"token new {name}", f"made token '{name}' with the role {role}")
    if as_json:
        print_json({"name": name, "role": str(role), "expires_utc": expires_utc, "token": made})
        return
    say(made)
    remark(f"opens services on the store {where}")


@app.command("list")
def list_(context: typer.Context, as_json: Json = False) -> None:
    """List the tokens by name: role, when made, until when."""
    from bench.store.tables.experiments import now

    with session_of(context).open_store() as store:
        found, where = store.access.tokens.find(), store.where
    rows = [
        {
            "name": one.name, "role": one.role, "created_utc": one.created_utc, "expires_utc": one.expires_utc,
            "revoked_utc": one.revoked_utc, "valid": one.is_valid(now()),
        }
        for one in found
    ]  # fmt: skip
    if as_json:
        print_json(rows)
        return
    columns = ["name", "role", "made", "expires", "revoked", "valid"]
    table(
        f"Tokens of the store {where}",
        columns,
        [[*list(row.values())[:-1], "yes" if row["valid"] else "no"] for row in rows],
    )


@app.command()
def revoke(context: typer.Context, name: Annotated[str, typer.Argument(help="Of the token.")]) -> None:
    """Take a token back: it opens nothing any more, and its name stays in the audit log."""
    with session_of(context).open_store() as store:
        store.access.tokens.revoke(name)
        note(store, f"token revoke {name}", f"revoked token '{name}'")
    say(f"token '{name}' is revoked")
