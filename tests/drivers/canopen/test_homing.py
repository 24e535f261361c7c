"""The drive's own homing: what is told to it, what its statusword says, and what a drive without it is told to lack."""

from math import pi
from types import SimpleNamespace

import pytest

from drivers.canopen.cia301.objects import CONTROLWORD
from drivers.canopen.cia301.pdo import PdoLayout
from drivers.canopen.cia402.homing import DriveHoming, HomingDemand
from drivers.contract import Command, Mode
from drivers.errors import DriveConfigurationError, DriveStateError
from tests.drivers.canopen.conversation import exchange_for

SEARCH, HOLD = Command(Mode.HOME, 1.0), Command(Mode.HOME, 0.0)
ATTAINED, ERROR = 0x1237, 0x2237
UNDER_WAY = 0x0237
HOW = DriveHoming(34, 0.5, 0.1, 2.0)


def demand():
    return HomingDemand(SimpleNamespace(idle=SimpleNamespace(layout=PdoLayout([CONTROLWORD]))))


def word_of(payload):
    return int.from_bytes(payload[:2], "little")


def test_bit_4_starts_it_and_breaks_it_off():
    one = demand()
    assert word_of(one.at_rest(0x0F, 0)) == 0x0F
    assert word_of(one.payload(HOLD, UNDER_WAY, 0)) == 0x0F
    assert word_of(one.payload(SEARCH, UNDER_WAY, 0)) == 0x1F


@pytest.mark.parametrize(("word", "what"), [(ATTAINED, "attained"), (ERROR, "failed")])
def test_what_was_seen_low_counts_from_the_second_answer_on(word, what):
    one = demand()
    one.payload(SEARCH, UNDER_WAY, 0)
    assert not getattr(one, what)(word)  # measured before it began
    one.payload(SEARCH, UNDER_WAY, 0)
    assert getattr(one, what)(word)


@pytest.mark.parametrize(("word", "what"), [(ATTAINED, "attained"), (ERROR, "failed")])
def test_a_bit_of_the_homing_before_counts_only_where_it_stays(word, what):
    one = demand()
    seen = []
    for _ in range(60):
        one.payload(SEARCH, word, 0)
        seen.append(getattr(one, what)(word))
    assert not any(seen[:50])
    assert all(seen[50:])


def test_attained_with_an_error_is_no_home():
    one = demand()
    for _ in range(2):
        one.payload(SEARCH, UNDER_WAY, 0)
    assert not one.attained(ATTAINED | ERROR)


@pytest.fixture
def homing_node(node):
    node.objects |= {
        (0x607C, 0): ["<i", 77], (0x6098, 0): ["<b", 0], (0x6099, 1): ["<I", 1], (0x6099, 2): ["<I", 1],
        (0x609A, 0): ["<I", 1],
    }  # fmt: skip
    node.put(0x6502, 0, node.get(0x6502) | 1 << 5)
    return node


def test_the_drive_is_told_how_and_its_home_is_to_be_0(homing_node, drive_of):
    drive = drive_of(homing=HOW)
    drive.open(0.005)
    assert homing_node.get(0x6098) == 0  # nothing is written before it is asked for
    drive.enable(Mode.HOME)
    assert (homing_node.get(0x6060), homing_node.get(0x6098), homing_node.get(0x607C)) == (6, 34, 0)
    rpm = 60.0 / (2.0 * pi) * 20.0  # of the motor, in which this drive counts speeds
    assert homing_node.get(0x6099, 1) == pytest.approx(0.5 * rpm, abs=1)
    assert homing_node.get(0x6099, 2) == pytest.approx(0.1 * rpm, abs=1)
    assert homing_node.get(0x609A) == pytest.approx(2.0 * rpm, abs=1)
    assert not homing_node.get(0x6040) & 0x10
    sample = drive.exchange(SEARCH)
    assert homing_node.get(0x6040) == 0x1F
    assert not sample.homed


@pytest.mark.parametrize(
    ("unit", "factor", "counts"),
    [
        (0x00C00300, None, 382),  # rpm a second: 2 rad/s2 of the joint are 40 of the motor
        (0xFDB45700, None, 6366),  # thousandths of a turn
        (None, (10, 1), 260_759),  # of a position unit a tenth
        (None, None, 382),  # not told: as of velocities, a second
    ],
)
def test_the_acceleration_is_in_the_drives_unit_of_accelerations(homing_node, drive_of, unit, factor, counts):
    homing_node.put(0x60AA, 0, unit or 0)
    for place, value in enumerate(factor or (), 1):
        homing_node.objects[0x6097, place] = ["<I", value]
    drive = drive_of(homing=HOW)
    drive.open(0.005)
    drive.enable(Mode.HOME)
    assert (homing_node.get(0x609A), homing_node.get(0x6099, 1)) == (counts, 95)


def test_a_homing_error_is_raised_with_the_statusword(homing_node, drive_of):
    drive = drive_of(homing=HOW)
    drive.open(0.005)
    drive.enable(Mode.HOME)
    drive.exchange(SEARCH)
    homing_node.put(0x6041, 0, homing_node.get(0x6041) | 0x2000)
    homing_node._control = lambda: None  # the double would tell its own state at the next controlword
    with pytest.raises(DriveStateError, match=r"homing ended with an error .*0x2237"):
        exchange_for(drive, 0.1, SEARCH)


def test_a_drive_without_the_objects_is_told_which(node, drive_of):
    drive = drive_of(homing=HOW)
    drive.open(0.005)
    with pytest.raises(DriveConfigurationError) as caught:
        drive.enable(Mode.HOME)
    said = str(caught.value)
    for one in ("homing method (0x6098:00)", "homing speed, search for zero (0x6099:02)", "supported drive modes"):
        assert one in said
    assert not node.enabled


def test_without_a_way_of_homing_none_is_begun(homing_node, drive_of):
    drive = drive_of()
    drive.open(0.005)
    with pytest.raises(DriveConfigurationError, match="no way of homing was configured"):
        drive.enable(Mode.HOME)
