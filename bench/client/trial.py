"""One recording under constant conditions, as arrays."""

import csv
import io
from collections.abc import Mapping

import numpy as np

from bench.client.answer import Answer
from bench.client.connection import Connection
from compensator.lab.recordings.recording import FloatArray


class Trial:
    """What `Bench.trial` returns.

    Attributes:
        facts: name, kind, conditions, outcome, results ... as GET /trials/{id} answers.
    """

    def __init__(self, connection: Connection, facts: Mapping[str, object]) -> None:
        self._connection = connection
        self.facts = Answer(facts)

    @property
    def trial_id(self) -> int:
        """Its number."""
        return int(self.facts["trial_id"])

    @property
    def conditions(self) -> Answer:
        """What was held constant, units in the names."""
        return Answer(self.facts["conditions"])

    @property
    def results(self) -> Answer:
        """What the procedure found."""
        return Answer(self.facts["results"])

    def channels(self, *names: str, points: int | None = None) -> dict[str, FloatArray]:
        """Samples by channel: SI, the unit in the name, shape (rows,), NaN where nothing was measured.

        Args:
            *names: channels; without any, all that were recorded.
            points: about how many rows, for a plot: recorded rows with the extremes of each channel; None: every row,
                exact to the last bit.

        Raises:
            Refused, KeyError: no such channel.
        """
        if points is not None:
            path = f"/trials/{self.trial_id}/samples"
            found = self._connection.get(path, channels=",".join(names) or None, points=points)["channels"]
            return {name: np.array(values, dtype=np.float64) for name, values in found.items()}
        # those too that no recording set holds: a channel may be recorded before the model lab knows it
        whole = _columns(self._connection.text(f"/trials/{self.trial_id}/csv", every_channel=True))
        recorded = {name: whole[name] for name in self.facts["channels"]}
        return {name: recorded[name] for name in _known(names, recorded)} if names else recorded

    def __repr__(self) -> str:
        facts = self.facts
        held = ", ".join(f"{name}={value}" for name, value in facts["conditions"].items())
        return f"<Trial {self.trial_id} {facts['name']} ({held}): {facts['rows']} rows, {facts['outcome']}>"

    def _repr_html_(self) -> str:
        return self.facts._repr_html_()


def _columns(text: str) -> dict[str, FloatArray]:
    """Numeric columns of a table; empty cells are NaN."""
    header, *rows = csv.reader(io.StringIO(text, newline=""))
    columns = dict(zip(header, zip(*rows, strict=True) if rows else [()] * len(header), strict=True))
    columns.pop("event", None)
    return {name: np.array([cell or "nan" for cell in cells], dtype=np.float64) for name, cells in columns.items()}


def _known(names: tuple[str, ...], recorded: dict[str, FloatArray]) -> tuple[str, ...]:
    missing = [name for name in names if name not in recorded]
    if missing:
        raise KeyError(f"no channel {', '.join(missing)}; recorded are {', '.join(recorded)}")
    return names
