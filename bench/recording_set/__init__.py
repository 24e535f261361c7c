"""Recording sets: the one format in which trials enter and leave."""

from bench.recording_set.errors import RecordingSetError
from bench.recording_set.mapping import Mapping, read_mapping
from bench.recording_set.parquet import parquet_chunks
from bench.recording_set.read import read_recording_set
from bench.recording_set.recording_set import RecordingSet, read_rig
from bench.recording_set.ros2_bag import read_ros2_bags
from bench.recording_set.stream import RecordingStream, stream_of, stream_of_trial
from bench.recording_set.text.csv_text import csv_chunks
from bench.recording_set.transfer import export_experiment, export_parquet, import_recording_set, imported_before
from bench.recording_set.write import write_recording_set

__all__ = [
    "Mapping",
    "RecordingSet",
    "RecordingSetError",
    "RecordingStream",
    "csv_chunks",
    "export_experiment",
    "export_parquet",
    "import_recording_set",
    "imported_before",
    "parquet_chunks",
    "read_mapping",
    "read_recording_set",
    "read_rig",
    "read_ros2_bags",
    "stream_of",
    "stream_of_trial",
    "write_recording_set",
]
