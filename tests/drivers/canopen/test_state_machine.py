import pytest

from drivers.canopen.cia402.demand import SetPointHandshake
from drivers.canopen.cia402.state_machine import State, state_of, status_of, towards_enabled, towards_standstill
from drivers.contract import Status


@pytest.mark.parametrize(
    ("statusword", "state"),
    [
        (0x0200, State.NOT_READY),
        (0x0240, State.SWITCH_ON_DISABLED),
        (0x0231, State.READY),  # seen from a C master on a drive that passes
        (0x0233, State.SWITCHED_ON),
        (0x0237, State.ENABLED),
        (0x1237, State.ENABLED),
        (0x0217, State.QUICK_STOP),
        (0x021F, State.FAULT_REACTION),
        (0x0218, State.FAULT),
        (0x0238, State.FAULT),
        (0x0225, State.UNKNOWN),
    ],
)
def test_statuswords_of_the_standard(statusword, state):
    assert state_of(statusword) is state


def test_warnings_and_mode_bits_do_not_change_the_state():
    for extra in (0x0080, 0x0400, 0x0800, 0x1000, 0x2000, 0x8000, 0xFF80):
        assert state_of(0x0237 | extra) is State.ENABLED


def test_the_way_to_operation_enabled_is_6_7_15():
    way, state = [], State.SWITCH_ON_DISABLED
    after = {0x06: State.READY, 0x07: State.SWITCHED_ON, 0x0F: State.ENABLED}
    while state is not State.ENABLED:
        way.append(towards_enabled(state))
        state = after[way[-1]]
    assert way == [0x06, 0x07, 0x0F]


@pytest.mark.parametrize("state", [State.FAULT, State.FAULT_REACTION, State.NOT_READY, State.QUICK_STOP, State.UNKNOWN])
def test_no_other_state_is_enabled_from(state):
    assert towards_enabled(state) == 0x00


def test_quick_stop_goes_on_for_as_long_as_the_drive_brakes_and_ends_in_power_off():
    assert towards_standstill(State.ENABLED) == 0x02
    assert towards_standstill(State.QUICK_STOP) == 0x02
    assert towards_standstill(State.SWITCHED_ON) == 0x00
    assert towards_standstill(State.FAULT) == 0x00


def test_only_operation_enabled_counts_as_enabled():
    assert [state for state in State if status_of(state) is Status.ENABLED] == [State.ENABLED]
    assert {state for state in State if status_of(state) is Status.FAULT} == {State.FAULT, State.FAULT_REACTION}


def test_a_target_is_offered_until_acknowledged_and_then_bit_4_falls():
    handshake = SetPointHandshake(100)
    assert handshake.step(100, 0x0237) == (0x0F, 100)
    assert handshake.step(200, 0x0237) == (0x3F, 200)
    assert handshake.step(300, 0x0237) == (0x3F, 200), "not acknowledged yet: it stays"
    assert handshake.step(300, 0x1237) == (0x0F, 200), "acknowledged"
    assert handshake.step(300, 0x1237) == (0x0F, 200), "the drive still shows it"
    assert handshake.step(300, 0x0237) == (0x3F, 300)
