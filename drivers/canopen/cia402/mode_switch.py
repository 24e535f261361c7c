"""Switching the mode of operation (0x6060), and seeing it shown (0x6061): with the power off, or only once it is on."""

import time
from collections.abc import Callable
from time import perf_counter
from typing import Final

from drivers.canopen.cia301.object_access import ObjectRefusedError
from drivers.canopen.cia301.objects import MODE, MODE_DISPLAY, TARGET_TORQUE, TARGET_VELOCITY
from drivers.canopen.cia402.state_machine import DISABLE_VOLTAGE
from drivers.canopen.session import Session
from drivers.canopen.slow_poll import SlowPoll
from drivers.errors import DriveConfigurationError

_LOOK_S: Final = 0.1  # a drive that shows the mode with the power off does so soon
_PAUSE_S: Final = 0.002


class ModeSwitch:
    """One change of mode.

    Args:
        session: with the power off.
        code: of 0x6060.
    """

    def __init__(self, session: Session, code: int) -> None:
        self._session = session
        self._code = code

    def select(self) -> bool:
        """Ask for the mode; tell whether the drive shows it already.

        What 0x6060 reads back is no sign of it: that is the mode that was asked for (CiA 402-2).

        Raises:
            DriveConfigurationError: it refuses, or cannot show any.
        """
        access = self._session.access
        try:
            access.write(MODE, self._code)
        except ObjectRefusedError as refusal:
            raise self._refused(str(refusal)) from refusal
        deadline_s = perf_counter() + min(_LOOK_S, self._session.settings.mode_s)
        while self._shown() != self._code:
            if perf_counter() > deadline_s:
                return False
            time.sleep(_PAUSE_S)
        return True

    def _shown(self) -> int:
        try:
            return self._session.access.read(MODE_DISPLAY)
        except ObjectRefusedError as refusal:
            raise DriveConfigurationError(
                self._session.settings.device,
                f"has no {MODE_DISPLAY} that can be read ({refusal.why}): nobody would know in which mode it moves. "
                f"{MODE} tells only which one was asked for; look in the drive's own tool for a firmware with both",
            ) from refusal

    def rest_every_target(self) -> None:
        """Have nothing demanded in any mode: it is not known yet which one the drive will be in."""
        session = self._session
        for pdo in session.data.demands.values():
            session.cycle.run(pdo.cob_id, session.data.nothing(pdo, DISABLE_VOLTAGE, session.position_counts))
        for item in (TARGET_TORQUE, TARGET_VELOCITY):
            if item not in session.data.demands:
                session.table.try_set(item, 0, "at rest before the mode is shown")

    def await_shown(self, step: Callable[[], object]) -> None:
        """Wait for the mode to be shown, now that the power is on.

        Raises:
            DriveConfigurationError: it is not shown in time. The caller switches off.
        """
        session, limit_s = self._session, self._session.settings.mode_s
        usual, session.poll = session.poll, SlowPoll((MODE_DISPLAY,), 0.0, session.settings.sdo_answer_s)
        try:
            deadline_s = perf_counter() + limit_s + session.settings.sdo_answer_s
            while perf_counter() < deadline_s:
                session.ask_slow(perf_counter())
                step()
                shown = session.poll.readings.get(MODE_DISPLAY)
                if shown is not None and shown.value == self._code:
                    return
                time.sleep(_PAUSE_S)
            raise self._refused(f"{MODE_DISPLAY} stays {'untold' if shown is None else shown.value}")
        finally:
            session.poll = usual

    def _refused(self, problem: str) -> DriveConfigurationError:
        return DriveConfigurationError(
            self._session.settings.device,
            f"mode {self._code} is refused: {problem}; {self._code} is wanted. Does the drive's own tool allow it?",
        )
