from collections.abc import Iterator

import pytest

from tests.devices.turns import turns


@pytest.fixture(scope="package", autouse=True)
def _turns() -> Iterator[None]:
    """Drivers are timed against the wall clock: their tests ask for turns of the processor."""
    with turns():
        yield
