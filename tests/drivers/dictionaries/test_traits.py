"""Each trait that real drives have, alone: the drive runs, or is refused for want of a watchdog."""

from dataclasses import replace

import pytest

from drivers.canopen.cia301.object_access import ObjectAccess
from drivers.canopen.cia301.objects import POSITION
from drivers.contract import Command, Mode, Watchdog
from drivers.errors import DriveConfigurationError, WatchdogError
from sim_backend.devices.canopen.conduct import Conduct
from sim_backend.devices.canopen.objects.entry import Access
from tests.drivers.dictionaries.attempt import PERIOD_S, RATED_A, attempt, cycles, device, host
from tests.drivers.dictionaries.traits import PROFILE_POSITION, TRAITS, Trait, without_pdo

pytestmark = pytest.mark.virtual_time
MANNERS = {
    "looks-every-20-ms": Conduct(look_s=0.02),
    "mode-shown-late": Conduct(mode_shown_enabled=True),
    "late-answers": Conduct(answer_s=0.03),
    "other-abort-codes": Conduct(absent_code=0x08000000, refused_code=0x060A0023),
    "slow-brake": Conduct(enable_s=0.6),
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.real_wire] * (name == "plain")) for name in TRAITS]
)
def test_a_drive_with_this_trait_runs_or_is_refused_for_safety(name, tmp_path) -> None:
    trait = TRAITS[name]
    result = attempt(trait.write(tmp_path, name), **trait.settings)
    assert result.is_right, result
    assert result.is_safety is trait.is_refused, result
    if not trait.is_refused:
        assert result.modes == trait.modes


@pytest.mark.parametrize("name", MANNERS)
def test_a_drive_with_these_manners_runs(name, tmp_path) -> None:
    trait = TRAITS["no-current"]  # one with something absent to be told of
    result = attempt(trait.write(tmp_path, name), MANNERS[name])
    assert result.is_right, result
    assert not result.is_safety


@pytest.mark.parametrize(
    ("name", "without", "takes"), [("torque mode", (), True), ("positions alone", (0x6071,), False)]
)
def test_a_drive_that_does_not_tell_its_rated_current_asks_for_it(name, without, takes, tmp_path) -> None:
    unrated = Trait(without=(0x6075, 0x6076, 0x6078, *without))
    with device(unrated.write(tmp_path, name.replace(" ", "-"))) as running:
        with host(running) as drive:
            drive.open(PERIOD_S)
            found = drive.describe()
            assert found.modes == {Mode.POSITION}
            assert found.untold is not None
            assert (found.untold.tells, found.untold.takes) == (True, takes)
            assert [note for note in found.notes if "set rated_current_a in [drive]" in note]
        with host(running, rated_current_a=RATED_A) as drive:
            drive.open(PERIOD_S)
            found = drive.describe()
            assert found.untold is None
            assert "current_a" in found.measured
            assert (Mode.CURRENT in found.modes) is takes


def test_a_drive_that_brakes_for_long_is_not_said_to_have_its_cause_still(tmp_path) -> None:
    held = {(index, 0): Access.RO for index in (0x6085, 0x605E)}
    sheet = Trait(without=(0x6007,), default={(0x6085, 0): 200}, access=held).write(tmp_path, "slow-ramp")
    result = attempt(sheet)
    assert result.moved
    assert "cannot be cleared: 0x8130" in result.refusal
    assert "the drive brakes still: its ramps may be slow, 0x6085 or 0x6084" in result.refusal


def test_a_drive_that_holds_back_its_current_says_so_before_anything_moves(tmp_path) -> None:
    sheet = Trait(default={(0x6072, 0): 100}).write(tmp_path, "held-back")
    with device(sheet) as running:
        with host(running, rated_current_a=RATED_A) as drive:
            drive.open(PERIOD_S)
            notes = drive.describe().notes
            assert (
                "The drive limits the motor current to 0.1 A (max torque (0x6072:00)); current_limit_a sets it."
                in notes
            )
        with host(running, rated_current_a=RATED_A, current_limit_a=0.5) as drive:
            drive.open(PERIOD_S)
            assert not [note for note in drive.describe().notes if "limits the motor current" in note]


def test_a_drive_that_limits_its_current_to_nothing_says_what_to_set(tmp_path) -> None:
    with device(TRAITS["plain"].write(tmp_path, "no-limit")) as running:
        running.device.dictionary.put(0x6073, 0, 0)  # nobody has commissioned it
        with host(running) as drive:
            drive.open(PERIOD_S)
            says = "The drive may not move the motor, for its max current (0x6073:00) is 0; set current_limit_a [A]"
            assert [note for note in drive.describe().notes if note.startswith(says)]
        with host(running, current_limit_a=0.5) as drive:
            drive.open(PERIOD_S)
            assert not [note for note in drive.describe().notes if "may not move" in note]


