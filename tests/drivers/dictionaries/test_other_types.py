"""Drives whose objects are not as CiA 402 has them: of another width, in no PDO. What is told of them is true."""

import pytest

from bench.config.configuration import default_configuration
from bench.control.servo import check_modes, held_back
from bench.errors import ConfigurationError
from drivers.canopen.cia301.objects import MAX_TORQUE, MODE, PROFILE_VELOCITY, TORQUE
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError
from sim_backend.devices.canopen.data_types import I32, U16, U32
from sim_backend.devices.canopen.objects.entry import Access, variable
from tests.drivers.dictionaries.attempt import PERIOD_S, RATED_A, device, host
from tests.drivers.dictionaries.traits import PROFILE_TORQUE, TRAITS, Trait, without_pdo

pytestmark = pytest.mark.virtual_time
UNRATED = (0x6075, 0x6076, 0x6078)
SEVEN = 0x40E0_0000  # as a floating point number
WIDE = Trait(
    without=(*UNRATED, 0x6071, 0x6072, 0x6073, 0x6077),
    added=(
        variable(0x6071, "Target torque", I32, Access.RW),
        variable(0x6072, "Max torque", U32, Access.RW, SEVEN),
        variable(0x6077, "Torque actual value", I32, Access.RO),
    ),
)


UNMAPPED = Trait(without=(*UNRATED, 0x6071, 0x6077), added=without_pdo(0x6071, 0x6077))


def rows_of(drive, purpose):
    return {row.object.split(" (")[0]: row for row in drive.objects if row.purpose == purpose}


@pytest.mark.parametrize("trait", [WIDE, UNMAPPED])
@pytest.mark.parametrize("rated", [{}, {"rated_current_a": RATED_A}])
def test_a_setting_that_would_change_nothing_is_not_asked_for(trait, rated, tmp_path) -> None:
    with device(trait.write(tmp_path, "effort")) as running, host(running, **rated) as drive:
        drive.open(PERIOD_S)
        found = drive.describe()
        assert (found.untold, found.modes) == (None, {Mode.POSITION})
        assert "current_a" not in found.measured
        assert not [note for note in found.notes if "rated_current_a" in note]


def test_an_object_of_another_width_is_done_without_and_says_why(tmp_path) -> None:
    with device(WIDE.write(tmp_path, "wide")) as running, host(running, rated_current_a=RATED_A) as drive:
        drive.open(PERIOD_S)
        wide = "of another data type: 4 bytes came (0x00000000), 2 are allowed by CiA 402"
        assert rows_of(drive, "measured")["torque actual value"].outcome == wide
        assert f"target torque (0x6071:00) is {wide}" in rows_of(drive, "mode")["mode 'current'"].outcome
        limit = rows_of(drive, "limit in the drive")["max torque"]
        assert limit.outcome == "of another data type: 4 bytes came (0x40E00000), 2 are allowed by CiA 402"
        assert not [note for note in drive.describe().notes if "may not move" in note or "limits the motor" in note]


def test_an_object_in_no_pdo_says_so_in_the_words_of_the_drive(tmp_path) -> None:
    with device(UNMAPPED.write(tmp_path, "unmapped")) as running, host(running, rated_current_a=RATED_A) as drive:
        drive.open(PERIOD_S)
        why = "Code 0x06040041, Object cannot be mapped to the PDO"
        assert rows_of(drive, "process data")["torque actual value"].outcome == f"not measured, no TPDO takes it: {why}"
        mode = rows_of(drive, "mode")["mode 'current'"]
        assert mode.outcome == f"no RPDO takes target torque (0x6071:00) with the controlword: {why}"


def test_whoever_needs_an_object_of_another_width_is_told_what_was_found(tmp_path) -> None:
    sheet = WIDE.write(tmp_path, "wide")
    with device(sheet) as running, host(running) as drive:
        drive.open(PERIOD_S)
        assert drive._session is not None
        says = r"node 5': max torque \(0x6072:00\) is of another data type: 4 bytes came \(0x40E00000\), 2 are allowed"
        with pytest.raises(DriveConfigurationError, match=says):
            drive._session.access.read(MAX_TORQUE)
    with device(sheet) as running, host(running, rated_current_a=RATED_A, current_limit_a=0.5) as drive:
        says = r"neither max current \(0x6073:00\) nor max torque \(0x6072:00\) as CiA 402 has them; leave it out"
        with pytest.raises(DriveConfigurationError, match=says):
            drive.open(PERIOD_S)


