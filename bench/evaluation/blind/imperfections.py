"""Faults of the line, applied to a recording: lost rows and time stamps that jitter. The plant itself has the delay."""

from collections.abc import Sequence

import numpy as np

from compensator.lab.recordings.recording import Recording

LOST = (0.002, 0.02)  # share of the rows
JITTER = (0.02, 0.2)  # standard deviation, share of the period
DELAY_S = (5e-4, 3e-3)


def worn(recordings: Sequence[Recording], random: np.random.Generator) -> list[Recording]:
    """The recordings with rows lost and time stamps jittered, by amounts drawn once for all of them."""
    lost, jitter = float(random.uniform(*LOST)), float(random.uniform(*JITTER))
    return [_worn(recording, lost, jitter, random) for recording in recordings]


def _worn(recording: Recording, lost: float, jitter: float, random: np.random.Generator) -> Recording:
    time_s = recording.channels["time_s"]
    period_s = float(np.median(np.diff(time_s)))
    stamps = time_s + jitter * period_s * np.clip(random.standard_normal(len(time_s)), -2.0, 2.0)
    kept = random.random(len(time_s)) >= lost
    channels = {name: values[kept] for name, values in (recording.channels | {"time_s": stamps}).items()}
    return Recording(recording.name, recording.kind, recording.conditions, channels, recording.events)
