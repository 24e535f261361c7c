"""How long STOP takes while others ask for too much: `python -m tests.service.attacks [TIMES]`.

Eight senders at once and without a pause, each of one kind of body: as large as allowed, nested, one long number, many
numbers that are almost too long, many short lists, or one that never comes. The service is a process of its own, with
a run in real time. Allowed are 0.2 s.
"""

import socket
import statistics
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from urllib.parse import urlsplit

import httpx

from bench.service.http.limits import LONGEST_S, MOST_BYTES, MOST_DIGITS
from tests.devices.turns import turns
from tests.service.running_service import TOKEN
from tests.service.served_process import served_process

STOPPED_WITHIN_S = 0.2
SENDERS = 8
BODIES = {
    "large": b" " * MOST_BYTES,
    "deep": b"[" * MOST_BYTES,
    "digits": b"9" * MOST_BYTES,
    "numbers": b"[" + (b"9" * MOST_DIGITS + b",") * (MOST_BYTES // (MOST_DIGITS + 1) - 1) + b"9]",
    "wide": b"[" + b"[]," * (MOST_BYTES // 3 - 1) + b"9]",
    "slow": b"",
}
STEPS = {"kind": "steps", "parameters": {"repeats": 20}, "pace": "real-time"}


@contextmanager
def under_attack(url: str, attack: str) -> Iterator[None]:
    """Many senders of one of `BODIES`, until it is left."""
    address, over, body = urlsplit(url), threading.Event(), BODIES[attack]
    head = (
        "POST /api/v1/experiments HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        f"Authorization: Bearer {TOKEN}\r\nContent-Length: {len(body) or 1000}\r\n\r\n"
    )

    def send() -> None:
        while not over.is_set():
            with (
                suppress(ConnectionError),
                socket.create_connection((address.hostname, address.port), timeout=LONGEST_S) as connection,
            ):
                connection.sendall(head.encode() + body)
                over.wait(5.0) if attack == "slow" else connection.recv(1000)

    threads = [threading.Thread(target=send, daemon=True) for _ in range(SENDERS)]
    for thread in threads:
        thread.start()
    time.sleep(0.5)
    yield
    over.set()
    for thread in threads:
        thread.join(10.0)


def stopped_s(client: httpx.Client) -> float:
    """How long STOP takes until it is answered [s]."""
    with turns():  # whoever asks is quick: what other programs take of the machine is no matter of the service's
        began_s = time.perf_counter()
        answer = client.post("/stop")
        took_s = time.perf_counter() - began_s
    assert answer.json()["was_running"] is True, "nothing ran that could be stopped"
    return took_s


def stopped_under(client: httpx.Client, url: str, attack: str) -> float:
    """How long STOP takes under one of `BODIES` until it is answered [s]; the bench is idle before and after."""
    client.post("/experiments", json=STEPS).raise_for_status()
    with under_attack(url, attack):
        took_s = stopped_s(client)
    while client.get("/bench").json()["state"] == "running":
        time.sleep(0.05)
    return took_s


def main(times: int) -> int:
    """Print how long it took under each attack; 0 where it was never longer than allowed."""
    headers, late = {"Authorization": f"Bearer {TOKEN}"}, 0
    with (
        tempfile.TemporaryDirectory() as folder,
        served_process(Path(folder)) as url,
        httpx.Client(base_url=f"{url}/api/v1", headers=headers, timeout=60.0) as client,
    ):
        for attack in BODIES:
            took_s = [stopped_under(client, url, attack) for _ in range(times)]
            quick = sum(one <= STOPPED_WITHIN_S for one in took_s)
            late += times - quick
            print(f"{attack:<8} {quick} of {times} within {STOPPED_WITHIN_S:g} s; median "
                  f"{statistics.median(took_s):.3f} s, longest {max(took_s):.3f} s", flush=True)  # fmt: skip
    return int(late > 0)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 20))
