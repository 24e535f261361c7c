"""What many listeners of the live stream cost: `python -m tests.service.listeners 1000`.

Half of them never read. Beside them a real-time run is started, `GET /bench` is asked twenty times, and STOP once.
"""

import selectors
import socket
import statistics
import sys
import tempfile
import threading
import time
from pathlib import Path

import httpx

from tests.service.running_service import TOKEN
from tests.service.served_process import served_process

ASKED = 20


def _opened(port: int, count: int) -> list[socket.socket]:
    request = b"GET /api/v1/live HTTP/1.1\r\nHost: localhost\r\n\r\n"
    found = []
    for _ in range(count):
        found.append(socket.create_connection(("127.0.0.1", port), timeout=30.0))
        found[-1].sendall(request)
    return found


def _read(sockets: list[socket.socket], over: threading.Event) -> None:
    with selectors.DefaultSelector() as selector:
        for one in sockets:
            one.setblocking(False)
            selector.register(one, selectors.EVENT_READ)
        while not over.is_set():
            for key, _ in selector.select(0.1):
                key.fileobj.recv(65536)  # type: ignore[union-attr]


def _trials(client: httpx.Client, experiment_id: int) -> list[dict[str, float]]:
    """What the trials of an experiment say of themselves, once it has ended."""
    while client.get(f"/experiments/{experiment_id}").json()["outcome"] == "running":
        time.sleep(0.05)
    listed = client.get("/trials", params={"experiment_id": experiment_id}).json()["items"]
    return [client.get(f"/trials/{one['trial_id']}").json()["results"] for one in listed]


def main() -> None:
    """Print how long the service took to answer."""
    count, over = int(sys.argv[1]), threading.Event()
    with tempfile.TemporaryDirectory() as folder, served_process(Path(folder)) as url:
        client = httpx.Client(base_url=f"{url}/api/v1", headers={"Authorization": f"Bearer {TOKEN}"}, timeout=30.0)
        sockets = _opened(int(url.rpartition(":")[2]), count)
        reader = threading.Thread(target=_read, args=(sockets[::2], over))
        reader.start()
        started = {"kind": "steps", "parameters": {"repeats": 20}, "pace": "real-time"}
        begun = client.post("/experiments", json=started).raise_for_status().json()["experiment_id"]
        time.sleep(2.0)
        took_s = []
        for _ in range(ASKED):
            began = time.perf_counter()
            client.get("/bench").raise_for_status()
            took_s.append(time.perf_counter() - began)
            time.sleep(0.1)
        began = time.perf_counter()
        client.post("/stop").raise_for_status()
        stopped_s = time.perf_counter() - began
        trials = _trials(client, begun)
        over.set()
        reader.join()
        for one in sockets:
            one.close()
    print(f"{count} listeners: GET /bench median {statistics.median(took_s):.3f} s, longest {max(took_s):.3f} s; "
          f"STOP {stopped_s:.3f} s; cycles lost {sum(one['overruns'] for one in trials):g} of "
          f"{sum(one['cycles'] for one in trials):g}")  # fmt: skip


if __name__ == "__main__":
    main()
