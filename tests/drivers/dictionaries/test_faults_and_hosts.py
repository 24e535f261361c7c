"""Fault resets at slow drives, and other hosts on the bus."""

import pytest

from drivers.errors import DriveConnectionError
from tests.drivers.dictionaries.attempt import PERIOD_S, device, host
from tests.drivers.dictionaries.fault_reset import TICKS_MS, resets
from tests.drivers.dictionaries.traits import TRAITS
from tests.drivers.dictionaries.two_hosts import WAYS, Running


@pytest.fixture
def sheet(tmp_path):
    return TRAITS["plain"].write(tmp_path, "plain")


@pytest.mark.parametrize("tick_ms", TICKS_MS)
def test_a_drive_that_looks_now_and_then_is_reset_each_time(sheet, tick_ms) -> None:
    assert resets(sheet, tick_ms * 1e-3, tries=4) == 4


@pytest.mark.parametrize("way", WAYS)
def test_two_hosts_on_one_bus_are_refused_or_both_guarded(sheet, way) -> None:
    assert way(sheet, f"test-{way.__name__}").is_safe


def test_a_second_host_is_named_before_anything_moves(sheet) -> None:
    with device(sheet) as running, host(running) as first, host(running, node=6) as second:
        first.open(PERIOD_S)
        moving = Running(first)
        moving.start()
        with pytest.raises(DriveConnectionError, match=r"another host, or another joint .* sends SYNC"):
            second.open(PERIOD_S)
        moving.end()


def test_a_host_id_that_somebody_uses_is_not_taken(sheet) -> None:
    with device(sheet) as running, host(running) as first, host(running, node=6, host_node_id=None) as second:
        first.open(PERIOD_S)
        second.open  # not opened: only the choice is looked at
        ids = {first._session.host_id}
        first.close()
        first.open(PERIOD_S)
        ids.add(first._session.host_id)
    assert all(64 <= number <= 127 for number in ids)
