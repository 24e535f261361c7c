"""A recording set in memory."""

from dataclasses import dataclass
from pathlib import Path

from bench.config.rig import Rig
from bench.recording_set.text.toml_file import read_model
from compensator.lab.recordings.recording import Recording


@dataclass(frozen=True)
class RecordingSet:
    """Trials of one rig.

    Attributes:
        name: of the folder or zip, without its ending.
        rig: the joint as its owner knows it.
        recordings: each with a name of its own.
        notes: how its files were read, where that is not as the format has it; in words.
    """

    name: str
    rig: Rig
    recordings: list[Recording]
    notes: tuple[str, ...] = ()


def read_rig(path: Path) -> Rig:
    """Read a rig file.

    Raises:
        RecordingSetError: not there, no TOML, an unknown key or an impossible value; names file, line and key.
    """
    return read_model(path, Rig)
