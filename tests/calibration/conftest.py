"""A store with a small speed sweep and load sweep of the simulated bench."""

import pytest

from bench.config.configuration import default_configuration
from bench.runs.runner import Runner
from bench.store import Store

LOADS_KG = (0.0, 0.1)
SWEEP = {
    "loads_kg": LOADS_KG, "currents_a": (0.3,), "duties": (0.2,), "speeds_rad_s": (0.03, 0.1, 0.3, 0.6, 1.5),
    "strokes": 3,
}  # fmt: skip
SEARCH = {"loads_kg": LOADS_KG, "angles_rad": (0.0,), "searches": 1}


@pytest.fixture(scope="package")
def configuration():
    return default_configuration()


@pytest.fixture(scope="package")
def store(configuration, tmp_path_factory):
    path = tmp_path_factory.mktemp("calibration") / "bench.sqlite"
    with Store.open(f"sqlite:///{path}") as opened:
        runner = Runner(configuration, opened)
        for kind, parameters in (("speed-sweep", SWEEP), ("load-sweep", SEARCH)):
            runner.start(kind, parameters, pace="fast")
            runner.wait()
        runner.close()
        assert [one.outcome for one in opened.experiments()] == ["completed", "completed"]
        yield opened
