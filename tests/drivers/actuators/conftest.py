"""A simulated device of a kind, and its driver. A test module says which kind, by a fixture or by parameters."""

import pytest

from tests.devices.device_process import device_process
from tests.drivers.actuators.kinds import PERIOD_S


@pytest.fixture(scope="module")
def kind(request):
    return request.param


@pytest.fixture(scope="module")
def running(kind):
    with device_process(kind.name, *kind.options) as made:
        yield made


@pytest.fixture
def device(running):
    yield running
    running.side.ask("repair")
    running.wait_for_power(False)
    running.side.hang_load(0.0, False)


@pytest.fixture
def drive(kind, device):
    made = kind.drive_of(device)
    made.open(PERIOD_S)
    yield made
    made.close()
