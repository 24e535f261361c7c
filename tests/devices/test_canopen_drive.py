"""CiA 402 in virtual time: state machine, modes, what happens when things go wrong."""

from itertools import pairwise
from math import pi

import pytest

from sim_backend.devices.canopen.objects.epos4 import EPOS4
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.faults.script import OverTemperature, SupplyLost, TorqueDisabled
from tests.devices.can_host import CanHost

MASTER = 0x7F
COUNTS_PER_JOINT_RAD = 4096 * 20 / (2 * pi)
STATE = 0x6F
DISABLED, READY, SWITCHED_ON, ENABLED, QUICK_STOP, FAULT = 0x40, 0x21, 0x23, 0x27, 0x07, 0x08
PROFILE_POSITION, PROFILE_TORQUE, CYCLIC_POSITION, CYCLIC_TORQUE = 1, 4, 8, 10


def _state(word: int) -> int:
    return word & (STATE if word & 0x20 or not word & 0x48 else 0x4F)


def _powered(host: CanHost) -> bool:
    return host.device.axis.power.on


def _turning(**tables: dict) -> CanHost:
    """A drive whose motor turns at some speed by its own torque."""
    host = CanHost(**tables)
    host.enable(CYCLIC_TORQUE)
    host.write(0x6071, 0, 500, 2)
    host.wait(0.3)
    assert host.read(0x606C) > 10_000
    return host


def test_way_up_and_down_step_by_step() -> None:
    host = CanHost()
    host.write(0x6060, 0, CYCLIC_TORQUE, 1)
    words = [host.control(word) for word in (0x06, 0x07, 0x0F)]
    assert words[:2] == [0x0231, 0x0233]
    assert words[2] == 0x1237
    assert _powered(host)
    assert host.control(0x00) == 0x0250
    assert not _powered(host)


@pytest.mark.parametrize(
    ("way", "word", "state"),
    [
        ((), 0x07, DISABLED),  # nothing but shutdown leads out
        ((), 0x0F, DISABLED),
        ((0x06,), 0x0F, ENABLED),  # both steps at once
        ((0x06,), 0x02, DISABLED),
        ((0x06, 0x07), 0x06, READY),
        ((0x06, 0x07), 0x02, DISABLED),
        ((0x06, 0x07, 0x0F), 0x06, READY),
        ((0x06, 0x07, 0x0F), 0x00, DISABLED),
        ((0x06, 0x07, 0x0F), 0x02, QUICK_STOP),
        ((), 0x80, DISABLED),
    ],
)
def test_transition(way: tuple[int, ...], word: int, state: int) -> None:
    host = CanHost()
    host.control(*way)
    assert _state(host.control(word)) == state


def test_disable_operation_brakes_and_then_switches_the_stage_off() -> None:
    host = _turning()
    assert _state(host.control(0x07)) == ENABLED
    host.wait(1.0)
    assert _state(host.read(0x6041, 0, "H")) == SWITCHED_ON
    assert not _powered(host)


@pytest.mark.parametrize(("option", "state", "powered"), [(2, DISABLED, False), (6, QUICK_STOP, True)])
def test_quick_stop_stands_soon_and_ends_by_its_option(option: int, state: int, powered: bool) -> None:
    host = _turning()
    host.write(0x605A, 0, option, 2)
    assert _state(host.control(0x0B)) == QUICK_STOP
    host.wait(0.5)
    assert abs(host.read(0x606C)) < 500
    assert _state(host.read(0x6041, 0, "H")) == state
    assert _powered(host) is powered
    # back to work is allowed from a quick stop that holds only
    assert _state(host.control(0x0F)) == (ENABLED if powered else DISABLED)


def test_quick_stop_of_option_0_is_power_off_at_once() -> None:
    host = _turning()
    host.write(0x605A, 0, 0, 2)
    assert _state(host.control(0x0B)) == DISABLED
    assert not _powered(host)


def test_option_that_the_drive_does_not_have_is_refused() -> None:
    assert CanHost().write(0x605A, 0, 3, 2) == 0x06090030