@pytest.mark.parametrize(
    ("item", "data", "value"),
    [
        (MODE, b"\xff", -1),
        (MODE, b"\x08\0\0\0", 8),
        (MODE, b"\xff\0\0\0", None),  # 255 in 32 bits, which is no mode
        (PROFILE_VELOCITY, b"\x10\x27", 10_000),
        (MODE, b"", None),
        (TORQUE, b"\xff\xff", -1),
        (TORQUE, b"\0\0\0\0", None),
        (TORQUE, b"\x05", None),
    ],
)
def test_what_an_answer_of_some_length_means(item, data, value) -> None:
    assert item.read(data) == value


def test_a_mode_in_more_bytes_than_one_means_the_same(tmp_path) -> None:
    shown = Trait(without=(0x6061,), added=(variable(0x6061, "Modes of operation display", U16, Access.RO),))
    with device(shown.write(tmp_path, "wide-mode")) as running, host(running) as drive:
        drive.open(PERIOD_S)
        drive.enable(Mode.CURRENT)
        drive.disable()


@pytest.mark.parametrize("name", ["no-sync-object", "life-guarding", "rpdo-timer"])
def test_nothing_that_is_required_is_done_without(name, tmp_path) -> None:
    with device(TRAITS[name].write(tmp_path, name)) as running, host(running) as drive:
        drive.open(PERIOD_S)
        _, objects = drive.describe().tables
        assert not [row for row in objects.rows if row[1] == "required, done without"]


def test_a_rated_current_by_torque_and_constant_is_told_as_such(tmp_path) -> None:
    with (
        device(Trait(without=(0x6075,)).write(tmp_path, "torque")) as running,
        host(running, torque_constant_n_m_a=0.05) as drive,
    ):
        drive.open(PERIOD_S)
        row = next(row for row in drive.units if "1000 permille" in row.quantity)
        assert row.drive.endswith("by motor rated torque (0x6076:00) / motor.torque_constant_n_m_a of the rig")
        assert float(row.drive.split()[0]) == pytest.approx(row.configuration, rel=1e-5)


def test_values_of_the_communication_profile_are_told_by_their_digits(tmp_path) -> None:
    with device(Trait().write(tmp_path, "digits")) as running, host(running) as drive:
        drive.open(PERIOD_S)
        assert rows_of(drive, "SYNC")["COB-ID of SYNC"].outcome == "0x80"
        assert rows_of(drive, "identity")["device type"].outcome == "0x20192"


def test_a_drive_without_any_mode_says_what_would_give_it_one(tmp_path) -> None:
    torque_alone = Trait(without=UNRATED, default={(0x6502, 0): PROFILE_TORQUE})
    sheet = torque_alone.write(tmp_path, "modeless")
    with device(sheet) as running, host(running) as drive:
        drive.open(PERIOD_S)
        found = drive.describe()
        assert not found.modes
        [note] = [note for note in found.notes if note.startswith("It has no mode that can be used: ")]
        assert "profile torque (4): what 1000 permille of torque are in A is told by neither drive" in note
        assert "profile position (1): not in supported drive modes" in note
        with pytest.raises(ConfigurationError, match=r"no mode that can be used: .* set rated_current_a in \[drive\]"):
            check_modes(default_configuration().servo, found)
        with pytest.raises(
            DriveConfigurationError, match="has no mode 'position', nor any other; 'friction-bench doctor'"
        ):
            drive.enable(Mode.POSITION)
    with device(sheet) as running, host(running, rated_current_a=RATED_A) as drive:
        drive.open(PERIOD_S)
        assert drive.describe().modes == {Mode.CURRENT}


@pytest.mark.parametrize(("permille", "held_a"), [(100, 0.1), (0, 0.0)])
def test_a_drive_that_holds_back_its_current_is_known_to(permille, held_a, tmp_path) -> None:
    sheet = Trait().write(tmp_path, "held-back")
    configuration = default_configuration()
    with device(sheet) as running:
        running.device.dictionary.put(0x6073, 0, permille)
        with host(running, rated_current_a=RATED_A) as drive:
            drive.open(PERIOD_S)
            limit = drive.describe().own_limit
            assert limit is not None
            assert limit.current_a == pytest.approx(held_a)
            held = held_back(configuration.servo, configuration.search, drive.describe())
            assert held.startswith(limit.words.removesuffix("."))
            assert "search.ceiling_a is " in held
        with host(running, rated_current_a=RATED_A, current_limit_a=2.0) as drive:
            drive.open(PERIOD_S)
            assert held_back(configuration.servo, configuration.search, drive.describe()) == ""
