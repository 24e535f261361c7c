"""A fault that the drive holds on to, on the page: read, shown, cleared; tests/drivers has the same on a wire."""

import pytest

from bench.control.drive_faults import DriveState
from bench.errors import FaultChangedError

pytestmark = pytest.mark.browser


@pytest.fixture
def drive(service, monkeypatch):
    """What the drive says, in a list that the test may change; and what was asked to be cleared."""
    faults, asked = ["over-current"], []

    def read():
        return (DriveState("joint", "/dev/ttyUSB0 unit 1", "fault" if faults else "disabled", "; ".join(faults)),)

    def clear(shown):
        asked.append(shown)
        if shown != "; ".join(faults):
            raise FaultChangedError(f"the fault is '{faults[0]}' now, and '{shown}' was shown; nothing was cleared")
        faults.clear()
        return read()

    monkeypatch.setattr(service.runner, "read_drives", read)
    monkeypatch.setattr(service.runner, "clear_faults", clear)
    return faults, asked


def test_the_fault_is_shown_before_it_can_be_cleared(drive, open_page):
    _, asked = drive
    page = open_page()
    clear = page.get_by_role("button", name="Its cause is removed: clear the fault")
    read = page.get_by_role("button", name="Read the drive's state")
    read.wait_for()
    assert clear.count() == 0
    read.click()
    page.get_by_text("/dev/ttyUSB0 unit 1: fault: over-current").wait_for()
    clear.click()
    page.get_by_text("Cleared: over-current. The power is off.").wait_for()
    assert asked == ["over-current"]
    assert clear.count() == 0


def test_a_fault_that_is_another_one_by_now_is_not_cleared(drive, open_page):
    faults, _ = drive
    page = open_page()
    page.get_by_role("button", name="Read the drive's state").click()
    page.get_by_text("fault: over-current").wait_for()
    faults[0] = "under-voltage"
    page.get_by_role("button", name="Its cause is removed: clear the fault").click()
    page.get_by_text("the fault is 'under-voltage' now, and 'over-current' was shown").wait_for()
    open_page.expected.append("409")  # the browser names each such answer
    assert faults == ["under-voltage"]
