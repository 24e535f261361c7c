"""Seeing whether the drive stops by itself: silence with the power on and nothing demanded, then a look."""

from contextlib import suppress
from time import perf_counter
from typing import Final

from drivers.canopen.cia301.objects import STATUSWORD
from drivers.canopen.cia402.state_machine import State, state_of
from drivers.canopen.session import Session
from drivers.errors import DriveError

_MARGIN: Final = 1.5  # of its own time-out that a drive is given
_LEAST_S: Final = 0.1
_LOOKS_S: Final = 0.02  # at frames that come in


def stops_when_silent(session: Session) -> bool:
    """Send nothing for longer than the watchdog waits, then ask for the state by SDO: reading puts off no watchdog.

    Args:
        session: with the drive in operation enabled. Whatever comes of it, the caller switches it off.

    Returns:
        Whether the drive has left operation enabled.
    """
    deadline_s = perf_counter() + session.settings.watchdog_s * _MARGIN + _LEAST_S
    while (remaining_s := deadline_s - perf_counter()) > 0.0:
        session.link.receive(min(remaining_s, _LOOKS_S))
    state = State.ENABLED  # of a drive that does not answer nobody knows
    with suppress(DriveError):
        state = state_of(session.access.read(STATUSWORD))
    return state is not State.ENABLED
