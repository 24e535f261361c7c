"""The variables a residual may depend on: what it is plotted against, and what a missing effect varies with."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset, Trial


@dataclass(frozen=True, slots=True)
class Driver:
    """A driving variable.

    Attributes:
        name: identifier, as in `Effect.driver`.
        title: in words.
        unit: a template with `{effort}` and `{position}`.
        of: trial -> its values at the full rate, shape (n,).
    """

    name: str
    title: str
    unit: str
    of: Callable[[Trial], FloatArray]

    def unit_in(self, effort_unit: str, facts: Facts) -> str:
        """The unit, with the study's own effort and position units."""
        return self.unit.format(effort=effort_unit, position=facts.position_unit)


def _constant(condition: str) -> Callable[[Trial], FloatArray]:
    return lambda trial: np.full(len(trial.motion.time_s), trial.motion.condition(condition, 0.0))


def _since_reversal(trial: Trial) -> FloatArray:
    return trial.motion.strokes.travel


def _rest(trial: Trial) -> FloatArray:
    return trial.motion.last_rest[0]


def _start_rate(trial: Trial) -> FloatArray:
    return np.broadcast_to(trial.motion.start_rate, trial.motion.time_s.shape)


DRIVERS: dict[str, Driver] = {
    driver.name: driver
    for driver in (
        Driver("velocity", "velocity", "{position}/s", lambda t: t.motion.velocity),
        Driver("speed", "speed", "{position}/s", lambda t: np.abs(t.motion.velocity)),
        Driver("position", "position", "{position}", lambda t: t.motion.place),
        Driver("acceleration", "acceleration", "{position}/s2", lambda t: t.motion.acceleration),
        Driver("load", "predicted load", "{effort}", lambda t: t.motion.load_effort),
        Driver("load_kg", "load at the tip", "kg", _constant("load_kg")),
        Driver("temperature", "temperature", "degC", lambda t: t.motion.temperature_c),
        Driver("time", "time in the trial", "s", lambda t: t.motion.time_s),
        Driver("session_time", "time in the session", "s", lambda t: t.motion.session_s),
        Driver("direction", "direction of motion", "1", lambda t: t.motion.direction),
        Driver("effort_rate", "rate of the predicted effort", "{effort}/s", lambda t: t.motion.effort_rate),
        Driver("effort", "predicted effort", "{effort}", lambda t: t.motion.predicted),
        Driver("since_reversal", "travel since the last reversal", "{position}", _since_reversal),
        Driver("rest", "length of the last rest", "s", _rest),
        Driver("start_rate", "rate of the effort at the last start", "{effort}/s", _start_rate),
    )
}


def available(dataset: Dataset) -> dict[str, FloatArray]:
    """Values of every driver that is measured and varies over the rows, shape (N,) each.

    Where no trial tells when it began, there is no time in the session beside that in the trial.
    """
    found = {}
    for name, driver in DRIVERS.items():
        values = dataset.rows_of([driver.of(trial) for trial in dataset.trials])
        if np.isfinite(values).all() and np.ptp(values) > 1e-9 * (1.0 + np.abs(values).max()):
            found[name] = values
    if "session_time" in found and np.array_equal(found["session_time"], found.get("time", [])):
        del found["session_time"]
    return found
