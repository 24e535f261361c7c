"""The same trials over every driver: commissioning, a step to 90 degrees, a small load sweep; through the runner, as a
user starts them. A person's part is done through the device's side channel.

All benches have the same joint behind them, so they have to find the same load. They cannot agree better than the
search resolves: one step of its ramp (8 mA) on each side, the steps of a drive's current sensor (10 mA), and what
friction scatters from one search to the next (the paper's own spread is 3 g, 15 mA here). A measured load is the true
one within 25 mA (5 g at the tip), and two drivers differ by no more.
"""

import threading
from math import pi

import pytest

from bench.errors import NotCommissionedError
from bench.runner import Runner
from bench.store import Store
from tests.drivers.conformance.benches import BENCHES

TOLERANCE_A = 0.025
LOADS_KG = (0.0, 0.05, 0.1)
STEP_LOAD_KG = 0.05
A_PER_KG = 9.80665 * 0.5 / (0.05 * 20.0)  # g L / (Kt N) of the preset `paper`


class Person:
    """Does what the runner asks for, as long as it runs."""

    def __init__(self, bench, runner):
        self._bench, self._runner, self._over = bench, runner, threading.Event()
        self.asked = []
        self._thread = threading.Thread(target=self._attend)
        self._thread.start()

    def _attend(self):
        while not self._over.wait(0.02):
            prompt = self._runner.status().prompt
            if prompt is not None:
                self.asked.append(prompt.sentence)
                self._bench.hang_as_asked(prompt.sentence)
                self._runner.answer(prompt.number)

    def leave(self):
        self._over.set()
        self._thread.join()


class Campaign:
    """Everything that was run on one bench."""

    def __init__(self, bench, folder):
        with Store.open(f"sqlite:///{folder / 'bench.sqlite'}") as store:
            runner = Runner(bench.configuration, store)
            person = Person(bench, runner)
            try:
                self.refusal = self._refusal(runner)
                self.commissioning = self._run(runner, store, "commissioning")
                self.steps = self._run(
                    runner, store, "steps", repeats=1, load_kg=STEP_LOAD_KG, slowest_rad_s=2.0, fastest_rad_s=2.0
                )
                self.sweep = self._run(runner, store, "load-sweep", loads_kg=LOADS_KG, angles_rad=(pi / 2,), searches=1)
            finally:
                runner.close()
                person.leave()
            self.asked = person.asked

    def _refusal(self, runner):
        try:
            runner.start("steps", {"repeats": 1})
        except NotCommissionedError as error:
            return str(error)
        runner.stop()
        runner.wait()
        return ""

    def _run(self, runner, store, kind, **parameters):
        runner.start(kind, parameters)
        assert runner.wait(120.0)
        found = store.experiments()[0]
        assert found.outcome == "completed", f"{kind}: {found.reason}"
        return found


@pytest.fixture(scope="module")
def campaigns(tmp_path_factory):
    """One campaign per bench, run when it is first asked for."""
    ran = {}

    def of(name):
        if name not in ran:
            with BENCHES[name]() as bench:
                ran[name] = Campaign(bench, tmp_path_factory.mktemp(name))
        return ran[name]

    return of


@pytest.mark.parametrize("name", BENCHES)
def test_each_trial_comes_to_its_end(campaigns, name):
    found = campaigns(name)
    for experiment in (found.commissioning, found.steps, found.sweep):
        assert experiment.source == "simulated"
        assert experiment.provenance["drive"]["product"]


@pytest.mark.parametrize("name", [name for name in BENCHES if name != "sim"])
def test_a_drive_on_a_wire_has_to_be_commissioned_and_its_load_hung(campaigns, name):
    found = campaigns(name)
    assert "friction-bench doctor --move" in found.refusal
    assert "sign" in found.commissioning.results["passed"]
    assert list(dict.fromkeys(found.asked)) == [
        "Take every load off the arm, and stand clear.",
        "Hang 50 g at the tip of the arm, and stand clear.",
        "Hang 100 g at the tip of the arm, and stand clear.",
    ]


@pytest.mark.parametrize("name", BENCHES)
def test_the_load_is_found_behind_friction(campaigns, name):
    found = campaigns(name)
    assert found.steps.results["mean_load_current_a"] == pytest.approx(STEP_LOAD_KG * A_PER_KG, abs=TOLERANCE_A)
    currents_a = {row["load_kg"]: row["load_current_a"] for row in found.sweep.results["rows"]}
    assert currents_a == pytest.approx({load_kg: load_kg * A_PER_KG for load_kg in LOADS_KG}, abs=TOLERANCE_A)


@pytest.mark.parametrize("name", [name for name in BENCHES if name != "sim"])
def test_results_are_those_of_the_in_process_simulation(campaigns, name):
    found, reference = campaigns(name), campaigns("sim")
    for row, wanted in zip(found.sweep.results["rows"], reference.sweep.results["rows"], strict=True):
        assert row["load_current_a"] == pytest.approx(wanted["load_current_a"], abs=TOLERANCE_A)
        assert row["friction_current_a"] == pytest.approx(wanted["friction_current_a"], abs=2.0 * TOLERANCE_A)
