"""Fault resets at slow drives, and other hosts on the bus."""

import pytest

from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConnectionError
from sim_backend.devices.canopen.conduct import Conduct
from tests.drivers.dictionaries.attempt import PERIOD_S, cycles, device, host
from tests.drivers.dictionaries.fault_reset import TICKS_MS, resets
from tests.drivers.dictionaries.traits import TRAITS
from tests.drivers.dictionaries.two_hosts import WAYS, Running

pytestmark = pytest.mark.virtual_time


@pytest.fixture
def sheet(tmp_path):
    return TRAITS["plain"].write(tmp_path, "plain")


@pytest.mark.parametrize("tick_ms", TICKS_MS)
def test_a_drive_that_looks_now_and_then_is_reset_each_time(sheet, tick_ms) -> None:
    assert resets(sheet, tick_ms * 1e-3, tries=4) == 4


@pytest.mark.parametrize("way", WAYS)
def test_two_hosts_on_one_bus_are_refused_or_both_guarded(sheet, way) -> None:
    assert way(sheet, f"test-{way.__name__}").is_safe


@pytest.mark.real_wire
def test_a_second_host_is_named_before_anything_moves(sheet) -> None:
    with device(sheet) as running, host(running) as first, host(running, node=6) as second:
        first.open(PERIOD_S)
        moving = Running(first)
        moving.start()
        with pytest.raises(DriveConnectionError, match="another host is on the bus: it sends SYNC"):
            second.open(PERIOD_S)
        moving.end()


def test_a_drive_that_was_left_in_operation_is_shut_down_before_anything_else(sheet) -> None:
    with device(sheet, Conduct(deaf=True)) as running, host(running) as gone, host(running) as successor:
        gone.open(PERIOD_S)
        gone.enable(Mode.CURRENT)
        cycles(gone, Command(Mode.CURRENT, 0.2), 0.1)
        gone._link.close()  # it dies without a word
        assert running.device.axis.power.on
        successor.open(PERIOD_S)
        assert not running.device.axis.power.on
        row = next(row for row in successor.objects if row.object == "power")
        assert row.outcome == "found in state 'operation enabled', left by a host before: off"
        successor.enable(Mode.CURRENT)
        assert successor.exchange(Command(Mode.CURRENT, 0.0)).status is Status.ENABLED
