"""Waiting for a moment, to a few microseconds where it matters."""

import time

from sim_backend.devices.wall_time import WallTime

_SPIN_S = 2e-4  # a nap on a busy machine ends late by about this much


def pause_until(clock: WallTime, at_s: float) -> None:
    """Return at a time [s] of the clock, or at once where that is over."""
    left_s = at_s - clock.now_s()
    if left_s > _SPIN_S:
        time.sleep(left_s - _SPIN_S)
    while clock.now_s() < at_s:
        pass
