"""Pacing. Only what holds on a busy machine is asked."""

import time

from bench.control.clock import VirtualClock, WallClock


def test_the_virtual_clock_never_waits():
    clock = VirtualClock()
    clock.start(10.0)
    before_s = time.perf_counter()
    for _ in range(1000):
        clock.wait()
    assert time.perf_counter() - before_s < 1.0
    assert clock.overruns == 0


def test_the_wall_clock_is_never_early_and_keeps_its_grid():
    clock = WallClock()
    began_s = time.perf_counter()
    clock.start(0.005)
    for cycle in range(1, 21):
        clock.wait()
        assert time.perf_counter() - began_s >= cycle * 0.005


def test_lost_cycles_are_counted_and_not_made_up_for():
    clock = WallClock()
    clock.start(0.01)
    time.sleep(0.055)
    clock.wait()
    assert clock.overruns >= 4
    before_s = time.perf_counter()
    clock.wait()
    assert time.perf_counter() - before_s > 0.005
