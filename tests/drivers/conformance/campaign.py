"""What a user runs on a bench, one after the other: commissioning, a step to 90 degrees, a small load sweep. It goes
through the runner, with a person who does what is asked through the device's side channel.

On a port of the operating system, in real time, the sweep has one load, and is all there is beside commissioning: what
a port adds does not hang on how much is measured. A step on such a port is begun in `test_faults`.
"""

import threading
from math import pi

from bench.errors import NotCommissionedError
from bench.runs.runner import Runner
from bench.store import Store
from tests.devices.device_process import IS_VIRTUAL
from tests.drivers.conformance.paced import paced_drives

STEP_LOAD_KG = 0.05
LOADS_KG = (0.0, STEP_LOAD_KG, 0.1) if IS_VIRTUAL else (STEP_LOAD_KG,)
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
        with paced_drives(), Store.open(f"sqlite:///{folder / 'bench.sqlite'}") as store:
            runner = Runner(bench.configuration, store)
            person = Person(bench, runner)
            try:
                self.refusal = self._refusal(runner)
                self.commissioning = self._run(runner, store, "commissioning")
                self.steps = self._steps(runner, store) if IS_VIRTUAL else None
                self.sweep = self._run(runner, store, "load-sweep", loads_kg=LOADS_KG, angles_rad=(pi / 2,), searches=1)
            finally:
                runner.close()
                person.leave()
            self.asked = person.asked

    def ran(self):
        return [found for found in (self.commissioning, self.steps, self.sweep) if found is not None]

    def _steps(self, runner, store):
        speeds = {"slowest_rad_s": 2.0, "fastest_rad_s": 2.0}
        return self._run(runner, store, "steps", repeats=1, load_kg=STEP_LOAD_KG, **speeds)

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
