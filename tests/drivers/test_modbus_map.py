"""Registers, blocks and maps: numbers worked out by hand."""

import pytest

from drivers.contract import Mode, Status
from drivers.modbus.blocks import blocks
from drivers.modbus.map_file import MapError, known_maps, load_map, parse_map
from drivers.modbus.power_stage import state_of
from drivers.modbus.register import Number, Register, Space
from drivers.modbus.sampling import DriveClock
from drivers.modbus.session import plan
from tests.drivers.modbus_answers import MAP


def register(number, **changes):
    return Register(**{"name": "x", "space": Space.HOLDING, "address": 0, "number": number, **changes})


@pytest.mark.parametrize(
    ("made", "value", "words"),
    [
        (register(Number.INT16, scale=1e-3), -1.5, [0xFA24]),
        (register(Number.UINT16, scale=0.1, offset=-40.0), 25.0, [650]),
        (register(Number.INT32), -2, [0xFFFF, 0xFFFE]),
        (register(Number.INT32, low_word_first=True), 0x12345678, [0x5678, 0x1234]),
        (register(Number.UINT32), 4294967295, [0xFFFF, 0xFFFF]),
        (register(Number.UINT16, low_byte_first=True), 0x1234, [0x3412]),
        (register(Number.INT32, low_byte_first=True), 0x12345678, [0x3412, 0x7856]),
        (register(Number.INT32, low_byte_first=True, low_word_first=True), 0x12345678, [0x7856, 0x3412]),
        (register(Number.BIT, space=Space.COIL), 1, [1]),
        (register(Number.FLOAT32), 1.5, [0x3FC0, 0x0000]),
        (register(Number.LOW_INT16, scale=0.1), -0.7, [0x0000, 0xFFF9]),
    ],
)
def test_words_of_a_value_and_back(made, value, words):
    assert made.encode(value) == words
    assert made.decode(words) == pytest.approx(value)


def test_the_more_significant_word_of_a_low_number_has_no_meaning():
    assert register(Number.LOW_INT16).decode([0xFFFF, 0xFFF9]) == register(Number.LOW_INT16).decode([0, 0xFFF9]) == -7


@pytest.mark.parametrize(
    ("made", "value", "message"),
    [
        (register(Number.INT16, scale=1e-3, unit="A"), 40.0, r"x is 40 A; its register holds -32.768 .. 32.767"),
        (register(Number.UINT16), -1, r"x is -1 ; its register holds 0 .. 65535"),
        (register(Number.FLOAT32), float("nan"), "a finite number is wanted"),
        (register(Number.BIT, space=Space.COIL), 2, r"x is 2 ; its register holds 0 .. 1"),
    ],
)
def test_a_value_that_does_not_fit_is_refused(made, value, message):
    with pytest.raises(ValueError, match=message):
        made.encode(value)


def test_blocks_hold_what_lies_side_by_side():
    registers = [register(Number.UINT16, name=str(at), address=at) for at in (7, 0, 1, 3)]
    assert [(block.address, block.words) for block in blocks(registers)] == [(0, 2), (3, 1), (7, 1)]
    assert [(block.address, block.words) for block in blocks(registers, longest_gap=1)] == [(0, 4), (7, 1)]
    assert [(block.address, block.words) for block in blocks(registers, longest_gap=9, longest=4)] == [(0, 4), (7, 1)]


def test_a_block_with_swapped_bytes_and_gaps_is_read_as_its_registers_are():
    registers = (
        register(Number.INT16, name="a", scale=0.5),
        register(Number.INT32, name="b", address=2),
        register(Number.LOW_INT16, name="c", address=4, offset=1.0),
    )
    words = [0xFFFE, 7, 0xFFFF, 0xFFFE, 9, 3]
    [block] = blocks(registers, longest_gap=1)
    assert block.decode(words) == {"a": -1.0, "b": -2.0, "c": 4.0}
    swapped = [register(Number.INT16, name="d", address=6, low_byte_first=True)]
    [mixed] = blocks([*registers, *swapped], longest_gap=1)
    assert mixed.decode([*words, 0x0100]) == {"a": -1.0, "b": -2.0, "c": 4.0, "d": 1.0}


def test_one_request_where_the_drive_can():
    found = plan(parse_map(MAP, "map"))
    assert found.in_one
    assert [(block.address, block.words) for block in found.written] == [(10, 6)]
    assert [(block.address, block.words) for block in found.read] == [(20, 8)]
    assert [(block.space, block.address, block.words) for block in found.slow] == [(Space.INPUT, 5, 2)]
    assert not plan(parse_map(MAP.replace("read_write = true", ""), "map")).in_one


def test_the_maps_that_come_with_the_package_can_be_used():
    assert "roboteq" in known_maps()
    for name in known_maps():
        found = load_map(name)
        assert found.source
        assert plan(found).read


