"""Counts requests, and lets a long run go on where it was ended.

In a long run, a line of out/fuzz/passed.txt tells of each part that has passed; what others said is beside it. The next
long run leaves out the parts with a line. `make fuzz` takes the file away when all have passed.
"""

import json
import os
import re
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.fuzz.asking import ANSWERS, LONGEST_S
from tests.fuzz.effort import TIMES
from tests.paths import ROOT
from tests.service.running_service import RunningService, running_service

OUT = ROOT / "out" / "fuzz"
PASSED = OUT / "passed.txt"
HERE = "tests/fuzz/"
ANSWERED = "answered"

Parts = dict[str, dict[str, int]]
"""How many requests each part had answered, by class of the status."""


@pytest.fixture(scope="package")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningService]:
    """A service with something to read: with it, small numbers in paths name what is there."""
    with running_service(tmp_path_factory.mktemp("fuzz")) as service:
        service.start("steps", repeats=1)
        assert service.runner.wait(LONGEST_S)
        yield service


@pytest.fixture(autouse=True)
def _told(record_property: Callable[[str, object], None]) -> Iterator[None]:
    """What the part had answered goes with its report, also out of a process of pytest-xdist."""
    before = ANSWERS.copy()
    yield
    record_property(ANSWERED, dict(ANSWERS - before))


def noted() -> Parts:
    """The parts that have passed."""
    lines = PASSED.read_text(encoding="utf-8").splitlines() if TIMES > 1 and PASSED.exists() else []
    return dict(json.loads(line) for line in lines)


ENDED: Parts = noted()
FAILED: set[str] = set()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the parts that have passed."""
    config.hook.pytest_deselected(items=[item for item in items if item.nodeid in ENDED])
    items[:] = [item for item in items if item.nodeid not in ENDED]


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Note a part that has ended, at once where the run is long."""
    if not report.nodeid.startswith(HERE) or "PYTEST_XDIST_WORKER" in os.environ:  # whose parent gets the same report
        return
    if report.failed:
        FAILED.add(report.nodeid)
        _write(re.sub(r"\W+", "-", report.nodeid.removeprefix(HERE)) + ".txt", report.longreprtext)
    if report.when == "teardown":
        ENDED[report.nodeid] = dict(report.user_properties).get(ANSWERED, {})
        if report.nodeid not in FAILED:
            _write(PASSED.name, json.dumps([report.nodeid, ENDED[report.nodeid]]))


def _write(name: str, text: str) -> None:
    if TIMES > 1:
        OUT.mkdir(parents=True, exist_ok=True)
        with (OUT / name).open("a", encoding="utf-8") as file:
            file.write(text + "\n")


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say how much was asked."""
    counted = sum(map(Counter, ENDED.values()), Counter())
    if counted:
        parts = ", ".join(f"{number} of {status}" for status, number in sorted(counted.items()))
        told = f"{counted.total()} requests answered in {len(ENDED)} parts: {parts}; 5xx: {counted['5xx']}"
        terminalreporter.write_line(f"fuzz: {told}")
