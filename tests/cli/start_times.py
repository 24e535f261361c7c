"""How long the command line takes to start: `python -m tests.cli.start_times`.

Each line is the shortest of several runs in turn, since other work on the machine can only make a run longer.
"""

import subprocess
import sys
import time
from pathlib import Path

ROUNDS = 15
ASKED_S = 0.3
ASKED_RATIO = 8.0
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


def main() -> None:
    """Print the times, and what is asked of the help."""
    found = shortest_s()
    base_s = found["python -c pass"]
    for name, time_s in found.items():
        print(f"{name:28} {time_s:6.3f} s   {time_s / base_s:5.1f} x python -c pass")
    print(f"asked of --help: at most {ASKED_S} s, and {ASKED_RATIO:g} x python -c pass")


if __name__ == "__main__":
    main()
