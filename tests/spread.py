"""How tests are spread over processes: those of one file stay together, as they share what is slow to start.

Conformance tests share the simulated device of one bench, so there it is those of one bench. What is drawn at random
shares a service, and takes long where much is drawn: each goes where there is room.
"""

import re
from functools import cache

from xdist.scheduler import LoadScopeScheduling

CONFORMANCE = "tests/drivers/conformance/"
FUZZ = "tests/fuzz/"


class FileAndBench(LoadScopeScheduling):
    """Which tests go to the same process."""

    def _split_scope(self, nodeid: str) -> str:
        if nodeid.startswith(FUZZ):
            return nodeid
        path, _, name = nodeid.partition("::")
        return bench_of(name) or path if path.startswith(CONFORMANCE) else path


def bench_of(name: str) -> str:
    """The bench that a conformance test runs on; empty where it names none.

    Args:
        name: of the test, such as "test_trials[modbus-tcp]".
    """
    parameters = re.split(r"\[|\]", name)[1:2]
    parts = "".join(parameters).split("-")
    found = [bench for bench in _benches() if _is_within(bench.split("-"), parts)]
    return max(found, key=len, default="")


def _is_within(wanted: list[str], parts: list[str]) -> bool:
    return any(parts[start : start + len(wanted)] == wanted for start in range(len(parts)))


@cache
def _benches() -> tuple[str, ...]:
    from tests.drivers.conformance.benches import BENCHES

    return tuple(BENCHES)
