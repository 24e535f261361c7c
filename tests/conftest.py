"""What holds for all tests: one thread for linear algebra, signals that are heard, which tests the wall clock times."""

import atexit
import gc
import os
import shutil
import signal
import tempfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# the matrices are small, and waiting threads cost more than they save; read when numpy is imported
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# where services leave tokens for commands of the same user: not beside those of the user who runs the tests
os.environ["XDG_STATE_HOME"] = tempfile.mkdtemp(prefix="friction-bench-state-")
atexit.register(shutil.rmtree, os.environ["XDG_STATE_HOME"], ignore_errors=True)

# of what is imported nothing becomes garbage: a fifth of the collection of tests would go into looking through it
gc.disable()

# what is drawn at random takes longer where others are at work on the machine, which is no fault of a test
settings.register_profile("shared machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("shared machine")

# a shell that starts the tests in the background lets them, and every process of theirs, ignore Ctrl-C
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:  # nohup
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

HERE = Path(__file__).parent
CONFORMANCE = "drivers/conformance/"
# devices, services and browsers in processes of their own: they mostly wait, and run after the others
WALL_CLOCK = (
    "browser",
    "devices",
    "drivers",
    "service",
    "stopping",
    "cli/test_serve.py",
    "cli/test_stop.py",
    "control/test_clock.py",
    "runs/test_bench_process.py",
)
# of these, and of the drivers on real ports: what hangs on seconds, such as stops, leases and times to answer within;
# of the others, services compute and pages are waited for. Ends of runs have `make kills`
BY_SECONDS = (
    "browser/test_stop.py",
    "control/test_clock.py",
    "devices",
    "drivers",
    "runs/test_bench_process.py",
    "service/test_busy_stop.py",
    "service/test_experiments.py",
    "service/test_lateness.py",
    "service/test_lease.py",
    "service/test_limits.py",
    "service/test_live.py",
    "service/test_live_process.py",
    "service/test_tokens.py",
)
# as the Makefile and tests/steady.py ask with -m
OTHERS, TIMED, SECONDS = "not wall_clock and not virtual_time", "wall_clock", "by_seconds"


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Do not even import the files of which the marks asked for leave nothing: all together take as long as a test."""
    if not collection_path.is_relative_to(HERE):
        return None
    path, asked = collection_path.relative_to(HERE).as_posix(), config.getoption("markexpr")
    if asked == OTHERS and path.startswith(WALL_CLOCK):
        return True
    if asked == TIMED and collection_path.is_file() and not path.startswith(WALL_CLOCK):
        return b"mark.wall_clock" not in collection_path.read_bytes()
    if asked == SECONDS and collection_path.is_file() and not path.startswith(BY_SECONDS):
        return True
    return None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what the wall clock times, and what virtual time does."""
    for item in items:
        path = item.path.relative_to(HERE).as_posix()
        if path.startswith(CONFORMANCE) and item.get_closest_marker("wall_clock") is None:
            item.add_marker(pytest.mark.virtual_time)
        if path.startswith(WALL_CLOCK) and (
            item.get_closest_marker("virtual_time") is None or _is_on_a_real_wire(item)
        ):
            item.add_marker(pytest.mark.wall_clock)
            if path.startswith(BY_SECONDS):
                item.add_marker(pytest.mark.by_seconds)


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop() -> None:
    """From here on there is garbage; what has been imported is not looked through for it."""
    gc.freeze()
    gc.enable()


def _is_on_a_real_wire(item: pytest.Item) -> bool:
    """Whether it is run in real time, too: always, or on the benches that its marker names."""
    from tests.spread import bench_of

    return any(not one.args or bench_of(item.name) in one.args for one in item.iter_markers("real_wire"))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> object:
    """Which tests stay in one process, where they are spread over several."""
    from tests.spread import FileAndBench

    return FileAndBench(config, log)
