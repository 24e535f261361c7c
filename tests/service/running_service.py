"""A service as its users have it: uvicorn on a real port, a store in a file, the simulated bench."""

import ssl
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx

from bench.config.configuration import BenchConfiguration, default_configuration
from bench.own_service import LOOPBACK_NAMES
from bench.runs.bench_control import BenchControl
from bench.runs.bench_process.remote_runner import RemoteRunner
from bench.runs.runner import Runner
from bench.service.app import create_app
from bench.service.auth.access import Access
from bench.service.auth.tls import Certificate
from bench.service.auth.token_register import TokenRegister
from bench.service.auth.tokens import ENVIRONMENT, digest_of, make_token
from bench.service.server import Address, BenchServer, listen
from bench.store import Store
from tests.service.plain_http import NOBODY

TOKEN = "test-token-0123456789"


@dataclass
class RunningService:
    """What tests talk to."""

    url: str
    store: Store
    runner: BenchControl
    client: httpx.Client  # sends the token
    stranger: httpx.Client  # does not
    access: Access

    def with_token(self, name: str, role: str, **expires: Any) -> httpx.Client:
        """A client with a new token; its caller closes it."""
        token = make_token()
        self.store.access.tokens.add(name, role, digest_of(token), **expires)
        headers = {"Authorization": f"Bearer {token}"}
        return httpx.Client(base_url=f"{self.url}/api/v1", headers=headers, timeout=60, verify=NOBODY)

    def start(self, kind: str, pace: str = "fast", **parameters: Any) -> int:
        body = {"kind": kind, "parameters": parameters, "pace": pace}
        answer = self.client.post("/experiments", json=body)
        assert answer.status_code == 201, answer.text
        return int(answer.json()["experiment_id"])

    def run(self, kind: str, **parameters: Any) -> dict[str, Any]:
        experiment_id = self.start(kind, **parameters)
        assert self.runner.wait(60.0)
        found: dict[str, Any] = self.client.get(f"/experiments/{experiment_id}").json()
        return found


@contextmanager
def running_service(
    folder: Path,
    reads_open: bool = True,
    port: int = 0,
    tls: Certificate | None = None,
    trust: ssl.SSLContext = NOBODY,
    configuration: BenchConfiguration | None = None,
    in_process_of_its_own: bool = False,
) -> Iterator[RunningService]:
    url = f"sqlite:///{folder / 'bench.sqlite'}"
    configuration = configuration or default_configuration()
    configuration = configuration.model_copy(update={"store": configuration.store.model_copy(update={"url": url})})
    with Store.open(url) as store, listen(Address("127.0.0.1", port)) as listener:
        runner = (RemoteRunner if in_process_of_its_own else Runner)(configuration, store)
        register = TokenRegister({ENVIRONMENT: TOKEN}, store.access.tokens.find)
        access = Access(register, reads_open, LOOPBACK_NAMES)
        app = create_app(store, runner, access)
        server = BenchServer(app, runner, tls)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        url = f"{'https' if tls else 'http'}://127.0.0.1:{listener.getsockname()[1]}"
        headers = {"Authorization": f"Bearer {TOKEN}"}
        try:
            _wait_until_started(server, thread)
            base = f"{url}/api/v1"
            with (
                httpx.Client(base_url=base, headers=headers, timeout=60, verify=trust) as client,
                httpx.Client(base_url=base, timeout=60, verify=trust) as stranger,
            ):
                yield RunningService(url, store, runner, client, stranger, access)
        finally:
            server.end_streams()
            server.should_exit = True
            thread.join()


def _wait_until_started(server: BenchServer, thread: threading.Thread) -> None:
    """However long that takes: where it hangs, the test's own time limit shows what every thread does."""
    while not server.started:
        assert thread.is_alive(), "the service ended before it had started"
        time.sleep(0.01)
