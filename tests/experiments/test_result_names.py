"""The reference names every result that a trial has."""

import pytest

from bench.config.configuration import default_configuration
from bench.experiments.kind import RESULTS_OF_ALL
from bench.experiments.registry import KINDS, find_kind
from docs.generate import experiments
from tests.experiments.bench_run import Ran

RUN = {
    "steps": {"repeats": 1},
    "load-sweep": {"loads_kg": (0.05,), "repeats": 1},
    "breakaway-ramps": {},
    "reversals": {},
    "chirp": {},
    "multisine": {},
    "coast-down": {},
    "hold-and-soak": {},
    "excitation": {"loads_kg": (0.0,)},
    "identification": {},
    "commissioning": {},
    "speed-sweep": {"loads_kg": (0.0,), "currents_a": (0.3,), "duties": (), "speeds_rad_s": (1.0,)},
}


@pytest.mark.parametrize("name", RUN)
def test_every_result_of_a_trial_is_named_with_what_it_is(name):
    kind = find_kind(name)
    ran = Ran(default_configuration(), name, **RUN[name])
    found = {result for outcome in ran.outcomes for result in outcome.results}
    assert found
    assert found <= kind.results.keys()
    assert all(f"| `{result}` |" in experiments._results(kind) for result in found)


def test_every_kind_names_its_results():
    assert all(kind.results for kind in KINDS.values())
    page = experiments.page()
    assert page.count("\nResults of a trial:\n") == len(KINDS)
    assert page.count(f"| `cycles` |  | {RESULTS_OF_ALL['cycles']} |") == len(KINDS)
    assert "half the sum of these two (paper, eq. 9)" in page
