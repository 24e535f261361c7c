from collections.abc import Iterator
from contextlib import nullcontext

import pytest

from tests.devices.device_process import IS_VIRTUAL
from tests.devices.turns import turns


@pytest.fixture(scope="package", autouse=True)
def _turns() -> Iterator[None]:
    """Drivers are timed against the wall clock: their tests ask for turns of the processor. In virtual time none is."""
    with nullcontext() if IS_VIRTUAL else turns():
        yield
