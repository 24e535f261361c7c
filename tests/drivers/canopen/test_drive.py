"""The driver against a node that is written in bytes."""

import struct
import time
from dataclasses import replace
from math import isnan, pi

import pytest
from pydantic import ValidationError

from drivers.can_bus.settings import BusSettings
from drivers.canopen.drive import CanopenDrive
from drivers.canopen.settings import CanopenSettings
from drivers.contract import Command, Mode, Status
from drivers.errors import DriveConfigurationError, DriveConnectionError, DriveStateError, WatchdogError
from tests.drivers.canopen.conftest import COUNT_RAD, JOINT
from tests.drivers.canopen.node_double import NodeDouble

OFF = Command(Mode.OFF)


def _await(condition, timeout_s=2.0):
    deadline_s = time.perf_counter() + timeout_s
    while not condition():
        assert time.perf_counter() < deadline_s, "did not come about"
        time.sleep(0.001)


def test_opening_sets_the_watchdog_and_the_pdos_with_the_power_off(node, drive_of):
    drive_of().open(0.005)
    assert {key: node.get(*key) for key in ((0x6007, 0), (0x605A, 0), (0x1017, 0), (0x1029, 1), (0x1016, 1))} == {
        (0x6007, 0): 3, (0x605A, 0): 2, (0x1017, 0): 50, (0x1029, 1): 1, (0x1016, 1): 0,
    }  # fmt: skip
    assert (node.get(0x1400, 1), node.get(0x1401, 1)) == (0x205, 0x305)
    assert (node.get(0x1800, 1), node.get(0x1801, 1)) == (0x40000185, 0x40000285)
    assert {node.get(index, 2) for index in (0x1400, 0x1401, 0x1800, 0x1801)} == {1}
    assert [node.get(0x1601, sub) for sub in range(4)] == [3, 0x60400010, 0x607A0020, 0x60B20010]
    assert [node.get(0x1A00, sub) for sub in range(3)] == [2, 0x60410010, 0x60780010]
    assert (node.get(0x60C2, 1), node.get(0x60C2, 2)) == (5, -3)
    assert node.off_at_s is None, "it was never on"


@pytest.mark.usefixtures("node")
def test_a_watchdog_that_is_off_with_the_power_says_from_when_on_it_watches(drive_of):
    drive = drive_of()
    drive.open(0.005)
    [objects] = [table for table in drive.describe().tables if table.title == "Objects of the drive"]
    [said] = [row[-1] for row in objects.rows if row[0].startswith("consumer heartbeat time")]
    assert said == "0 while the power is off; watches for 100 ms from switching on"


def test_nothing_moves_before_identity_watchdog_and_pdos_are_right(node, drive_of):
    drive_of().open(0.005)
    asked = [data for cob, data in node.received if cob == 0x605]
    places = {name: asked.index(bytes.fromhex(data)) for name, data in {
        "identity": "4000100000000000", "power off": "2b40600000000000", "watchdog": "23161001" "64007f00",
        "disarmed": "2316100100000000", "pdo": "23001401" "05020000",
    }.items()}  # fmt: skip
    assert list(places) == sorted(places, key=places.__getitem__)
    start = next(place for place, (cob, data) in enumerate(node.received) if (cob, data) == (0, b"\x01\x05"))
    first_sync = next(place for place, (cob, _) in enumerate(node.received) if cob == 0x80)
    last_pdo_write = max(place for place, (cob, data) in enumerate(node.received) if cob == 0x605 and data[2] >= 0x14)
    assert last_pdo_write < start < first_sync


def test_a_description_of_what_was_found(node, drive_of):
    drive = drive_of()
    drive.open(0.005)
    told = drive.describe()
    assert (told.vendor, told.product, told.firmware, told.serial) == (
        "0x12345", "Simulated servo drive 0x77", "1.2.3", "BEEF",
    )  # fmt: skip
    assert told.simulated
    assert told.modes == {Mode.CURRENT, Mode.POSITION}
    assert told.measured == {"position_rad", "velocity_rad_s", "current_a", "supply_v"}
    assert told.resolution["position_rad"] == pytest.approx(COUNT_RAD)
    assert told.resolution["current_a"] == pytest.approx(0.002)


