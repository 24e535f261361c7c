"""Recording sets into the store, and experiments out of it."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from pydantic import ValidationError

from bench.config.rig import Rig
from bench.config.validation import problems
from bench.provenance import software
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.parquet import parquet_chunks
from bench.recording_set.recording_set import RecordingSet
from bench.recording_set.stream import RecordingStream, stream_of_trial
from bench.recording_set.write import write_streams
from bench.store import Store, Trial
from bench.store.records import OUTCOMES
from compensator.lab.recordings.recording import Recording

IMPORT_KIND = "import"
FEWEST_ROWS = 2  # fewer make no recording


def import_recording_set(
    store: Store, recording_set: RecordingSet, name: str, further: Mapping[str, str] | None = None
) -> int:
    """Add a recording set to the store as one experiment: all of it, or nothing.

    Args:
        store: where it goes.
        recording_set: checked already, since it could be read.
        name: under which its user will look for it.
        further: what else is kept among the experiment's parameters.

    Returns:
        The experiment's id.
    """
    parameters = {"name": name, "recording_set": recording_set.name, **(further or {})}
    rig = recording_set.rig.model_dump(mode="json", exclude_none=True)
    recordings = (_with_outcome(recording) for recording in recording_set.recordings)
    return store.add_imported(IMPORT_KIND, parameters, {"software": software()}, rig, recordings)


def export_experiment(store: Store, experiment_id: int, path: Path) -> None:
    """Write an experiment as a recording set: a folder, or a zip where the name ends in .zip.

    A trial that did not complete carries its outcome and reason as tags. Trials of fewer than two rows,
    such as refused ones, are no recordings and are left out.

    Raises:
        NotFoundError: no such experiment.
        RecordingSetError: it has no trial with rows, or the place cannot be written.
    """
    experiment = store.experiment(experiment_id)
    where = f"experiment {experiment_id}"
    try:
        rig = Rig.model_validate(experiment.rig)
    except ValidationError as error:
        raise RecordingSetError(where, "its rig cannot be written: " + "; ".join(problems(error))) from error
    trials = _trials(store, experiment_id)
    write_streams(rig, map(partial(_stream, store), trials), path)


def export_parquet(store: Store, experiment_id: int) -> Iterator[bytes]:
    """The trials of an experiment as the bytes of one Parquet file; which trials, see `export_experiment`.

    Raises:
        NotFoundError, RecordingSetError: as there, and where pyarrow is not installed; before the first byte.
    """
    store.experiment(experiment_id)
    return parquet_chunks([_stream(store, trial) for trial in _trials(store, experiment_id)])


def _trials(store: Store, experiment_id: int) -> list[Trial]:
    found = [trial for trial in store.trials(experiment_id) if trial.rows >= FEWEST_ROWS]
    if not found:
        where = f"experiment {experiment_id}"
        raise RecordingSetError(where, f"has no trial of at least {FEWEST_ROWS} rows; there is nothing to write")
    return found


def _stream(store: Store, trial: Trial) -> RecordingStream:
    stream = stream_of_trial(store, trial)
    if trial.outcome == "completed":
        return stream
    return replace(stream, conditions={**stream.conditions, "outcome": trial.outcome, "reason": trial.reason})


def _with_outcome(recording: Recording) -> tuple[Recording, str, str]:
    """A recording, and the outcome and reason that an export put among its conditions."""
    conditions = dict(recording.conditions)
    outcome = conditions.get("outcome")
    if outcome not in OUTCOMES or outcome in ("running", "completed"):
        return recording, "completed", ""
    reason = str(conditions.pop("reason", ""))
    del conditions["outcome"]
    bare = Recording(recording.name, recording.kind, conditions, recording.channels, recording.events)
    return bare, str(outcome), reason
