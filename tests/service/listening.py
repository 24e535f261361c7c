"""A listener of the live stream."""

import json
from collections.abc import Iterator

import httpx

from tests.service.plain_http import NOBODY
from tests.service.running_service import RunningService


def listen(url: str, last_event_id: str | None = None) -> Iterator[tuple[str, str, dict]]:
    """(event, id, data), as they come."""
    headers = {} if last_event_id is None else {"Last-Event-ID": last_event_id}
    with httpx.stream("GET", f"{url}/api/v1/live", headers=headers, timeout=20, verify=NOBODY) as stream:
        name = number = ""
        for line in stream.iter_lines():
            key, _, value = line.partition(": ")
            name, number = (value if key == "event" else name), (value if key == "id" else number)
            if key == "data":
                yield name, number, json.loads(value)


def times(events) -> list[float]:
    return [row[0] for name, _, data in events if name == "rows" for row in data["rows"]]


def until(events, enough) -> list:
    found = []
    for event in events:
        found.append(event)
        if enough(found):
            return found
    return found


def rows_of(events) -> list[tuple[int, float]]:
    """(trial, time) of each row."""
    return [(data["trial_id"], row[0]) for name, _, data in events if name == "rows" for row in data["rows"]]


def left_at(events) -> str:
    return [number for name, number, _ in events if name == "rows"][-1]


def recorded(service: RunningService, experiment_id: int) -> list[tuple[int, float]]:
    trials = service.store.trials(experiment_id)
    return [(trial.id, time_s) for trial in trials for time_s in service.store.samples(trial.id)["time_s"].tolist()]


def of_run(service: RunningService, experiment_id: int, events) -> list[tuple[int, float]]:
    """Rows of one experiment: a listener who comes before its first block hears those of the run before it."""
    trials = {trial.id for trial in service.store.trials(experiment_id)}
    return [row for row in rows_of(events) if row[0] in trials]


def hear(service: RunningService, experiment_id: int, rows: int, last_event_id: str | None = None) -> list:
    """Events until more than a number of rows of an experiment have come."""
    events = listen(service.url, last_event_id)
    return until(events, lambda found: len(of_run(service, experiment_id, found)) > rows)