def test_samples_are_si_at_the_joint_and_absent_is_nan(node, drive_of):
    drive = drive_of()
    node.put(0x6064, 0, 1000 + 4096 * 5)
    drive.open(0.005)
    sample = drive.exchange(OFF)
    assert sample.position_rad == pytest.approx(pi / 2)
    assert sample.supply_v == pytest.approx(24.05)
    assert sample.velocity_rad_s == sample.current_a == 0.0
    assert isnan(sample.temperature_c)
    assert isnan(sample.duty)
    assert sample.status is Status.DISABLED
    assert 0.0 < sample.age_s < 0.5


@pytest.mark.parametrize(("motor_sign", "demand"), [(1, "0f00c8000000"), (-1, "0f0038ff0000")])
def test_a_current_command_is_one_frame_before_its_sync(node, drive_of, motor_sign, demand):
    drive = drive_of(replace(JOINT, motor_sign=motor_sign, encoder_sign=motor_sign, zero_rad=0.0))
    node.put(0x6064, 0, 0)
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    node.received.clear()
    first = drive.exchange(Command(Mode.CURRENT, 0.4))
    assert [frame for frame in node.received if frame[0] in (0x205, 0x305, 0x80)] == [
        (0x205, bytes.fromhex(demand)), (0x80, b""),
    ]  # fmt: skip
    second = drive.exchange(Command(Mode.CURRENT, 0.4))
    assert (first.current_a, second.current_a) == (0.0, pytest.approx(0.4)), "TPDOs tell of the time before the command"
    assert second.velocity_rad_s == pytest.approx(20 * 2 * pi / 60 / 20)
    assert second.position_rad == pytest.approx(20 * COUNT_RAD)
    assert second.number == first.number + 1
    assert second.status is Status.ENABLED
    drive.disable()
    assert not node.enabled


def test_cyclic_position_starts_where_the_drive_stands_and_carries_the_offset(node, drive_of):
    drive = drive_of()
    node.put(0x6064, 0, 5000)
    drive.open(0.005)
    drive.enable(Mode.POSITION)
    assert node.get(0x6061) == 8
    assert node.get(0x607A) == 5000
    drive.exchange(Command(Mode.POSITION, 0.5, feed_forward_a=-0.2))
    _await(lambda: node.get(0x60B2) == -100)
    assert node.get(0x607A) == 1000 + round(0.5 / COUNT_RAD)


def test_an_offset_of_position_mode_does_not_outlast_it(node, drive_of):
    drive = drive_of()
    drive.open(0.005)
    drive.enable(Mode.POSITION)
    drive.exchange(Command(Mode.POSITION, 0.0, feed_forward_a=0.2))
    _await(lambda: node.get(0x60B2) == 100)
    drive.disable()
    drive.enable(Mode.CURRENT)
    assert node.get(0x60B2) == 0


def test_profile_position_offers_each_target_once(node, drive_of):
    drive = drive_of(position_mode="profile")
    drive.open(0.005)
    drive.enable(Mode.POSITION)
    assert node.get(0x6061) == 1
    node.received.clear()
    for _ in range(6):
        drive.exchange(Command(Mode.POSITION, 0.1))
    words = [data[0] for cob, data in node.received if cob == 0x305]
    assert words[0] == 0x3F
    assert 1 <= words.count(0x3F) <= 2, "offered until the acknowledgement is seen"
    assert node.get(0x607A) == 1000 + round(0.1 / COUNT_RAD)


def test_an_absent_offset_is_refused_only_where_it_is_used(node, drive_of):
    node.absent.add((0x60B2, 0))
    drive = drive_of()
    drive.open(0.005)
    drive.enable(Mode.POSITION)
    drive.exchange(Command(Mode.POSITION, 0.1))
    with pytest.raises(DriveConfigurationError, match="torque offset"):
        drive.exchange(Command(Mode.POSITION, 0.1, feed_forward_a=0.1))