def test_cyclic_torque_makes_current_in_proportion_with_the_offset_on_top() -> None:
    host = CanHost(friction={"static_n_m": 1.0, "coulomb_n_m": 0.9})  # jammed
    host.enable(CYCLIC_TORQUE)
    host.write(0x6071, 0, 300, 2)
    host.write(0x60B2, 0, -100, 2)
    host.wait(0.1)
    assert host.device.axis.plant.truth().current_a == pytest.approx(0.2, abs=1e-3)  # rated 1 A
    assert host.read(0x6077, 0, "h") == 200
    assert host.read(0x6078, 0, "h") == 200
    assert host.read(0x6074, 0, "h") == 200
    assert host.read(0x2001, 0, "h") == pytest.approx(1000 * 8.0 * 0.2 / 24.0, abs=1)
    assert host.read(0x6079, 0, "I") == 24_000


def test_torque_is_limited_and_the_statusword_says_so() -> None:
    host = CanHost(friction={"static_n_m": 1.0, "coulomb_n_m": 0.9})
    host.write(0x6072, 0, 400, 2)
    host.enable(CYCLIC_TORQUE)
    host.write(0x6071, 0, 1000, 2)
    host.wait(0.1)
    assert host.device.axis.plant.truth().current_a == pytest.approx(0.4, abs=1e-3)
    assert host.read(0x6041, 0, "H") & 0x800


def test_profile_torque_takes_its_slope_and_reaches_its_target() -> None:
    host = CanHost(friction={"static_n_m": 1.0, "coulomb_n_m": 0.9})
    host.write(0x6087, 0, 1000, 4)
    host.enable(PROFILE_TORQUE)
    host.write(0x6071, 0, 500, 2)
    host.wait(0.25)
    assert host.read(0x6074, 0, "h") == pytest.approx(250, abs=5)
    assert not host.read(0x6041, 0, "H") & 0x400
    host.wait(0.5)
    assert host.read(0x6074, 0, "h") == 500
    assert host.read(0x6041, 0, "H") & 0x400


def test_profile_position_takes_acknowledges_and_reaches() -> None:
    host = CanHost()
    assert _state(host.enable(PROFILE_POSITION)) == ENABLED
    host.write(0x607A, 0, 20480, 4)  # 90 degrees
    host.write(0x6067, 0, 300, 4)
    assert host.control(0x1F) & 0x1400 == 0x1000  # taken, not reached
    assert host.control(0x0F) & 0x1000 == 0
    host.wait(2.0)
    assert host.read(0x6041, 0, "H") & 0x400
    assert host.read(0x6064) == pytest.approx(20480, abs=300)
    assert host.device.axis.plant.truth().arm_rad == pytest.approx(pi / 2, abs=0.03)


def test_profile_position_keeps_one_target_waiting_and_takes_relative_ones() -> None:
    host = CanHost()
    host.enable(PROFILE_POSITION)
    for target, word in ((8000, 0x1F), (16000, 0x1F), (99999, 0x1F)):
        host.write(0x607A, 0, target, 4)
        host.control(word)
        if target < 99999:
            host.control(0x0F)
    host.control(0x0F)
    host.wait(2.0)
    assert host.read(0x6062) == 16000  # the third came while one was waiting
    host.write(0x607A, 0, -6000, 4)
    host.control(0x5F)
    host.wait(1.5)
    assert host.read(0x6062) == 10000


def test_profile_position_obeys_change_at_once_and_halt() -> None:
    host = CanHost()
    host.enable(PROFILE_POSITION)
    host.write(0x607A, 0, 40000, 4)
    host.control(0x3F, 0x2F)
    host.wait(0.2)
    host.write(0x607A, 0, -5000, 4)
    host.control(0x3F)
    host.wait(2.0)
    assert host.read(0x6062) == -5000
    host.write(0x607A, 0, 40000, 4)
    host.control(0x0F, 0x3F)
    host.wait(0.2)
    host.control(0x10F)
    host.wait(0.5)
    stopped = host.read(0x6062)
    host.wait(0.2)
    assert host.read(0x6062) == stopped
    assert 0 < stopped < 40000


