"""A recording set in memory."""

from dataclasses import dataclass

from bench.config.rig import Rig
from compensator.lab.recordings.recording import Recording


@dataclass(frozen=True)
class RecordingSet:
    """Trials of one rig.

    Attributes:
        name: of the folder or zip, without its ending.
        rig: the joint as its owner knows it.
        recordings: each with a name of its own.
    """

    name: str
    rig: Rig
    recordings: list[Recording]