def test_objects_that_are_absent_are_nan_and_not_said_to_be_measured(node, drive_of):
    node.absent |= {(0x6078, 0), (0x6077, 0), (0x6079, 0), (0x606C, 0), (0x60A9, 0)}
    drive = drive_of()
    drive.open(0.005)
    assert drive.describe().measured == {"position_rad"}
    sample = drive.exchange(OFF)
    assert all(isnan(value) for value in (sample.current_a, sample.supply_v, sample.velocity_rad_s))


def test_without_an_actual_current_the_torque_tells_it(node, drive_of):
    node.absent.add((0x6078, 0))
    drive = drive_of()
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    drive.exchange(Command(Mode.CURRENT, 0.4))
    assert drive.exchange(Command(Mode.CURRENT, 0.4)).current_a == pytest.approx(0.4)


def test_an_epos4_is_known_by_its_vendor(node, drive_of):
    node.absent |= {(0x6075, 0), (0x6078, 0), (0x6079, 0)}
    node.put(0x1018, 1, 0xFB)
    node.objects |= {
        (0x6076, 0): ["<I", 100_000], (0x3001, 5): ["<I", 50_000], (0x30D1, 2): ["<i", -1500], (0x2200, 1): ["<H", 241],
        (0x3201, 1): ["<h", 318], (0x3203, 1): ["<H", 250],
    }  # fmt: skip
    drive = drive_of(duty_sign_from_current=True)
    drive.open(0.005)
    assert drive.describe().vendor == "maxon"
    assert [node.get(0x1A00, sub) for sub in range(4)] == [3, 0x60410010, 0x30D10220, 0x32030110]
    sample = drive.exchange(OFF)
    assert (sample.current_a, sample.duty) == (pytest.approx(-1.5), pytest.approx(-0.25))
    assert (sample.supply_v, sample.temperature_c) == (pytest.approx(24.1), pytest.approx(31.8))
    drive.enable(Mode.CURRENT)
    drive.exchange(Command(Mode.CURRENT, 0.5))
    _await(lambda: node.get(0x6071) == 250)  # of 100 mN m / 50 mN m/A = 2 A


def test_a_drive_of_maxon_without_the_objects_of_an_epos4_is_none(node, drive_of):
    node.put(0x1018, 1, 0xFB)
    drive = drive_of()
    drive.open(0.005)
    assert {"current_a", "supply_v"} <= drive.describe().measured
    row = next(row for row in drive.objects if row.object == "object profile")
    assert row.outcome == (
        "cia402: the objects of CiA 402 itself; it is no epos4, for it has no current actual value (0x30D1:02); "
        "profile in [drive] sets another"
    )


def test_the_profile_that_is_named_is_used(node, drive_of):
    node.put(0x1018, 1, 0xFB)
    drive = drive_of(profile="epos4")
    drive.open(0.005)
    assert "supply_v" not in drive.describe().measured
    assert any("epos4: the configuration says so" in row.outcome for row in drive.objects)


class Unsized(NodeDouble):
    """Does not say how many of the four bytes count, as CiA 301 lets it; the others are whatever was there."""

    def _upload(self, entry, head):
        if entry[0] is None:
            return super()._upload(entry, head)
        return self._answer(b"\x42" + head + struct.pack(entry[0], entry[1]).ljust(4, b"\xa5"))


def test_a_drive_that_does_not_tell_the_length_of_a_value_is_read(channel, drive_of):
    with Unsized(channel):
        drive = drive_of()
        drive.open(0.005)
        assert {"current_a", "supply_v"} <= drive.describe().measured
        assert drive.describe().modes == {Mode.CURRENT, Mode.POSITION}
        drive.close()


def test_the_supply_is_asked_for_between_the_cycles(node, drive_of):
    drive = drive_of(poll_hz=20.0)
    drive.open(0.005)
    node.put(0x6079, 0, 23000)
    before = drive.counts.sent

    def fresh():
        time.sleep(0.002)
        return drive.exchange(OFF).supply_v == pytest.approx(23.0)

    _await(fresh)
    assert drive.counts.answered == drive.counts.sent > before
    assert drive.exchange(OFF).ages.supply_s > 0.0


