"""`friction-bench paper`."""

import json

import pytest

from bench.evaluation.paper import reproduction
from bench.evaluation.paper.measurements import Plan
from tests.paper.test_reproduction import SWEEP

pytestmark = pytest.mark.timeout(300)  # seconds by itself; a shared machine may take minutes
TINY = Plan(
    loads_kg=(0.0, 0.1),
    steps=2,
    trials=1,
    speeds_rad_s=(3.0,),
    periods=1,
    speed_sweep=tuple(SWEEP.items()),
    reaches_rad=(1.2,),
    wall_reaches_rad=(0.83,),
    largest_force_scale=0.5,
)


@pytest.fixture(autouse=True)
def small(monkeypatch):
    monkeypatch.setattr(reproduction.reproduce, "__defaults__", (False, TINY, *reproduction.reproduce.__defaults__[2:]))


def test_the_same_seed_gives_the_same_numbers_and_another_seed_others(command):
    def numbers(seed, store):
        done = command("--store", store, "paper", "--json", "--seed", seed, "--report", "out.html")
        assert done.exit_code == 0, done.output
        return [row["ours"] for row in json.loads(done.stdout)["rows"]]

    one = numbers(3, "a.sqlite")
    assert numbers(3, "b.sqlite") == one
    assert numbers(4, "c.sqlite") != one


def test_without_trials_it_says_what_to_run(command):
    missing = command("paper", "--from-store", "--report", "out.html")
    assert missing.exit_code == 3
    assert "friction-bench paper" in missing.stderr
