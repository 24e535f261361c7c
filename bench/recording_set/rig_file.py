"""The rig file (`rig.toml`)."""

from pathlib import Path

from bench.recording_set.errors import RecordingSetError
from bench.recording_set.toml_file import parse_toml
from bench.rig import Rig


def read_rig(path: Path) -> Rig:
    """Read a rig file.

    Raises:
        RecordingSetError: not there, no TOML, an unknown key or an impossible value; names file, line and key.
    """
    try:
        return parse_toml(path.read_bytes(), Rig, path.name)
    except OSError as error:
        raise RecordingSetError(str(path), f"cannot be read: {error.strerror}; name a rig file") from error
