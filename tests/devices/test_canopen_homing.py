"""Homing of the simulated CiA 402 drive, by the bits of the standard: attained, error, target reached."""

from math import pi, radians

import pytest

from sim_backend.devices.canopen.objects.homing import HOMING as FAMILY
from tests.devices.can_host import CanHost

TURN = 4096
COUNTS_PER_JOINT_RAD = TURN * 20 / (2 * pi)
HOMING, CYCLIC_POSITION = 6, 8
START, ENABLED = 0x1F, 0x0F
REACHED, ATTAINED, ERROR = 1 << 10, 1 << 12, 1 << 13
BITS = REACHED | ATTAINED | ERROR
STOP_RAD = radians(80.0)
STOPS = {"end_stops": {"present": True, "upper_rad": STOP_RAD, "lower_rad": -STOP_RAD}}


def ready(method, at_rad=0.0, **tables):
    """A drive that is enabled in homing mode, its arm at some angle, and has not begun."""
    host = CanHost(FAMILY, **tables)
    host.device.axis.hold_arm(at_rad)
    host.wait(0.01)
    host.device.axis.release_arm()
    assert host.write(0x6098, 0, method, 1) == 0
    host.write(0x6099, 1, 4 * TURN, 4)
    host.write(0x6099, 2, TURN, 4)
    assert host.enable(HOMING) & BITS == REACHED  # not started
    return host


def bits(host):
    return host.read(0x6041, 0, "H") & BITS


@pytest.mark.parametrize("method", [35, 37])
@pytest.mark.parametrize("offset", [0, 1234])
def test_the_present_position_becomes_the_home_offset(method, offset):
    host = ready(method, at_rad=0.1)
    assert host.read(0x6064) == pytest.approx(0.1 * COUNTS_PER_JOINT_RAD, abs=200)
    host.write(0x607C, 0, offset, 4)
    host.control(START)
    host.wait(0.1)
    assert bits(host) == ATTAINED | REACHED
    assert host.read(0x6064) == pytest.approx(offset, abs=40)


@pytest.mark.parametrize(("method", "way"), [(33, -1), (34, 1)])
def test_the_next_index_pulse_is_found_on_its_side(method, way):
    host = ready(method, at_rad=0.05)
    start = host.read(0x6064)
    host.control(START)
    host.wait(0.1)
    assert bits(host) == 0  # under way
    host.wait(1.5)
    assert bits(host) == ATTAINED | REACHED
    # the index stands at whole turns of the motor
    index = (start // TURN + (1 if way > 0 else 0)) * TURN
    now = round(host.device.axis.seen.position_rad * COUNTS_PER_JOINT_RAD)
    assert now - host.read(0x6064) == pytest.approx(index, abs=2)


@pytest.mark.parametrize(("method", "way"), [(-1, -1), (-2, 1)])
def test_an_end_stop_is_found_with_the_torque_of_the_search(method, way):
    host = ready(method, **STOPS)
    host.control(START)
    highest_a = 0.0
    for _ in range(100):
        host.wait(0.1)
        highest_a = max(highest_a, abs(host.device.axis.seen.current_a))
        if bits(host) & ATTAINED:
            break
    assert bits(host) == ATTAINED | REACHED
    assert host.device.axis.plant.truth().arm_rad == pytest.approx(way * STOP_RAD, abs=0.05)
    assert host.read(0x6064) == pytest.approx(0, abs=100)
    assert highest_a < 0.55  # half of the rated current


def test_an_arm_that_cannot_reach_the_index_ends_in_an_error_and_stands():
    host = ready(34, at_rad=STOP_RAD - 0.02, **STOPS)
    host.control(START)
    host.wait(5.0)
    assert bits(host) == ERROR | REACHED
    assert host.control(ENABLED) & BITS == ERROR | REACHED  # until it is begun again


def test_breaking_off_stops_it_without_a_home():
    host = ready(-2, **STOPS)
    host.control(START)
    host.wait(0.3)
    host.control(ENABLED)
    host.wait(0.5)
    assert bits(host) == REACHED
    assert abs(host.read(0x606C)) < 500
    assert host.control(START) & BITS == 0


def test_positions_count_from_home_in_every_other_mode():
    host = ready(37, at_rad=0.1)
    host.control(START)
    host.wait(0.1)
    host.control(0x00)
    host.enable(CYCLIC_POSITION)
    host.write(0x607A, 0, 1000, 4)
    host.wait(1.0)
    assert host.read(0x6064) == pytest.approx(1000, abs=60)


def test_a_method_that_it_does_not_have_is_refused():
    assert CanHost(FAMILY).write(0x6098, 0, 17, 1) == 0x06090030