def test_quick_stop_ends_in_power_off_by_the_drive_itself(node, drive_of):
    drive = drive_of()
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    drive.exchange(Command(Mode.CURRENT, 0.4))
    node.received.clear()
    drive.quick_stop()
    assert next(data for cob, data in node.received if cob == 0x205) == bytes.fromhex("020000000000")
    _await(lambda: drive.exchange(OFF).status is Status.DISABLED)
    assert not node.enabled
    assert node.get(0x1016, 1) == 0, "the watchdog is off with the power"


def test_the_drive_hears_the_host_between_arming_and_power(node, drive_of):
    drive = drive_of(watchdog_s=1.0)
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    drive.disable()
    node.received.clear()
    drive.enable(Mode.CURRENT)  # soon after: the next heartbeat would not be due for a while
    frames = node.received
    armed = next(place for place, (_, data) in enumerate(frames) if data == bytes.fromhex("23161001e8037f00"))
    powered = next(place for place, (cob, data) in enumerate(frames) if cob == 0x205 and data[0] == 0x0F)
    assert (0x77F, b"\x05") in frames[armed:powered]
    node.silent = True
    _await(lambda: not node.enabled, timeout_s=5.0)


def test_time_may_pass_while_the_power_is_off(node, drive_of):
    drive = drive_of(watchdog_s=0.02, answer_s=0.019)
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    drive.disable()
    time.sleep(0.2)
    assert drive.exchange(OFF).status is Status.DISABLED
    drive.enable(Mode.CURRENT)
    assert drive.exchange(Command(Mode.CURRENT, 0.0)).status is Status.ENABLED


def test_the_current_limit_is_set_in_the_drive_and_rounded_down(node, drive_of):
    drive_of(current_limit_a=1.2345).open(0.005)
    assert node.get(0x6073) == 617  # permille of 2 A
    node.stuck.add((0x6073, 0))
    with pytest.raises(DriveConfigurationError, match=r"0.8 A: .*max current .* reads back as 0x269; 0x190 is wanted"):
        drive_of(current_limit_a=0.8).open(0.005)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 70.0])
def test_a_demand_that_makes_no_sense_is_refused_and_nothing_is_sent(node, drive_of, value):
    drive = drive_of()
    drive.open(0.005)
    drive.enable(Mode.CURRENT)
    sent = drive.counts.sent
    with pytest.raises(DriveConfigurationError, match=r"current demand is .*; -65.534 .. 65.534 A is allowed"):
        drive.exchange(Command(Mode.CURRENT, value))
    assert drive.counts.sent == sent


def test_calls_that_do_not_fit_the_state_say_what_to_do(node, drive_of):
    drive = drive_of()
    for call in (drive.disable, drive.quick_stop, drive.clear_fault, lambda: drive.exchange(OFF)):
        with pytest.raises(DriveStateError, match="before open"):
            call()
    drive.close()
    drive.open(0.005)
    with pytest.raises(DriveStateError, match="enable current mode first"):
        drive.exchange(Command(Mode.CURRENT, 0.1))
    with pytest.raises(DriveConfigurationError, match="has no mode 'duty', only current, position"):
        drive.enable(Mode.DUTY)
    drive.close()
    drive.close()


