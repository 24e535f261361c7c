"""Every data sheet of a real drive that is at hand: it runs, or is refused for want of a watchdog."""

import pytest

from drivers.contract import Watchdog
from sim_backend.devices.canopen.conduct import Conduct
from tests.drivers.dictionaries.attempt import attempt
from tests.drivers.dictionaries.homing import home
from tests.drivers.dictionaries.real import FOLDER, real_sheets

MISSING = pytest.param(None, marks=pytest.mark.skip(reason=f"{FOLDER} names no folder with EDS or DCF files"))
SHEETS = [pytest.param(path, id=path.name) for path in real_sheets()] or [MISSING]


@pytest.mark.parametrize("sheet", SHEETS)
def test_it_runs_or_is_refused_for_safety(sheet) -> None:
    result = attempt(sheet)
    assert result.is_right, result


@pytest.mark.parametrize("sheet", SHEETS)
def test_it_runs_with_bad_manners(sheet) -> None:
    manners = Conduct(look_s=0.02, mode_shown_enabled=True, absent_code=0x08000000, refused_code=0x060A0023)
    result = attempt(sheet, manners)
    assert result.is_right, result


@pytest.mark.parametrize("sheet", SHEETS)
def test_one_that_never_watches_is_never_called_proven(sheet) -> None:
    result = attempt(sheet, Conduct(deaf=True, reaction="nothing"))
    assert result.watchdog is not Watchdog.PROVEN
    assert not result.stopped


@pytest.mark.parametrize("sheet", SHEETS)
def test_it_homes_or_is_told_what_it_lacks(sheet) -> None:
    homed = home(sheet)
    assert homed.found or "no homing method (0x6098:00)" in homed.refusal, homed
