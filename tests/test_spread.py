"""How tests are spread over processes."""

import pytest

from tests.drivers.conformance.benches import BENCHES
from tests.paths import ROOT
from tests.spread import LONG, bench_of


@pytest.mark.parametrize(
    ("name", "bench"),
    [
        ("test_x[sim-nan]", "sim"),
        ("test_x[canopen-socketcand-drive-failed]", "canopen-socketcand"),
        ("test_x[canopen-drive-failed]", "canopen"),
        ("test_x[0-modbus-tcp]", "modbus-tcp"),
        ("test_x", ""),
        ("test_x[simple]", ""),
    ],
)
def test_a_conformance_test_stays_with_its_bench(name: str, bench: str) -> None:
    assert bench_of(name) == bench


@pytest.mark.parametrize("scope", LONG)
def test_what_is_begun_first_is_there(scope: str) -> None:
    assert scope in BENCHES or (ROOT / scope).is_file()
