"""`python -m tests.steady [RUNS] [--pause-ms MS]`: tests that hang on seconds, many times in a row; which fails when.

They are those of `make test-services` and `make test-drivers` that tests/conftest.py marks so. Printed is a row for a
run of a part, and at the end how often each test has failed; what it said is in out/steady. A race shows in one run of
many, and sooner where processes are paused at times: it is mended, no test is tried twice.
"""

import argparse
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

from tests.devices.turns import are_granted
from tests.paths import ROOT
from tests.pauses import paused_at_times

RUNS = 20
OUT = ROOT / "out" / "steady"
# one after the other, in as many processes as in `make test`
PARTS = {"services": ("2", "--ignore=tests/drivers"), "drivers": ("3" if are_granted() else "2", "tests/drivers")}


def failed_of(report: Path) -> tuple[int, list[str]]:
    """How many tests of a report there were, and the names of those that failed."""
    cases = list(ElementTree.parse(report).iter("testcase"))
    return len(cases), [
        f"{case.get('classname')}::{case.get('name')}"
        for case in cases
        if case.find("failure") is not None or case.find("error") is not None
    ]


def run(part: str, number: int, pause_s: float) -> list[str]:
    """Run a part once, and print its row; the names of the tests that failed."""
    name = f"{part}-{number:02}"
    report = OUT / f"{name}.xml"
    report.unlink(missing_ok=True)
    processes, where = PARTS[part]
    words = [
        sys.executable,
        "-m",
        "pytest",
        f"--numprocesses={processes}",
        "-m",
        "by_seconds",
        where,
        f"--junitxml={report}",
    ]
    began_s = time.monotonic()
    with (OUT / f"{name}.log").open("w", encoding="utf-8") as log:
        tests = subprocess.Popen(words, cwd=ROOT, stdout=log, stderr=subprocess.STDOUT)
        with paused_at_times(tests.pid, pause_s, seed=number):
            status = tests.wait()
    count, failed = failed_of(report) if report.exists() else (0, [f"no report of {name}"])
    if status and not failed:
        failed = [f"pytest ended with {status} in {name}"]
    took_s = time.monotonic() - began_s
    print(f"{number:3} {part:<10} {count:5} {len(failed):6} {took_s:6.0f} s  {', '.join(failed)}", flush=True)
    return failed


def main(runs: int, pause_s: float) -> int:
    """Run every part so many times; 0 where no test has failed."""
    OUT.mkdir(parents=True, exist_ok=True)
    print(f"run {'part':<10} {'tests':>5} {'failed':>6} {'took':>8}", flush=True)
    ended = [(run(part, number, pause_s), number) for number in range(1, runs + 1) for part in PARTS]
    failures = Counter(name for failed, _ in ended for name in failed)
    green = runs - len({number for failed, number in ended if failed})
    print(f"{green} of {runs} runs in which no test failed")
    for name, count in failures.most_common():
        print(f"{count:3} {name}")
    return int(bool(failures))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", type=int, nargs="?", default=RUNS)
    parser.add_argument("--pause-ms", type=float, default=0.0, help="stop one process for so long, ten times a second")
    arguments = parser.parse_args()
    sys.exit(main(arguments.runs, arguments.pause_ms / 1000.0))