def test_a_current_that_fits_no_pdo_is_measured_as_torque(tmp_path) -> None:
    with device(TRAITS["current-in-no-pdo"].write(tmp_path, "torque")) as running, host(running) as drive:
        drive.open(PERIOD_S)
        drive.enable(Mode.CURRENT)
        sample = cycles(drive, Command(Mode.CURRENT, 0.3), 0.2)
        assert sample.current_a == pytest.approx(0.3, rel=0.1)
        assert any("current actual value" in row.object and not row.found for row in drive.objects)


@pytest.mark.parametrize("access", [Access.RW, Access.RO])
def test_a_mapping_that_was_found_is_used_after_others_were_refused(access, tmp_path) -> None:
    picky = TRAITS["one-pdo-of-its-own-choice"]
    sheet = replace(picky, access={(0x1A00, place): access for place in (1, 2)}).write(tmp_path, "picky")
    with device(sheet) as running, host(running) as drive:
        drive.open(PERIOD_S)
        assert [running.device.dictionary.number(0x1A00, place) for place in range(3)] == [2, 0x60410010, 0x60640020]


HELD_TYPES = {(0x1400 + number, 2): Access.RO for number in range(4)}


@pytest.mark.parametrize(
    ("trait", "says"),
    [
        (
            Trait(access=HELD_TYPES, default=dict.fromkeys(HELD_TYPES, 252)),
            r"RPDO1 \(0x1400:02\) reads back as 0xFC; 0x1",
        ),
        (Trait(without=(0x6064,)), r"has no position actual value \(0x6064:00\) .*Object does not exist"),
        (
            Trait(without=(0x607A,), added=without_pdo(0x607A), default={(0x6502, 0): PROFILE_POSITION}),
            r"writing 0x607A0020 to mapping of RPDO1 \(0x1600:02\): refused",
        ),
    ],
)
def test_a_drive_that_lacks_what_every_cycle_needs_is_told_so(trait, says, tmp_path) -> None:
    with (
        device(trait.write(tmp_path, "lacking")) as running,
        host(running) as drive,
        pytest.raises(DriveConfigurationError, match=says),
    ):
        drive.open(PERIOD_S)


def test_a_drive_that_cannot_show_its_mode_gets_no_power(tmp_path) -> None:
    says = r"has no modes of operation display \(0x6061:00\) .*modes of operation \(0x6060:00\) tells only which one"
    with device(Trait(without=(0x6061,)).write(tmp_path, "hidden-mode")) as running, host(running) as drive:
        drive.open(PERIOD_S)
        with pytest.raises(DriveConfigurationError, match=says):
            drive.enable(Mode.CURRENT)
        assert running.device.axis.power.since_s == 0.0


@pytest.mark.parametrize("name", ["plain", "life-guarding", "rpdo-timer", "no-reaction-object"])
def test_a_drive_that_never_watches_is_never_called_proven(name, tmp_path) -> None:
    result = attempt(TRAITS[name].write(tmp_path, name), Conduct(deaf=True))
    assert result.watchdog is not Watchdog.PROVEN
    assert not result.stopped


def test_a_reaction_that_the_drive_does_not_tell_is_tried_before_the_first_motion(tmp_path) -> None:
    sheet = TRAITS["no-reaction-object"].write(tmp_path, "sheet")
    assert attempt(sheet).watchdog is Watchdog.PROVEN
    refused = attempt(sheet, Conduct(reaction="nothing"))
    assert refused.opened
    assert refused.is_safety
    assert not refused.moved


def test_a_joint_that_moves_during_that_trial_ends_it(tmp_path, monkeypatch) -> None:
    sheet, read = TRAITS["no-reaction-object"].write(tmp_path, "sheet"), ObjectAccess.read
    with device(sheet) as running, host(running) as drive:
        drive.open(PERIOD_S)
        falls = iter(range(0, 100_000, 4096))  # a turn of the motor at each look
        monkeypatch.setattr(
            ObjectAccess, "read", lambda access, item: next(falls) if item == POSITION else read(access, item)
        )
        with pytest.raises(WatchdogError, match=r"the joint moved by 0.314 rad while its watchdog was tried"):
            drive.enable(Mode.CURRENT)
        assert not running.device.axis.power.on