def test_speed_of_a_profile_is_in_the_drive_s_unit() -> None:
    for family, number, counts_per_s in ((GENERIC, 30_000, 30_000.0), (EPOS4, 440, 440 / 60 * 4096)):
        host = CanHost(family)
        host.write(0x6081, 0, number, 4)
        host.enable(PROFILE_POSITION)
        host.write(0x607A, 0, 60_000, 4)
        host.control(0x1F)
        host.wait(1.0)
        before = host.read(0x6062)
        host.wait(0.1)
        assert (host.read(0x6062) - before) / 0.1 == pytest.approx(counts_per_s, rel=1e-3)


def test_cyclic_position_goes_straight_between_targets() -> None:
    host = CanHost()
    host.write(0x60C2, 1, 20, 1)
    host.enable(CYCLIC_POSITION)
    demanded = []
    for number in range(1, 51):
        host.write(0x607A, 0, 400 * number, 4)
        for _ in range(20):
            host.wait(0.001)
            demanded.append(host.read(0x6062))
    steps = [after - before for before, after in pairwise(demanded)]
    assert set(steps) == {20}
    assert host.read(0x6064) == pytest.approx(20_000, abs=400)


def test_torque_offset_is_added_in_cyclic_position() -> None:
    host = CanHost(friction={"static_n_m": 1.0, "coulomb_n_m": 0.9})  # jammed
    host.enable(CYCLIC_POSITION)
    host.write(0x60B2, 0, 120, 2)
    host.wait(0.01)
    assert host.read(0x6074, 0, "h") == 120


def test_mode_changes_under_power_without_a_jump() -> None:
    host = CanHost()
    host.device.axis.hang_load(0.1, balanced=False)
    host.enable(PROFILE_POSITION)
    host.write(0x607A, 0, 20480, 4)
    host.control(0x1F)
    host.wait(3.0)
    before = host.read(0x6064)
    host.write(0x6060, 0, CYCLIC_POSITION, 1)
    host.wait(0.3)
    assert host.read(0x6061, 0, "b") == CYCLIC_POSITION
    assert host.read(0x6064) == pytest.approx(before, abs=60)


def test_modes_are_told_and_others_are_refused() -> None:
    assert CanHost().read(0x6502, 0, "I") == 0b11_1000_1101
    assert CanHost(EPOS4).read(0x6502, 0, "I") == 0b10_1000_0001
    for family, mode in ((GENERIC, 2), (GENERIC, 6), (EPOS4, 4), (EPOS4, 6)):
        host = CanHost(family)
        assert host.write(0x6060, 0, mode, 1) == 0x06090030
        assert host.read(0x6061, 0, "b") == 0


@pytest.mark.parametrize(
    ("family", "absent"), [(GENERIC, (0x3001, 0x30D1, 0x3203)), (EPOS4, (0x6072, 0x6075, 0x6078, 0x6079, 0x6087))]
)
def test_object_of_the_other_family_is_not_there(family, absent: tuple[int, ...]) -> None:
    assert {CanHost(family).read_code(index) for index in absent} == {0x06020000}


def test_units_of_an_epos4() -> None:
    host = CanHost(EPOS4)
    host.enable(CYCLIC_TORQUE)
    host.write(0x6071, 0, 500, 2)
    host.wait(0.3)
    truth = host.device.axis.plant.truth()
    assert host.read(0x60A9, 0, "I") == 0x00B44700
    assert host.read(0x606C) == pytest.approx(truth.rotor_rad_s * 20 * 60 / (2 * pi), rel=0.02)
    assert host.read(0x30D1, 2) == pytest.approx(1000 * truth.current_a, abs=1)
    assert host.read(0x3203, 1, "H") == pytest.approx(1000 * host.device.axis.seen.duty, abs=1)
    assert host.read(0x2200, 1, "H") == 240
    assert host.read(0x6076, 0, "I") == 50_000  # uN m
    assert host.read(0x1018, 1, "I") == 0xFB


