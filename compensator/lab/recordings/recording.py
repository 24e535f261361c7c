"""One trial as the lab sees it: channels over time, the conditions they were taken under, and events."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from compensator.lab.recordings.channels import CHANNELS

FloatArray = NDArray[np.float64]
Condition = float | str | bool


class Event(NamedTuple):
    """Something that happened during a trial."""

    time_s: float
    name: str
    detail: str = ""


@dataclass(frozen=True)
class Recording:
    """One trial under constant conditions.

    Attributes:
        name: unique within its set; the CSV's name without its ending.
        kind: what was done ("steps", "sin_sin", ...); free text.
        conditions: what was held constant; the keys carry units (load_kg, arm_m, temperature_c).
        channels: channel name -> samples, all of shape (n,); `time_s` is always there and rises.
        events: in order of time.
    """

    name: str
    kind: str
    conditions: dict[str, Condition]
    channels: dict[str, FloatArray]
    events: list[Event] = field(default_factory=list)

    def __post_init__(self) -> None:
        time_s = self.channels.get("time_s")
        if time_s is None:
            raise ValueError(f"recording '{self.name}': channel time_s is missing")
        for name, values in self.channels.items():
            if name not in CHANNELS:
                raise ValueError(f"recording '{self.name}': unknown channel '{name}'")
            if values.shape != time_s.shape:
                raise ValueError(f"recording '{self.name}': {name} has shape {values.shape}, time_s has {time_s.shape}")

    def __len__(self) -> int:
        return len(self.channels["time_s"])
