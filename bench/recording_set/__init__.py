"""Recording sets: the one format in which trials enter and leave."""

from bench.recording_set.errors import RecordingSetError
from bench.recording_set.mapping import Mapping, read_mapping
from bench.recording_set.read import read_recording_set
from bench.recording_set.recording_set import RecordingSet
from bench.recording_set.rig_file import read_rig
from bench.recording_set.transfer import export_experiment, import_recording_set
from bench.recording_set.write import csv_chunks, write_recording_set

__all__ = [
    "Mapping",
    "RecordingSet",
    "RecordingSetError",
    "csv_chunks",
    "export_experiment",
    "import_recording_set",
    "read_mapping",
    "read_recording_set",
    "read_rig",
    "write_recording_set",
]
