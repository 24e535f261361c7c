"""A holding brake on an output of the drive: 0x60FE, with and without its mask."""

import time

import pytest

from drivers.canopen.cia402.bits import BrakeBit
from drivers.contract import BrakeOutput, Mode, OwnBrake
from drivers.errors import DriveConfigurationError, DriveConnectionError
from tests.drivers.canopen.node_double import NodeDouble

SET = BrakeBit(0, set_level=1)
OTHERS = 0x30000  # outputs that are not the brake's


@pytest.fixture
def braked(node: NodeDouble) -> NodeDouble:
    node.objects[0x60FE, 1] = ["<I", OTHERS]  # released, as a host left it
    node.objects[0x60FE, 2] = ["<I", OTHERS]
    return node


def written(node, *objects):
    """What was written by SDO, in order: (index, subindex, value)."""
    found = []
    for cob, data in node.received:
        place = (int.from_bytes(data[1:3], "little"), data[3]) if cob == 0x605 else None
        if place is not None and data[0] & 0xE0 == 0x20 and place in objects:
            found.append((*place, int.from_bytes(data[4:8], "little")))
    return found


def test_it_is_set_when_the_drive_is_opened_and_before_the_mask_lets_it_through(braked, drive_of):
    drive = drive_of(brake=SET)
    drive.open(0.005)
    assert written(braked, (0x60FE, 1), (0x60FE, 2)) == [(0x60FE, 1, OTHERS | 1), (0x60FE, 2, OTHERS | 1)]
    assert isinstance(drive, BrakeOutput)
    assert isinstance(drive, OwnBrake)


def test_released_and_set_under_power_the_other_outputs_stay(braked, drive_of):
    drive = drive_of(brake=SET)
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    drive.set_brake(released=True)
    assert braked.get(0x60FE, 1) == OTHERS
    assert braked.enabled
    drive.set_brake(released=False)
    assert braked.get(0x60FE, 1) == OTHERS | 1


def test_a_drive_without_the_mask_and_with_the_other_level(node, drive_of):
    node.objects[0x60FE, 1] = ["<I", 0]
    drive = drive_of(brake=BrakeBit(16, set_level=0))
    drive.open(0.005)
    drive.set_brake(released=True)
    assert node.get(0x60FE, 1) == 1 << 16
    drive.set_brake(released=False)
    assert node.get(0x60FE, 1) == 0


def test_at_once_nothing_is_waited_for(braked, drive_of):
    drive = drive_of(brake=SET)
    drive.open(0.005)
    drive.set_brake(released=True)
    braked.silent = True
    began_s = time.perf_counter()
    drive.set_brake(released=False, confirmed=False)
    assert time.perf_counter() - began_s < 0.1
    with pytest.raises(DriveConnectionError, match="physical outputs"):
        drive.set_brake(released=False)
    braked.silent = False
    drive.set_brake(released=True)
    drive.set_brake(released=False, confirmed=False)
    deadline_s = time.perf_counter() + 2.0
    while braked.get(0x60FE, 1) != OTHERS | 1:
        assert time.perf_counter() < deadline_s
    drive.enable(Mode.CURRENT)  # the answer that nobody waited for disturbs nothing


def test_closing_sets_it(braked, drive_of):
    drive = drive_of(brake=SET)
    drive.open(0.005)
    drive.set_brake(released=True)
    drive.close()
    deadline_s = time.perf_counter() + 2.0
    while braked.get(0x60FE, 1) != OTHERS | 1:
        assert time.perf_counter() < deadline_s


def test_a_joint_that_a_dead_host_left_powered_is_held_before_the_power_goes(braked, drive_of):
    braked.put(0x6041, 0, 0x0237)
    drive_of(brake=SET).open(0.005)
    order = [place for *place, _ in written(braked, (0x60FE, 1), (0x6040, 0))]
    assert order[0] == [0x60FE, 1]
    assert [0x6040, 0] in order


def test_a_drive_without_the_output_is_refused(node, drive_of):
    with pytest.raises(DriveConfigurationError, match=r"physical outputs \(0x60FE:01\)"):
        drive_of(brake=SET).open(0.005)


def test_no_output_was_configured(node, drive_of):
    drive = drive_of()
    drive.open(0.005)
    with pytest.raises(DriveConfigurationError, match=r"drive\.brake\.by"):
        drive.set_brake(released=True)


def test_a_brake_of_its_own_is_set_by_the_drives_order_before_the_power_goes(node, drive_of):
    drive = drive_of()
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    node.received.clear()
    drive.stand_down(0.1)
    words = [int.from_bytes(data[:2], "little") for cob, data in node.received if cob == 0x205]
    assert words[0] == 0x07  # disable operation: the drive stops, holds, sets its brake
    assert words[-1] == 0x00
    assert not node.enabled
