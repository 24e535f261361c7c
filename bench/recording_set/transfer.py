"""Recording sets into the store, and experiments out of it."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from bench.config.rig import Rig
from bench.config.validation import problems
from bench.provenance import software
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.parquet import parquet_chunks
from bench.recording_set.recording_set import RecordingSet
from bench.recording_set.stream import PIECE_ROWS, RecordingStream, stream_of_trial
from bench.recording_set.write import write_streams
from bench.store import Store, Trial
from bench.store.records import OUTCOMES, Experiment
from compensator.lab.recordings.recording import Condition, Recording

IMPORT_KIND = "import"
FEWEST_ROWS = 2  # fewer make no recording
CONTROL_LOOP = "recorded_by_control_loop"
"""Parameter of an imported experiment whose rows a control loop of this bench recorded."""
BY_CONTROL_LOOP = {"recorded_by": "control loop"}
"""Condition by which an exported trial says so."""
TYPED = ("time_s", "target_rad", "target_m")
OWN_SOURCES = ("simulated", "real")
OUTCOME, REASON = "outcome", "reason"


def import_recording_set(
    store: Store, recording_set: RecordingSet, name: str, further: Mapping[str, str] | None = None
) -> int:
    """Add a recording set to the store as one experiment: all of it, or nothing.

    Returns:
        The experiment's id.
    """
    parameters = {"name": name, "recording_set": recording_set.name, **(further or {})}
    if all(BY_CONTROL_LOOP.items() <= recording.conditions.items() for recording in recording_set.recordings):
        parameters[CONTROL_LOOP] = "yes"
    rig = recording_set.rig.model_dump(mode="json", exclude_none=True)
    recordings = (_with_outcome(recording) for recording in recording_set.recordings)
    return store.add_imported(IMPORT_KIND, parameters, {"software": software()}, rig, recordings)


def imported_before(store: Store, recording_set: RecordingSet) -> list[str]:
    """Note of the newest imported experiment that has the recordings of a set already, however they were mapped.

    The store keeps no hash of a file: names and rows are compared, and what was measured in their first rows.
    """
    for experiment in store.experiments(IMPORT_KIND):
        there = {trial.name: trial for trial in store.trials(experiment.id)}
        if all(
            (trial := there.get(one.name)) is not None and trial.rows == len(one) and _is_same(store, trial, one)
            for one in recording_set.recordings
        ):
            return [
                f"experiment {experiment.id} has the same recordings already; they come in once more. A study of both "
                "counts them twice"
            ]
    return []


def _is_same(store: Store, trial: Trial, recording: Recording) -> bool:
    """Whether a channel that is measured has the same numbers, bit for bit; times and set points may be typed twice."""
    rows = min(trial.rows, PIECE_ROWS)
    pairs = (
        (values, recording.channels[name][:rows])
        for name, values in zip(trial.channels, store.part(trial, 0, rows), strict=True)
        if name in recording.channels and name not in TYPED
    )
    return any(np.array_equal(*pair, equal_nan=True) and len(np.unique(pair[0])) > 1 for pair in pairs)


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
    write_streams(rig, map(partial(_stream, store, experiment), trials), path)


def is_by_control_loop(experiment: Experiment) -> bool:
    """Whether a control loop of this bench recorded an experiment, here or where it was exported."""
    return experiment.source in OWN_SOURCES or CONTROL_LOOP in experiment.parameters


def export_parquet(store: Store, experiment_id: int) -> Iterator[bytes]:
    """The trials of an experiment as the bytes of one Parquet file; which trials, see `export_experiment`.

    Raises:
        NotFoundError, RecordingSetError: as there, and where pyarrow is not installed; before the first byte.
    """
    experiment = store.experiment(experiment_id)
    return parquet_chunks([_stream(store, experiment, trial) for trial in _trials(store, experiment_id)])


def _trials(store: Store, experiment_id: int) -> list[Trial]:
    found = [trial for trial in store.trials(experiment_id) if trial.rows >= FEWEST_ROWS]
    if not found:
        where = f"experiment {experiment_id}"
        raise RecordingSetError(where, f"has no trial of at least {FEWEST_ROWS} rows; there is nothing to write")
    return found


def _stream(store: Store, experiment: Experiment, trial: Trial) -> RecordingStream:
    stream = stream_of_trial(store, trial)
    told: dict[str, Condition] = {} if trial.outcome == "completed" else {OUTCOME: trial.outcome, REASON: trial.reason}
    if is_by_control_loop(experiment):
        told |= BY_CONTROL_LOOP
    return replace(stream, conditions={**stream.conditions, **told})


def _with_outcome(recording: Recording) -> tuple[Recording, str, str]:
    """A recording, and the outcome and reason that an export put among its conditions."""
    conditions = {key: value for key, value in recording.conditions.items() if BY_CONTROL_LOOP.get(key) != value}
    outcome, reason = conditions.get(OUTCOME), ""
    if outcome in OUTCOMES and outcome not in ("running", "completed"):
        reason = str(conditions.pop(REASON, ""))
        del conditions[OUTCOME]
    else:
        outcome = "completed"
    bare = Recording(recording.name, recording.kind, conditions, recording.channels, recording.events)
    return bare, str(outcome), reason
