"""How tests are spread over processes: those of one file stay together, as they share what is slow to start.

Conformance tests share the simulated device of one bench, so there it is those of one bench. What is drawn at random
takes long where much is drawn (`make fuzz`): there, each goes where there is room. Files whose few tests take longest
are begun first: at the end one process would be left alone with them.
"""

import re
from functools import cache

from xdist.scheduler import LoadScopeScheduling
from xdist.workermanage import WorkerController

from tests.fuzz.effort import TIMES

CONFORMANCE = "tests/drivers/conformance/"
FUZZ = "tests/fuzz/"
LONG = (
    "canopen-socketcand",
    "modbus-tcp",
    "roboclaw",
    "canopen",
    "tests/drivers/test_follow.py",
    "tests/drivers/actuators/test_follow.py",
    "tests/drivers/canopen/test_faults.py",
    "tests/drivers/actuators/test_twins.py",
    "tests/drivers/odrive/test_foreign_peer.py",
    "tests/browser/test_walk.py",
    "tests/browser/test_tour.py",
    "tests/stopping/test_commission.py",
    "tests/browser/test_simulated_trials.py",
    "tests/lab/diagnosis/test_diagnose.py",
    "tests/recordings/test_explain.py",
    "tests/lab/diagnosis/test_search.py",
    "tests/second_plant/test_recording.py",
    "tests/docs/test_tutorial.py",
    "tests/commission/test_draws.py",
    "tests/lab/diagnosis/test_bad_input.py",
    "tests/blind/test_run.py",
    "tests/second_plant/test_second_judge.py",
    "tests/lab/next_trial/test_suggestion.py",
    "tests/parallel/test_cluster.py",
    "tests/queue/test_over_wires.py",
    "tests/cli/test_paper.py",
    "tests/lab/units/test_units.py",
    "tests/study/test_suggest.py",
    "tests/study/test_bad_input.py",
    "tests/cli/test_calibrate.py",
    "tests/lab/diagnosis/test_families.py",
    "tests/lab/effects/test_effort_filter.py",
    "tests/cli/test_study.py",
    "tests/lab/screening/test_noise.py",
    "tests/lab/diagnosis/test_bending.py",
    "tests/recording_set/test_round_trip.py",
    "tests/store/test_repair.py",
    "tests/cli/test_run.py",
    "tests/store/test_chain.py",
    "tests/study/test_coverage.py",
    "tests/compensator/test_friction_calibration.py",
    "tests/store/test_trials.py",
    "tests/lab/effects/test_supply_sag.py",
)
"""Those that `--durations` names most, the longest first; of conformance tests, their bench."""


class FileAndBench(LoadScopeScheduling):
    """Which tests go to the same process."""

    def _assign_work_unit(self, node: WorkerController) -> None:
        long = next((scope for scope in LONG if scope in self.workqueue), None)
        if long is not None:
            self.workqueue.move_to_end(long, last=False)
        super()._assign_work_unit(node)

    def _split_scope(self, nodeid: str) -> str:
        if nodeid.startswith(FUZZ) and TIMES > 1:
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
