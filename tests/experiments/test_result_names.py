"""The reference names every result that a trial has."""

import pytest

from bench.experiments.kind import RESULTS_OF_ALL
from bench.experiments.registry import KINDS, find_kind
from docs.generate import experiments
from tests.experiments.bench_run import Ran
from tests.experiments.calibrated import calibrated_configuration
from tests.experiments.test_experiments import NEEDED

# parameters with which a kind is quickly done; others run with their defaults, or with what they need
QUICK = {
    "steps": {"repeats": 1},
    "load-sweep": {"loads_kg": (0.05,), "repeats": 1},
    "steady-speeds": {"speeds_rad_s": (1.0,)},
    "excitation": {"loads_kg": (0.0,)},
    "speed-sweep": {"loads_kg": (0.0,), "currents_a": (0.3,), "duties": (), "speeds_rad_s": (1.0,)},
    **NEEDED,
}
OF_ONE_JOINT = [name for name, kind in KINDS.items() if not kind.pair]


@pytest.fixture(scope="module")
def configuration():
    """Of a joint whose friction is known, which some kinds need."""
    return calibrated_configuration(seed=11)


@pytest.mark.parametrize("name", OF_ONE_JOINT)
def test_every_result_of_a_trial_is_named_with_what_it_is(configuration, name):
    kind = find_kind(name)
    ran = Ran(configuration, name, **QUICK.get(name, {}))
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
