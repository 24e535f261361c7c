"""The map of a real, published drive, a Roboteq, over the wire: the same trials as over every driver.

Its simulated counterpart answers one value a request, as the maker's data sheet prints the frames, tells currents in
steps of 0.1 A and stops by a watchdog that has no register. A current is known to half a step each way; what is left of
it in the mean of two directions is added to the tolerance of the other drivers.
"""

import time
from contextlib import contextmanager

import pytest

from drivers.contract import Command, Mode, Status
from drivers.errors import DriveError, WatchdogError
from tests.devices.device_process import IS_VIRTUAL, device_process
from tests.drivers.conformance.benches import ANSWER_TIMEOUT_S, PATIENT, PERIOD_S, Bench, configured
from tests.drivers.conformance.campaign import A_PER_KG, STEP_LOAD_KG, Campaign
from tests.drivers.conformance.test_trials import TOLERANCE_A

pytestmark = pytest.mark.virtual_time
DEVICE = ("modbus", "--map", "roboteq", "--transport", "rtu" if IS_VIRTUAL else "tcp", "--baud", "0")
CURRENT_STEP_A = 0.1
OFF = Command(Mode.OFF)


@contextmanager
def roboteq(device, **settings):
    values = {**device.drive, "answer_timeout_s": ANSWER_TIMEOUT_S} | settings
    yield Bench("roboteq", configured(**values), device)


@pytest.fixture(scope="module")
def device():
    with device_process(*DEVICE) as running:
        yield running


@pytest.fixture
def bench(device):
    with roboteq(device) as made:
        yield made
        made.repair()


def test_trials(tmp_path):
    with device_process(*DEVICE, *PATIENT) as device, roboteq(device) as bench:
        found = Campaign(bench, tmp_path)
    assert "sign" in found.commissioning.results["passed"]
    assert found.steps.provenance["drive"]["vendor"] == "Roboteq"
    tolerance_a = TOLERANCE_A + 0.5 * CURRENT_STEP_A
    assert found.steps.results["mean_load_current_a"] == pytest.approx(STEP_LOAD_KG * A_PER_KG, abs=tolerance_a)
    for row in found.sweep.results["rows"]:
        assert row["load_current_a"] == pytest.approx(row["load_kg"] * A_PER_KG, abs=tolerance_a)


@pytest.mark.real_wire
def test_its_own_watchdog_stops_it(bench):
    with bench.opened() as drive:
        drive.enable(Mode.DUTY)
        before_s = time.monotonic()
        drive.exchange(Command(Mode.DUTY, 0.15))
        bench.device.wait_for_power(True)
        off_s = bench.device.wait_for_power(False)
        assert 0.5 * bench.watched_s < off_s - before_s < bench.watched_s + 0.3
        assert drive.exchange(OFF).status is Status.DISABLED


def test_a_watchdog_that_nobody_vouches_for_is_refused(device):
    refusal = pytest.raises(WatchdogError, match=r"Set it to 1 s with the drive's own tools")
    with roboteq(device, watchdog_is_set_in_drive=False) as bench, bench.drive() as drive, refusal:
        drive.open(PERIOD_S)


def test_another_map_than_its_own_is_refused(device):
    refusal = pytest.raises(DriveError, match=r"device \(holding registers 200 .. 200\)")
    with roboteq(device, map="friction-bench") as bench, bench.drive() as drive, refusal:
        drive.open(PERIOD_S)
    assert not device.truth()["powered"]
