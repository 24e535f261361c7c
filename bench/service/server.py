"""The process that serves: address, token, and an end that stops the joint first."""

import signal
import socket
from collections.abc import Callable
from types import FrameType
from typing import NamedTuple

import uvicorn
from fastapi import FastAPI

from bench.configuration import BenchConfiguration
from bench.drive_factory import is_simulated
from bench.errors import ConfigurationError
from bench.runner import Runner
from bench.service.access import LOOPBACK_NAMES, Access, check_bind, is_loopback
from bench.service.app import PREFIX, create_app
from bench.service.tokens import find_or_make_token, find_token, token_file
from bench.store import Store
from bench.store.backend import shown

LINGER_S = 2  # how long open connections are waited for at the end


class Address(NamedTuple):
    """Where to listen, and under which names.

    Attributes:
        host: address or name to bind.
        port: TCP port; 0: any free one.
        names: further host names that browsers may use.
    """

    host: str
    port: int
    names: tuple[str, ...] = ()


class BenchServer(uvicorn.Server):
    """uvicorn, but a signal stops the joint before anything else.

    Args:
        app: made by `create_app`.
        runner: what has to stop.
    """

    def __init__(self, app: FastAPI, runner: Runner) -> None:
        super().__init__(
            uvicorn.Config(
                app, log_level="warning", access_log=False, timeout_graceful_shutdown=LINGER_S, lifespan="on"
            )
        )
        self._app = app
        self._runner = runner

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:  # noqa: ARG002  uvicorn's signature
        """Stop the joint, end the live streams, then the server; a second signal does not wait for connections."""
        self._runner.stop("the service was ended")
        self.end_streams()
        self.force_exit = self.should_exit
        self.should_exit = True

    def end_streams(self) -> None:
        """Let live streams end: they would hold the server open."""
        self._app.state.ending = True


def serve_bench(configuration: BenchConfiguration, address: Address, say: Callable[[str], None]) -> None:
    """Serve until a signal comes.

    Args:
        configuration: of the bench and its store.
        address: where to listen.
        say: shows a line to whoever started it.

    Raises:
        ConfigurationError: an address that may not or cannot be listened on, or a token that cannot be used.
    """
    path = token_file(configuration.store.url)
    check_bind(address.host, token_configured=find_token(path) is not None)
    with listen(address) as listener, Store.open(configuration.store.url) as store:
        token = find_or_make_token(path)
        runner = Runner(configuration, store)
        access = Access(token, is_loopback(address.host), LOOPBACK_NAMES | {address.host, *address.names})
        server = BenchServer(create_app(store, runner, access), runner)
        port = listener.getsockname()[1]
        for line in _welcome(configuration, address.host, port, token):
            say(line)
        if signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:  # `nohup` has it ignored, and means it
            signal.signal(signal.SIGHUP, server.handle_exit)  # uvicorn would let it kill the process
        server.run(sockets=[listener])


def listen(address: Address) -> socket.socket:
    """A socket that is bound.

    Raises:
        ConfigurationError: the port is taken, the address is not of this machine, or it takes more rights.
    """
    try:
        return socket.create_server((address.host, address.port), family=_family(address.host), backlog=128)
    except OSError as error:
        raise ConfigurationError(
            f"cannot listen on {address.host} port {address.port}: {error.strerror or error}; "
            "choose another with --port or --host"
        ) from error


def _family(host: str) -> socket.AddressFamily:
    return socket.AF_INET6 if ":" in host else socket.AF_INET


def _welcome(configuration: BenchConfiguration, host: str, port: int, token: str) -> list[str]:
    address = f"[{host}]" if ":" in host else host
    drive = "SIMULATED drive, no hardware moves" if is_simulated(configuration) else "REAL drive, the joint moves"
    return [
        f"bench  {configuration.name}: {drive}",
        f"store  {shown(configuration.store.url)}",
        f"page   http://{address}:{port}/",
        f"REST   http://{address}:{port}{PREFIX}/openapi.json",
        f"token  {token}   (the page asks for it; keep it to yourself)",
        "Ctrl-C stops the joint and ends the service.",
    ]
