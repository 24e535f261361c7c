"""Seeing whether the drive stops by itself: silence with the power on and nothing demanded, then a look."""

from contextlib import suppress
from time import perf_counter
from typing import Final

from drivers.canopen.cia301.objects import POSITION, STATUSWORD
from drivers.canopen.cia402.state_machine import State, state_of
from drivers.canopen.guard import Kind
from drivers.canopen.session import Session
from drivers.errors import DriveError, WatchdogError

_MARGIN: Final = 1.5  # of its own time-out that a drive is given
_LEAST_S: Final = 0.1
_LOOKS_S: Final = 0.02  # between two looks at where the joint is
_FARTHEST_RAD: Final = 0.1  # that the joint may go meanwhile: the free play of a gear


def stops_when_silent(session: Session) -> bool:
    """Send nothing for longer than the watchdog waits, then ask for the state by SDO: reading puts off no watchdog.

    The position is read meanwhile, for no other limit watches: a brake that lets go may let the arm fall. Of a
    watchdog that was set with the drive's own tool nobody knows what puts it off; there it is read afterwards alone.

    Args:
        session: with the drive in operation enabled. Whatever comes of it, the caller switches it off.

    Returns:
        Whether the drive has left operation enabled.

    Raises:
        WatchdogError: the joint moves, though nothing is demanded.
    """
    start_counts = session.position_counts
    deadline_s = perf_counter() + session.settings.watchdog_s * _MARGIN + _LEAST_S
    while (remaining_s := deadline_s - perf_counter()) > 0.0:
        session.link.receive(min(remaining_s, _LOOKS_S))
        if session.guard.kind is not Kind.IN_DRIVE:
            _check_rest(session, start_counts)
    _check_rest(session, start_counts)
    state = State.ENABLED  # of a drive that does not answer nobody knows
    with suppress(DriveError):
        state = state_of(session.access.read(STATUSWORD))
    return state is not State.ENABLED


def _check_rest(session: Session, start_counts: int) -> None:
    moved_rad = 0.0
    with suppress(DriveError):
        moved_rad = abs(session.access.read(POSITION) - start_counts) * session.found.scale.joint.count_rad
    if moved_rad > _FARTHEST_RAD:
        raise WatchdogError(
            session.settings.device,
            f"the joint moved by {moved_rad:.3g} rad while its watchdog was tried with nothing demanded; at most "
            f"{_FARTHEST_RAD:g} rad is allowed, for no limit watches then. Let the arm hang at rest, then try again",
        )
