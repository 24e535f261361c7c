"""`friction-bench serve`: the REST interface and the page."""

import gc
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.bench_session import BenchSession, session_of
from bench.cli.output import say

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.config.configuration import BenchConfiguration


def serve(
    context: typer.Context,
    host: Annotated[
        str, typer.Option(help="Address to listen on; beyond loopback only with a token and TLS.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port to listen on.")] = 8000,
    allow_host: Annotated[
        list[str] | None, typer.Option(help="Another name under which browsers may address the service; repeatable.")
    ] = None,
    tls_certificate: Annotated[
        Path | None, typer.Option(help="Certificate in PEM, for https; those of its authorities may follow in it.")
    ] = None,
    tls_key: Annotated[Path | None, typer.Option(help="Its private key in PEM, without a password.")] = None,
    plain_http: Annotated[
        bool, typer.Option("--plain-http", help="No TLS beyond loopback: the network is the bench's own.")
    ] = False,
    drive: Annotated[
        Path | None,
        typer.Option(help="TOML file with the section [drive] alone: its joint is to be commissioned on the page."),
    ] = None,
) -> None:
    """Serve the page and the REST interface for the bench, until Ctrl-C. Stops the joint when it ends."""
    # what a start imports stays until the end: to look through it for garbage meanwhile takes a tenth of a second
    gc.disable()
    from bench.service.app import create_app
    from bench.service.auth.tls import certificate
    from bench.service.server import Address, serve_bench

    tls = certificate(tls_certificate, tls_key)
    session = session_of(context)
    configuration = session.configuration() if drive is None else _unknown_joint(drive, session)
    serve_bench(configuration, Address(host, port, tuple(allow_host or ()), plain_http), create_app, say, tls)


def _unknown_joint(drive: Path, session: BenchSession) -> "BenchConfiguration":
    from bench.commission.drive_section import bench_of, read_section

    if session.config is not None:
        raise typer.BadParameter("one of --config FILE and serve --drive FILE is wanted")
    return session.with_store(bench_of(read_section(drive)))
