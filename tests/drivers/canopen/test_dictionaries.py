"""Drives made from dictionaries: those of a folder that the environment names, and small ones of the suite's own."""

import os
import re
from pathlib import Path

import pytest

from drivers.errors import DriveError
from sim_backend.devices.canopen.serve import data_sheet
from tests.drivers.canopen.conversation import driver_of, started
from tests.drivers.canopen.dictionaries import files_of, resets, try_dictionary

FOLDER = os.environ.get("FRICTION_BENCH_DICTIONARIES", "")
FOREIGN = files_of(Path(FOLDER)) if FOLDER else []

pytestmark = pytest.mark.wall_clock


@pytest.mark.skipif(not FOREIGN, reason="FRICTION_BENCH_DICTIONARIES names no folder of EDS and DCF files")
@pytest.mark.parametrize("path", FOREIGN, ids=lambda path: path.name)
def test_a_dictionary_of_a_real_drive(path):
    tried = try_dictionary(path)
    assert tried.is_complete, tried


def without(text: str, *indices: int) -> str:
    """A data sheet without some objects, as if the drive had none."""
    for index in indices:
        text = re.sub(rf"(?ms)^\[{index:X}(sub[0-9A-F]+)?\].*?(?=^\[)", "", text)
        text = re.sub(rf"(?im)^\d+=0x{index:X}\n", "", text)
    return text


def constant(text: str, index: int) -> str:
    """A data sheet with an object that may only be read."""
    section = re.search(rf"(?ms)^\[{index:X}\].*?(?=^\[)", text)
    assert section, f"0x{index:X} is not in the data sheet"
    return text.replace(section[0], re.sub(r"(?m)^AccessType=.*$", "AccessType=const", section[0]))


TRAITS = {
    "SYNC's COB-ID is fixed": lambda text: constant(text, 0x1005),
    "no reaction of its own to set": lambda text: without(text, 0x6007),
    "no quick stop option": lambda text: without(text, 0x605A),
    "no interpolation period": lambda text: without(text, 0x60C2),
    "no rated current, no current": lambda text: without(text, 0x6075, 0x6078),
    "no error code": lambda text: without(text, 0x603F),
}


@pytest.mark.parametrize("trait", TRAITS)
def test_a_drive_that_differs(trait, tmp_path):
    path = tmp_path / "drive.eds"
    path.write_text(TRAITS[trait](data_sheet("generic")), encoding="utf-8")
    tried = try_dictionary(path)
    assert tried.is_complete, tried


def test_a_drive_without_any_watchdog_is_not_opened(tmp_path):
    path = tmp_path / "drive.eds"
    text = without(data_sheet("generic"), 0x1016, 0x100C, 0x100D)
    path.write_text(re.sub(r"(?ms)^\[140[0-9A-F]sub5\].*?(?=^\[)", "", text), encoding="utf-8")
    with started("slcan", "--eds", str(path), "--node", "5") as device, driver_of(device) as drive:
        with pytest.raises(DriveError, match="Without one it must not move"):
            drive.open(0.01)
        assert not device.truth()["powered"]


@pytest.mark.parametrize("look_s", [0.004, 0.02])
def test_a_fault_is_reset_at_a_drive_that_looks_seldom(look_s):
    assert resets(look_s, 6) == 6
