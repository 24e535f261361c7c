"""The live stream of a service as arrays."""

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bench.client.connection import Connection
from bench.client.errors import Unreachable
from compensator.lab.recordings.recording import FloatArray

PAUSE_S = 0.5
MOST_SILENT_TRIES = 20  # in a row; then the service is gone


@dataclass(frozen=True, slots=True)
class LiveRows:
    """Rows that came.

    Attributes:
        channels: name -> values, SI, NaN where nothing was measured.
        trial_id: the trial that they are of; None where that is not known.
        restarted: rows before these belong to another trial, or are missing.
        gap: what is missing before these, in words; "" where nothing is.
    """

    channels: dict[str, FloatArray]
    trial_id: int | None
    restarted: bool
    gap: str = ""


def live_rows(connection: Connection) -> Iterator[LiveRows]:
    """Rows as they come. A connection that breaks is made again, and what was missed comes first.

    Raises:
        Unreachable: the service stays away.
        Refused: the token is missing or wrong.
    """
    last_id, silent = "", 0
    while True:
        try:
            headers = {"Last-Event-ID": last_id} if last_id else {}
            with connection.stream("/live", headers) as lines:
                for event, number, rows in _events(lines):
                    silent = 0
                    last_id = number or last_id
                    if event == "rows" and rows is not None:
                        yield rows
        except Unreachable:
            if silent >= MOST_SILENT_TRIES:
                raise
        silent += 1
        time.sleep(PAUSE_S)


def _events(lines: Iterator[str]) -> Iterator[tuple[str, str, LiveRows | None]]:
    event = number = gap = ""
    for line in lines:
        key, _, value = line.partition(": ")
        if key == "event":
            event, number = value, ""
        elif key == "id":
            number = value
        elif key == "data":
            rows = None
            if event == "gap":
                gap = str(json.loads(value)["detail"])
            elif event == "rows":
                rows, gap = _rows(value, gap), ""
            yield event, number, rows


def _rows(text: str, gap: str) -> LiveRows:
    found = json.loads(text)
    table = np.array(found["rows"], dtype=np.float64).reshape(-1, len(found["channels"]))
    channels = {name: table[:, column] for column, name in enumerate(found["channels"])}
    return LiveRows(channels, found["trial_id"], found["restarted"], gap)
