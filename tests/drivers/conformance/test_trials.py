"""The same trials over every driver: commissioning, a step to 90 degrees, a small load sweep; through the runner, as a
user starts them. A person's part is done through the device's side channel.

All benches have the same joint behind them, so they have to find the same load. They cannot agree better than the
search resolves: one step of its ramp (8 mA) on each side, the steps of a drive's current sensor (10 mA), and what
friction scatters from one search to the next (the paper's own spread is 3 g, 15 mA here). A measured load is the true
one within 25 mA (5 g at the tip), and two drivers differ by no more.
"""

import pytest

from tests.drivers.conformance.benches import BENCHES, PATIENT
from tests.drivers.conformance.campaign import A_PER_KG, LOADS_KG, STEP_LOAD_KG, Campaign

TOLERANCE_A = 0.025
pytestmark = pytest.mark.real_wire("roboclaw", "canopen-socketcand")  # a serial port, and the network


@pytest.fixture(scope="module")
def campaigns(tmp_path_factory):
    """One campaign per bench, run when it is first asked for."""
    ran = {}

    def of(name):
        if name not in ran:
            with BENCHES[name](*PATIENT) as bench:
                ran[name] = Campaign(bench, tmp_path_factory.mktemp(name))
        return ran[name]

    return of


@pytest.mark.parametrize("name", BENCHES)
def test_each_trial_comes_to_its_end(campaigns, name):
    for experiment in campaigns(name).ran():
        assert experiment.source == "simulated"
        assert experiment.provenance["drive"]["product"]


@pytest.mark.parametrize("name", [name for name in BENCHES if name != "sim"])
def test_a_drive_on_a_wire_has_to_be_commissioned_and_its_load_hung(campaigns, name):
    found = campaigns(name)
    assert "friction-bench doctor --move" in found.refusal
    assert "sign" in found.commissioning.results["passed"]
    assert list(dict.fromkeys(found.asked)) == [
        "Take every load off the arm, and stand clear.",
        *(f"Hang {1e3 * load_kg:g} g at the tip of the arm, and stand clear." for load_kg in LOADS_KG if load_kg),
    ]


@pytest.mark.parametrize("name", BENCHES)
def test_the_load_is_found_behind_friction(campaigns, name):
    found = campaigns(name)
    if found.steps is not None:
        assert found.steps.results["mean_load_current_a"] == pytest.approx(STEP_LOAD_KG * A_PER_KG, abs=TOLERANCE_A)
    currents_a = {row["load_kg"]: row["load_current_a"] for row in found.sweep.results["rows"]}
    assert currents_a == pytest.approx({load_kg: load_kg * A_PER_KG for load_kg in LOADS_KG}, abs=TOLERANCE_A)


@pytest.mark.parametrize("name", [name for name in BENCHES if name != "sim"])
def test_results_are_those_of_the_in_process_simulation(campaigns, name):
    found, reference = campaigns(name), campaigns("sim")
    for row, wanted in zip(found.sweep.results["rows"], reference.sweep.results["rows"], strict=True):
        assert row["load_current_a"] == pytest.approx(wanted["load_current_a"], abs=TOLERANCE_A)
        assert row["friction_current_a"] == pytest.approx(wanted["friction_current_a"], abs=2.0 * TOLERANCE_A)
