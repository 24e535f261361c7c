"""What recordings hold, before anything is fitted: directions, speeds, loads, temperatures, repeats."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.driven import driven_from_outside
from compensator.lab.recordings.recording import FloatArray, Recording
from compensator.lab.recordings.regimes import Regime
from compensator.lab.recordings.repeats import repeats
from compensator.lab.rows.dataset import Dataset, Trial

ONE_WAY = 0.05  # share of the rows in the rarer direction, below which there is one direction


@dataclass(frozen=True)
class Coverage:
    """What the trials of a dataset hold.

    Attributes:
        trials: how many.
        duration_s: of all of them.
        forward, backward: share of the sliding rows in each direction, 0..1.
        reversing: trials in which the joint slides both ways.
        slow, fast: speeds that 5 % and 95 % of the sliding rows stay below, in units of position a second.
        low, high: range of position.
        one_way: the most that a trial goes one way without coming back, in units of position.
        loads_kg: the different loads, rising; empty where none is told.
        temperature_c: lowest and highest; None where it is not measured in every trial.
        without_temperature: names of the trials in which it is not.
        repeats: trials of which another has the same kind and conditions.
        driven_s: time in which something else turns the joint.
        usable: share of the samples that can be used, 0..1.
    """

    trials: int
    duration_s: float
    forward: float
    backward: float
    reversing: int
    slow: float
    fast: float
    low: float
    high: float
    one_way: float
    loads_kg: tuple[float, ...]
    temperature_c: tuple[float, float] | None
    without_temperature: tuple[str, ...]
    repeats: int
    driven_s: float
    usable: float

    @property
    def both_directions(self) -> bool:
        """Whether the joint slides both ways, in one trial or in several."""
        return min(self.forward, self.backward) >= ONE_WAY


def coverage_of(dataset: Dataset) -> Coverage:
    """What the trials of a dataset hold."""
    sliding = dataset.regime == Regime.SLIDING
    velocity = dataset.rows_of([trial.motion.velocity for trial in dataset.trials])
    position = dataset.rows_of([trial.motion.position for trial in dataset.trials])
    moving = velocity[sliding]
    forward = float(np.mean(moving > 0.0)) if len(moving) else 0.0
    ways = [velocity[own][sliding[own]] for own in dataset.trial_rows]
    slow, fast = np.quantile(np.abs(moving), (0.05, 0.95)).tolist() if len(moving) else (0.0, 0.0)
    warmth = dataset.rows_of([trial.motion.temperature_c for trial in dataset.trials])
    recordings = [trial.signals.recording for trial in dataset.trials]
    return Coverage(
        trials=len(dataset.trials),
        duration_s=sum(float(trial.motion.time_s[-1]) for trial in dataset.trials),
        forward=forward,
        backward=1.0 - forward if len(moving) else 0.0,
        reversing=sum(bool(min(np.mean(way > 0.0), np.mean(way < 0.0)) >= ONE_WAY) for way in ways if len(way)),
        slow=slow,
        fast=fast,
        low=float(position.min(initial=np.inf)),
        high=float(position.max(initial=-np.inf)),
        one_way=max(_one_way(trial.motion.position) for trial in dataset.trials),
        loads_kg=_loads_kg(recordings),
        temperature_c=(float(warmth.min()), float(warmth.max())) if len(warmth) and np.isfinite(warmth).all() else None,
        without_temperature=tuple(
            trial.signals.recording.name
            for trial in dataset.trials
            if not np.isfinite(trial.motion.temperature_c).any()
        ),
        repeats=sum(map(len, repeats(recordings))),
        driven_s=sum(_driven_s(trial) for trial in dataset.trials),
        usable=float(np.mean(np.concatenate([trial.signals.usable for trial in dataset.trials]))),
    )


def _one_way(position: FloatArray) -> float:
    """The longest way in one direction, ways back of less than a tenth of it forgiven."""
    return max(float(np.max(one - np.minimum.accumulate(one))) for one in (position, -position))


def _loads_kg(recordings: list[Recording]) -> tuple[float, ...]:
    told = (one.conditions.get("load_kg") for one in recordings)
    return tuple(sorted({float(load) for load in told if isinstance(load, int | float)}))


def _driven_s(trial: Trial) -> float:
    signals = trial.signals
    driven = driven_from_outside(signals.time_s, signals.position, signals.effort)
    return float(np.count_nonzero(driven)) / signals.rate_hz
