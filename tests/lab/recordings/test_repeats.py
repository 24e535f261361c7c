"""Repeats are told by a condition; whether they move alike is looked at."""

import numpy as np
import pytest

from compensator.lab.recordings.recording import Recording
from compensator.lab.recordings.repeats import likeness, repeats, unlike_repeats

TIME_S = np.arange(0.0, 10.0, 0.01)
SLOW, MIXED = np.sin(0.8 * TIME_S), 0.7 * np.sin(2.5 * TIME_S + 1.0)


def trial(name: str, position: np.ndarray, channel: str = "position_rad", **conditions: float | str) -> Recording:
    return Recording(name, "recording", conditions, {"time_s": TIME_S[: len(position)] + 5.0, channel: position})


def test_trials_that_tell_no_repeat_are_none() -> None:
    assert repeats([trial("a", SLOW, load_kg=0.4), trial("b", SLOW, load_kg=0.4)]) == []


def test_repeats_are_alike_in_all_but_their_time() -> None:
    told = [
        trial("a", SLOW, load_kg=0.4, repeat=1.0, session_s=0.0),
        trial("b", SLOW, load_kg=0.8, repeat=1.0),
        trial("c", SLOW, load_kg=0.4, repeat=2.0, session_s=60.0),
        trial("d", SLOW, load_kg=0.4, repeat=1.0, waveform="mixed"),
    ]
    assert repeats(told) == [[0, 2]]


def test_repeats_that_move_otherwise_are_named_once_a_group() -> None:
    again = SLOW[:-50] + 1e-3 * np.cos(30.0 * TIME_S[:-50])
    told = [trial(name, way, repeat=1.0) for name, way in (("a", SLOW), ("b", MIXED), ("c", again))]
    [(one, other, found)] = unlike_repeats(told)
    assert "b" in (one.name, other.name)
    assert abs(found) < 0.5
    assert list(unlike_repeats([told[0], told[2]])) == []


@pytest.mark.parametrize(
    ("one", "other", "found"),
    [
        (trial("a", SLOW), trial("b", SLOW), 1.0),
        (trial("a", 0.0 * SLOW), trial("b", SLOW), None),  # one stands: nothing is said
        (trial("a", SLOW), trial("b", SLOW, "position_m"), None),
        (trial("a", np.where(TIME_S < 2.0, np.nan, SLOW)), trial("b", SLOW), 1.0),
        (trial("a", np.full(len(TIME_S), np.nan)), trial("b", SLOW), None),
    ],
)
def test_how_alike_two_motions_are(one: Recording, other: Recording, found: float | None) -> None:
    assert likeness(one, other) == (None if found is None else pytest.approx(found, abs=1e-3))