@pytest.mark.parametrize(("option", "state"), [(0, ENABLED), (1, FAULT), (2, DISABLED), (3, DISABLED)])
def test_lost_master_is_met_by_0x6007(option: int, state: int) -> None:
    host = _turning()
    host.write(0x6007, 0, option, 2)
    host.write(0x1016, 1, MASTER << 16 | 100, 4)
    host.send(0x700 + MASTER, b"\x05")
    host.wait(0.099)
    assert _state(host.read(0x6041, 0, "H")) == ENABLED
    host.wait(0.6)
    word = host.read(0x6041, 0, "H")
    assert _state(word) == state
    assert _powered(host) is (option == 0)
    assert host.device.report()["watchdog_trips"] == 1


def test_fault_of_a_lost_master_has_its_code_and_can_be_reset() -> None:
    host = _turning()
    host.write(0x1016, 1, MASTER << 16 | 100, 4)
    host.send(0x700 + MASTER, b"\x05")
    host.wait(0.8)
    assert host.read(0x603F, 0, "H") == 0x8130
    host.send(0x700 + MASTER, b"\x05")
    assert _state(host.control(0x00, 0x80)) == DISABLED
    assert host.read(0x603F, 0, "H") == 0


@pytest.mark.parametrize(("kind", "code"), [(OverTemperature, 0x4210), (SupplyLost, 0x3220)])
def test_trip_is_a_fault_that_stays_while_its_cause_does(kind, code: int) -> None:
    host = _turning()
    host.device.axis.meet(kind(start_s=host.time_s, duration_s=0.2))
    host.wait(0.01)
    assert not _powered(host)
    assert _state(host.read(0x6041, 0, "H")) == FAULT
    assert host.read(0x603F, 0, "H") == code
    assert _state(host.control(0x00, 0x80)) == FAULT
    host.wait(0.3)
    assert _state(host.control(0x80)) == FAULT  # no rising edge
    assert _state(host.control(0x00, 0x80)) == DISABLED
    assert not _powered(host)


def test_safe_torque_off_is_no_fault_and_lets_nothing_be_switched_on() -> None:
    host = _turning()
    host.device.axis.meet(TorqueDisabled(start_s=host.time_s, duration_s=0.2))
    host.wait(0.01)
    assert _state(host.read(0x6041, 0, "H")) == DISABLED
    assert _state(host.control(0x06, 0x07, 0x0F)) == DISABLED
    assert not _powered(host)
    host.wait(0.3)
    assert _state(host.control(0x06, 0x07, 0x0F)) == ENABLED


def test_following_error_outside_its_window_for_too_long_is_a_fault() -> None:
    host = CanHost(friction={"static_n_m": 1.0, "coulomb_n_m": 0.9})  # jammed
    host.write(0x6065, 0, 500, 4)
    host.write(0x6066, 0, 50, 2)
    host.write(0x605E, 0, 0, 2)
    host.enable(CYCLIC_POSITION)
    host.write(0x607A, 0, 1000, 4)
    host.wait(0.03)
    assert host.read(0x6041, 0, "H") & 0x2000
    assert _state(host.read(0x6041, 0, "H")) == ENABLED
    host.wait(0.1)
    assert _state(host.read(0x6041, 0, "H")) == FAULT
    assert host.read(0x603F, 0, "H") == 0x8611
    assert not _powered(host)


@pytest.mark.parametrize("command", ["81 05", "02 05"])
def test_reset_and_stop_of_the_node_end_the_motion(command: str) -> None:
    host = _turning()
    host.write(0x6007, 0, 2, 2)
    host.send(0x000, command)
    host.wait(0.01)
    assert not _powered(host)


def test_target_and_controlword_of_one_sync_belong_together() -> None:
    host = CanHost()
    host.write(0x1402, 1, 0x80000405, 4)
    for place, entry in enumerate((0x60400010, 0x607A0020), 1):
        host.write(0x1602, place, entry, 4)
    host.write(0x1602, 0, 2, 1)
    host.write(0x1402, 1, 0x405, 4)
    host.send(0x000, "01 05")
    host.enable(PROFILE_POSITION)
    host.send(0x405, "1f 00 10 27 00 00")
    host.send(0x080)
    host.wait(1.5)
    assert host.read(0x6062) == 10_000
