"""How long the command line takes to start: `python -m tests.cli.start_times`.

Each line is the shortest of several runs in turn, since other work on the machine can only make a run longer. Of the
service it is the time of the processor, its bench process included, until the first page has been answered.
"""

import os
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import httpx

ROUNDS = 15
ASKED_S = 0.3
ASKED_RATIO = 8.0
SERVE_ROUNDS = 5
ASKED_SERVE_S = 1.2
ASKED_TRIALS_S = 0.5
TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")
LOOK_EVERY_S = 0.02
UP_WITHIN_S = 60.0
COMMANDS = {
    "python -c pass": (sys.executable, "-c", "pass"),
    "friction-bench --help": (str(Path(sys.executable).with_name("friction-bench")), "--help"),
    "friction-bench run --help": (str(Path(sys.executable).with_name("friction-bench")), "run", "--help"),
}


def shortest_s() -> dict[str, float]:
    """The shortest time of each command from start to end [s]."""
    found = dict.fromkeys(COMMANDS, float("inf"))
    for _ in range(ROUNDS):
        for name, words in COMMANDS.items():
            begin_s = time.perf_counter()
            subprocess.run(words, stdout=subprocess.DEVNULL, check=True)
            found[name] = min(found[name], time.perf_counter() - begin_s)
    return found


def first_page_cpu_s() -> float:
    """Time of the processor from `friction-bench serve` to the first page, on a new store [s]."""
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    with tempfile.TemporaryDirectory() as folder:
        program = str(Path(sys.executable).with_name("friction-bench"))
        words = [program, "--store", f"{folder}/bench.sqlite", "serve", "--port", str(port)]
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, cwd=folder)
        try:
            _first_page(f"http://127.0.0.1:{port}/")
            return _cpu_s(process.pid)
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait(UP_WITHIN_S)


def trials_cpu_s() -> float:
    """Time of the processor of `friction-bench trials`, on a store of one experiment: the shortest of several [s]."""
    with tempfile.TemporaryDirectory() as folder:
        program = [str(Path(sys.executable).with_name("friction-bench")), "--store", f"{folder}/bench.sqlite"]
        subprocess.run([*program, "run", "steps", "--repeats", "3", "--json"], stdout=subprocess.DEVNULL, check=True)
        found = []
        for _ in range(ROUNDS):
            before_s = _children_s()
            subprocess.run([*program, "trials"], stdout=subprocess.DEVNULL, check=True)
            found.append(_children_s() - before_s)
        return min(found)


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _first_page(url: str) -> None:
    deadline_s = time.monotonic() + UP_WITHIN_S
    while True:
        try:
            httpx.get(url).raise_for_status()
            return
        except httpx.TransportError:
            if time.monotonic() > deadline_s:
                raise
            time.sleep(LOOK_EVERY_S)


def _cpu_s(process_id: int) -> float:
    """Of a process and all that it has started, so far [s]; from proc(5)."""
    place = Path("/proc") / str(process_id)
    after_name = place.joinpath("stat").read_text().rpartition(")")[2].split()
    children = [one for task in place.glob("task/*/children") for one in task.read_text().split()]
    return (int(after_name[11]) + int(after_name[12])) * TICK_S + sum(_cpu_s(int(one)) for one in children)


def main() -> None:
    """Print the times, and what is asked of the help."""
    found = shortest_s()
    base_s = found["python -c pass"]
    for name, time_s in found.items():
        print(f"{name:28} {time_s:6.3f} s   {time_s / base_s:5.1f} x python -c pass")
    print(f"asked of --help: at most {ASKED_S} s, and {ASKED_RATIO:g} x python -c pass")
    print(f"{'friction-bench trials':28} {trials_cpu_s():6.2f} s of CPU; asked: at most {ASKED_TRIALS_S} s")
    serve_s = min(first_page_cpu_s() for _ in range(SERVE_ROUNDS))
    print(f"{'friction-bench serve':28} {serve_s:6.2f} s of CPU to the first page; asked: at most {ASKED_SERVE_S} s")


if __name__ == "__main__":
    main()
