"""The process that serves: address, token, and an end that stops the joint first."""

import gc
import os
import shlex
import signal
import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from types import FrameType
from typing import NamedTuple

import uvicorn
from fastapi import FastAPI

from bench import __version__
from bench.commission.guide import ENDED
from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import is_simulated
from bench.errors import ConfigurationError
from bench.own_processes import OwnProcess, announced, new_file
from bench.own_service import LOOPBACK_NAMES, is_loopback, own_file
from bench.runs import event_log
from bench.runs.bench_control import BenchControl
from bench.runs.bench_process.remote_runner import RemoteRunner
from bench.service.auth.access import Access, check_bind
from bench.service.auth.session import session_file, session_token
from bench.service.auth.tls import Certificate
from bench.service.auth.token_register import TokenRegister, Tokens, first_token, has_valid_token
from bench.service.auth.tokens import ENVIRONMENT, SAME_USER, TOKEN_VARIABLE, chosen_token, token_file
from bench.service.http.api_router import PREFIX
from bench.service.http.connections import Connection, allow_files
from bench.service.lab import Lab, LabProcesses
from bench.store import Store
from bench.store.address import shown

MakeApp = Callable[[Store, BenchControl, Access, Lab], FastAPI]
"""As `bench.service.app.create_app`."""
_HERE = {"": "127.0.0.1", "0.0.0.0": "127.0.0.1", "::": "::1"}  # noqa: S104  where it is reached that listens everywhere
LINGER_S = 2  # how long open connections are waited for at the end


class Place(NamedTuple):
    """Where the service listens."""

    host: str
    port: int
    encrypted: bool

    @property
    def url(self) -> str:
        """Its address."""
        name = f"[{self.host}]" if ":" in self.host else self.host
        return f"{'https' if self.encrypted else 'http'}://{name}:{self.port}"


def welcome(configuration: BenchConfiguration, place: Place, tokens: Tokens) -> list[str]:
    """The lines."""
    drive = "SIMULATED drive, no hardware moves" if is_simulated(configuration) else "REAL drive, the joint moves"
    lines = [
        f"bench  {configuration.name}: {drive}",
        f"store  {shown(configuration.store.url)}",
        f"page   {place.url}/",
        f"REST   {place.url}{PREFIX}/openapi.json",
        f"token  {_token(configuration, tokens)}",
    ]
    if not place.encrypted and not is_loopback(place.host):
        lines.append("tokens and data cross the network in the clear: see --tls-certificate and --tls-key")
    return [*lines, "Ctrl-C stops the joint and ends the service."]


def _token(configuration: BenchConfiguration, tokens: Tokens) -> str:
    if tokens.made is not None:
        return f"{tokens.made}   (the page asks for it; keep it to yourself: it is shown this once)"
    if tokens.chosen is None:
        store = shlex.quote(shown(configuration.store.url))
        return f"was shown at the first start; another one: friction-bench --store {store} token new NAME --role admin"
    name, _ = tokens.chosen
    return f"that of {TOKEN_VARIABLE if name == ENVIRONMENT else token_file(configuration.store.url)}"


class Address(NamedTuple):
    """Where to listen, and under which names.

    Attributes:
        host: address or name to bind.
        port: TCP port; 0: any free one.
        names: further host names that browsers may use.
        plain: without TLS beyond loopback, too.
    """

    host: str
    port: int
    names: tuple[str, ...] = ()
    plain: bool = False


