from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest

from tests.fuzz.asking import ANSWERS, LONGEST_S
from tests.service.running_service import RunningService, running_service

COUNTED: Counter[str] = Counter()


@pytest.fixture(scope="package")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningService]:
    """A service with something to read: with it, small numbers in paths name what is there."""
    with running_service(tmp_path_factory.mktemp("fuzz")) as service:
        service.start("steps", repeats=1)
        assert service.runner.wait(LONGEST_S)
        yield service


def pytest_sessionfinish(session: pytest.Session) -> None:
    """A process of pytest-xdist hands over what it has counted."""
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["answers"] = dict(ANSWERS)
    else:
        COUNTED.update(ANSWERS)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Such a process has ended."""
    COUNTED.update(getattr(node, "workeroutput", {}).get("answers", {}))


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say how much was asked."""
    if COUNTED:
        parts = ", ".join(f"{number} of {status}" for status, number in sorted(COUNTED.items()))
        terminalreporter.write_line(f"fuzz: {COUNTED.total()} requests answered: {parts}; 5xx: {COUNTED['5xx']}")