def test_the_documented_map():
    """docs/modbus-map.md: function 23 writes 5 registers from 0 and reads 12 registers from 100."""
    found = load_map("friction-bench")
    assert found.modes == {Mode.DUTY, Mode.CURRENT}
    requests = plan(found)
    assert requests.in_one
    assert [(block.address, block.words) for block in requests.written] == [(0, 5)]
    assert [(block.address, block.words) for block in requests.read] == [(100, 12)]
    assert requests.written[0].encode({"control": 1, "mode": 1, "current_demand": -0.7}) == [1, 1, 0, 0xFFFF, 0xFD44]
    words = [5, 2, 0xFFFF, 0xFFFE, 0, 1000, 2500, 0xFA24, 2400, 305, 0x0001, 0x0000]
    assert requests.read[0].decode(words) == pytest.approx(
        {
            "status": 5, "fault": 2, "position": -2, "velocity": 1000, "duty": 0.25, "current": -1.5, "supply": 24.0,
            "temperature": 30.5, "time": 65.536,
        }
    )  # fmt: skip
    assert state_of(found, requests.read[0].decode(words), Status.ENABLED) is Status.FAULT
    assert found.fault_name(2) == "over-current"


@pytest.mark.parametrize(
    ("word", "wanted"),
    [(0, Status.DISABLED), (1, Status.ENABLED), (3, Status.QUICK_STOP), (0x29, Status.ENABLED), (4, Status.FAULT)],
)
def test_states_that_are_bits(word, wanted):
    assert state_of(load_map("friction-bench"), {"status": word, "fault": 0}, Status.DISABLED) is wanted


def test_the_clock_is_followed_through_its_wraps():
    clock = DriveClock(1e-3, 32)
    turn_s = 2**32 * 1e-3
    assert [clock.follow(reading_s) for reading_s in (turn_s - 0.01, turn_s - 0.005, 0.005)] == pytest.approx(
        [turn_s - 0.01, turn_s - 0.005, turn_s + 0.005]
    )


def test_readings_within_a_step_of_the_clock_rise_and_stay_in_it():
    clock = DriveClock(1e-3, 32)
    readings_s = (0.010, 0.011, 0.011, 0.011, 0.012)
    assert [clock.follow(reading_s) for reading_s in readings_s] == pytest.approx(
        [0.010, 0.011, 0.0115, 0.01175, 0.012], abs=1e-9
    )


def test_the_published_map_of_roboteq():
    found = load_map("roboteq")
    assert found.modes == {Mode.DUTY}
    assert found.watchdog.register is None
    requests = plan(found)
    assert not requests.in_one
    # each quantity is two words at an address of its own, in requests of their own
    assert [(hex(block.address), block.words) for block in requests.read] == [
        ("0x2001", 2), ("0x2041", 2), ("0x2081", 2), ("0x2240", 2),
    ]  # fmt: skip
    assert requests.written[0].encode({"go": -0.5}) == [0xFFFF, 0xFE0C]
    assert found.fault_name(0x11) == "overheat, emergency stop"


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ('name = "test drive"', "", "map: name is missing"),
        ("read_write = true", "read_wirte = true", "map: read_wirte: unknown; known are control"),
        ('duty = "duty_demand"', 'duty = "nowhere"', "demand.duty names register 'nowhere', which is not in the map"),
        ('position_counts = "position"\n', "", "measured: position_counts is missing"),
        ('type = "float32"', 'type = "float64"', "register 'velocity': FLOAT64 is missing or not known"),
        ("address = 24", "adress = 24", "register 'velocity': address is missing"),
        ('name = "velocity"', 'name = "position"', "register 'position' is there twice"),
        ('unit = "counts/s"', 'unti = "counts/s"', "register 'velocity': unti: unknown key"),
        ("quick_stop = 2\nclear_fault", "stop = 2\nclear_fault", "control: stop: unknown; known are off"),
        ("[mode]", "[mode", "is no TOML"),
        ("read_write = true", "write_function = 5", "write_function is 5; 6 or 16 is wanted, or none"),
        ("[fault]\n", '[limits]\ncurrent = "current"\n[fault]\n', "limits: current: unknown; known is current_a"),
        ("[fault]\n", '[limits]\ncurrent_a = "supply"\n[fault]\n', "names register 'supply', which can only be read"),
        (
            "fault = 0x8130",
            "needs = { nowhere = 1 }",
            "watchdog.needs names register 'nowhere', which is not",
        ),
        ('type = "float32"', 'type = "bit"', "register 'velocity': a coil or discrete input has type bit, and nothing"),
        ('duty = "duty_demand"', 'duty = "supply"', "demand names register 'supply', which can only be read"),
    ],
)
def test_a_map_that_is_not_as_wanted(before, after, message):
    assert before in MAP
    with pytest.raises(MapError, match=message):
        parse_map(MAP.replace(before, after), "map")


def test_a_map_that_is_not_there():
    with pytest.raises(MapError, match=r"there is no register map 'robotec'; known are .*roboteq"):
        load_map("robotec")
    with pytest.raises(MapError, match=r"nowhere.toml: cannot be read: No such file"):
        load_map("nowhere.toml")