class BenchServer(uvicorn.Server):
    """uvicorn, but a signal stops the joint before anything else.

    Args:
        app: made by `create_app`.
        runner: what has to stop.
        tls: certificate and key; None: plain HTTP.
    """

    def __init__(self, app: FastAPI, runner: BenchControl, tls: Certificate | None = None) -> None:
        super().__init__(
            uvicorn.Config(
                app,
                log_level="warning",
                access_log=False,
                timeout_graceful_shutdown=LINGER_S,
                lifespan="on",
                http=Connection,
                proxy_headers=False,  # whoever connects says nothing of who it is
                ssl_certfile=tls.chain if tls else None,
                ssl_keyfile=tls.key if tls else None,
            )
        )
        self._app = app
        self._runner = runner

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:  # noqa: ARG002  uvicorn's signature
        """Stop the joint, end the live streams, then the server; a second signal does not wait for connections."""
        self._app.state.conductor.end()
        self._app.state.guide.stop(ENDED)
        self._app.state.calibrator.stop(ENDED)
        self._runner.stop(ENDED)
        self.end_streams()
        self.force_exit = self.should_exit
        self.should_exit = True

    def end_streams(self) -> None:
        """Let live streams end: they would hold the server open."""
        self._app.state.ending = True


def serve_bench(
    configuration: BenchConfiguration,
    address: Address,
    make_app: MakeApp,
    say: Callable[[str], None],
    tls: Certificate | None = None,
) -> None:
    """Serve until a signal comes.

    Raises:
        ConfigurationError: an address that may not or cannot be listened on, or a token that cannot be used.
    """
    url = configuration.store.url
    chosen = chosen_token(token_file(url))
    allow_files()
    with Store.open(url) as store:
        known = chosen is not None or has_valid_token(store)
        check_bind(address.host, token_configured=known, private=tls is not None or address.plain)
        with listen(address) as listener:
            port = listener.getsockname()[1]
            tokens = first_token(store, chosen)
            with session_token(session_file(url, port), own_file(port)) as session:
                fixed = {SAME_USER: session} | dict([tokens.chosen] if tokens.chosen else [])
                register = TokenRegister(fixed, store.access.tokens.find)
                register.refresh()
                names = LOOPBACK_NAMES | {address.host, *address.names}
                place = Place(address.host, port, tls is not None)
                with (
                    _found_by_stop(configuration.name, place, session, tls),
                    closing(RemoteRunner(configuration, store)) as runner,
                ):
                    access = Access(register, is_loopback(address.host), names)
                    app = make_app(store, runner, access, LabProcesses(url))
                    for line in welcome(configuration, place, tokens):
                        say(line)
                    facts = {"host": address.host, "port": port, "tls": tls is not None, "rig": configuration.rig.name}
                    event_log.note("service started", **facts, version=__version__)
                    gc.freeze()
                    gc.enable()
                    _serve(BenchServer(app, runner, tls), listener)
    event_log.note("service ended")


@contextmanager
def _found_by_stop(bench: str, place: Place, token: str, tls: Certificate | None) -> Iterator[None]:
    """While it lasts `friction-bench stop` of this user finds the service, if it has a folder to leave word in."""
    path = new_file()
    with ExitStack() as stack:
        if path is not None:
            certificate = "" if tls is None else tls.chain.read_text(encoding="ascii", errors="ignore")
            url = place._replace(host=_HERE.get(place.host, place.host)).url
            told = OwnProcess("friction-bench serve", bench, os.getpid(), url, token, certificate)
            with suppress(OSError):
                stack.enter_context(announced(path, told))
        yield


def _serve(server: BenchServer, listener: socket.socket) -> None:
    if signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:  # `nohup` has it ignored, and means it
        signal.signal(signal.SIGHUP, server.handle_exit)  # uvicorn would let it kill the process
    server.run(sockets=[listener])


def listen(address: Address) -> socket.socket:
    """A socket that is bound.

    Raises:
        ConfigurationError: the port is taken, the address is not of this machine, or it takes more rights.
    """
    try:
        listener = socket.create_server((address.host, address.port), family=_family(address.host), backlog=128)
        # of every connection: an answer is sent in two pieces, and the second would wait 40 ms for word of the first
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return listener
    except OSError as error:
        raise ConfigurationError(
            f"cannot listen on {address.host} port {address.port}: {error.strerror or error}; "
            "choose another with --port or --host"
        ) from error


def _family(host: str) -> socket.AddressFamily:
    return socket.AF_INET6 if ":" in host else socket.AF_INET
