"""Rows for who watches."""

import numpy as np

from bench.runs.live import LiveBuffer


def block(first, count):
    return np.arange(first, first + count, dtype=float).reshape(-1, 1)


def numbers(answer):
    return answer.rows[:, 0].tolist()


def test_rows_are_given_once():
    live = LiveBuffer(("x",))
    live.append(block(0, 3))
    first = live.since(-1, 100)
    assert (numbers(first), first.last_row, first.restarted) == ([0, 1, 2], 2, False)
    live.append(block(3, 2))
    then = live.since(first.last_row, 100)
    assert (numbers(then), then.last_row, then.restarted) == ([3, 4], 4, False)
    nothing = live.since(then.last_row, 100)
    assert (numbers(nothing), nothing.last_row, nothing.restarted) == ([], 4, False)


def test_part_of_a_block():
    live = LiveBuffer(("x",))
    live.append(block(0, 10))
    assert numbers(live.since(6, 100)) == [7, 8, 9]


def test_too_many_rows_leave_the_newest_and_say_so():
    live = LiveBuffer(("x",))
    live.append(block(0, 10))
    answer = live.since(2, 4)
    assert (numbers(answer), answer.restarted) == ([6, 7, 8, 9], True)


def test_a_new_trial_starts_over_and_numbers_go_on():
    live = LiveBuffer(("x",))
    live.append(block(0, 5))
    live.begin_trial()
    live.append(block(100, 2))
    answer = live.since(4, 100)
    assert (numbers(answer), answer.last_row, answer.restarted) == ([100, 101], 6, True)
    assert live.since(2, 100).restarted


def test_the_oldest_rows_go():
    live = LiveBuffer(("x",), capacity=10)
    for first in range(0, 100, 4):
        live.append(block(first, 4))
    answer = live.since(-1, 1000)
    assert answer.restarted
    assert numbers(answer)[-1] == 99
    assert 10 <= len(answer.rows) < 14


def test_a_watcher_from_before_a_restart_starts_over():
    live = LiveBuffer(("x",))
    live.append(block(0, 3))
    answer = live.since(500, 100)
    assert (numbers(answer), answer.restarted) == ([0, 1, 2], True)