@pytest.mark.parametrize(("period_s", "match"), [(0.06, "half the watchdog"), (0.0, "more than 0"), (0.0003, "bus")])
def test_a_period_that_cannot_be_kept_is_refused(node, drive_of, period_s, match):
    with pytest.raises(DriveConfigurationError, match=match):
        drive_of().open(period_s)


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"node_id": 128}, r"node_id\n.*less than or equal to 127"),
        ({"profile": "epos5"}, "'auto', 'cia402' or 'epos4'"),
        ({"velocity_unit": "rmp"}, r"velocity_unit\n.*'rpm'"),
        ({"position_mode": "cyclical"}, "'cyclic', 'profile'"),
    ],
)
def test_values_that_no_drive_has_are_refused(settings_of, changes, match):
    with pytest.raises(ValidationError, match=match):
        settings_of(**changes)


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"host_node_id": 5}, "host_node_id = 5: 1 .. 127, not the drive's is wanted"),
        ({"answer_s": 0.2}, "less than the watchdog"),
        ({"position_min_rad": -1.0}, "both or neither"),
        ({"position_min_rad": 1.0, "position_max_rad": -1.0}, "less than position_max_rad"),
    ],
)
def test_settings_that_cannot_be_meant_are_refused(settings_of, changes, match):
    with pytest.raises(DriveConfigurationError, match=match):
        settings_of(**changes)


def test_bus_settings_that_cannot_be_meant_are_refused():
    for bus, match in (
        (BusSettings("socketcan", "can0", bitrate=123), "bitrate = 123"),
        (BusSettings("scolan", "can0"), "interface = 'scolan'"),  # type: ignore[arg-type]
        (BusSettings("slcan", ""), "channel = ''"),
    ):
        with pytest.raises(DriveConfigurationError, match=match):
            CanopenSettings(bus=bus, node_id=5)
    with pytest.raises(TypeError):
        BusSettings("slcan", "/dev/ttyACM0", tty_baud=115200)  # type: ignore[call-arg]


@pytest.mark.parametrize(
    ("bus", "step"),
    [
        (BusSettings("slcan", "/dev/no-such-port"), "is the adapter plugged in"),
        (BusSettings("socketcand", "can0", host="127.0.0.1", port=9), "does socketcand run at 127.0.0.1:9"),
    ],
)
def test_a_bus_that_is_not_there_is_said_so_with_the_next_step(bus, step):
    drive = CanopenDrive(CanopenSettings(bus=bus, node_id=5), JOINT)
    with pytest.raises(DriveConnectionError, match=step):
        drive.open(0.005)


def _ignores_a_lost_host(node):
    node.put(0x6007, 0, 0)
    node.stuck.add((0x6007, 0))


@pytest.mark.parametrize(
    ("broken", "match"),
    [
        (lambda node: node.stuck.add((0x1016, 1)), "consumer heartbeat time .* reads back as 0x0; 0x7F0064 is wanted"),
        (_ignores_a_lost_host, "takes none of quick stop .* power off .* fault"),
        (lambda node: node.absent.add((0x1016, 1)), "consumer heartbeat time .* Object does not exist"),
    ],
)
def test_a_watchdog_that_cannot_be_set_is_told_and_the_drive_stays_off(node, drive_of, broken, match):
    broken(node)
    with pytest.raises(WatchdogError, match=match):
        drive_of().open(0.005)
    assert node.nmt != 5


@pytest.mark.parametrize("key", [(0x1A00, 1), (0x1601, 0), (0x1400, 1)])
def test_a_pdo_that_reads_back_otherwise_is_passed_over(node, drive_of, key):
    node.stuck.add(key)
    drive = drive_of()
    drive.open(0.005)
    assert drive.exchange(OFF).status is Status.DISABLED


@pytest.mark.parametrize(("first", "kind"), [(0x1600, "RPDO"), (0x1A00, "TPDO")])
def test_a_drive_whose_pdos_are_all_locked_is_refused_with_the_reason(node, drive_of, first, kind):
    for number in range(4):
        node.stuck |= {(first + number, place) for place in range(5)}
    with pytest.raises(DriveConfigurationError, match=f"no {kind} of the drive takes .* is wanted"):
        drive_of().open(0.005)
    assert node.nmt != 5


@pytest.mark.parametrize(("locked", "reaction"), [((0x6007, 0), 1), ((0x605A, 0), 2)])
def test_another_reaction_that_ends_in_power_off_will_do(node, drive_of, locked, reaction):
    """The fault, where 0x6007 stands at it; power off at once, where quick stops are fixed to stay powered."""
    node.read_only.add(locked)
    drive_of().open(0.005)
    assert node.get(0x6007) == reaction
