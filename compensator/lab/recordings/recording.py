"""One trial as the lab sees it: channels over time, the conditions they were taken under, and events.

The channels that it may have are one table of names, units and meanings. The unit is part of the name and is SI (angles
in rad, temperature in deg C).
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]
Condition = float | str | bool


@dataclass(frozen=True, slots=True)
class Channel:
    """One column of a recording: its name, its unit, and what it means."""

    name: str
    unit: str
    meaning: str


CHANNELS: dict[str, Channel] = {
    channel.name: channel
    for channel in (
        Channel("time_s", "s", "time since the start of the trial"),
        Channel("target_rad", "rad", "position set point, joint side"),
        Channel("target_m", "m", "position set point of a linear joint"),
        Channel("position_rad", "rad", "motor-side position / gear ratio; 0 is vertically down"),
        Channel("position_m", "m", "position of a linear joint"),
        Channel("velocity_rad_s", "rad/s", "motor-side speed / gear ratio"),
        Channel("velocity_m_s", "m/s", "speed of a linear joint"),
        Channel("duty", "1", "signed PWM duty applied, -1 .. 1"),
        Channel("current_a", "A", "motor current measured by the drive"),
        Channel("current_estimate_a", "A", "motor current from duty and speed, paper, eq. (3)"),
        Channel("current_command_a", "A", "motor current asked for"),
        Channel("current_load_a", "A", "friction-compensated current, what the master is given"),
        Channel("current_load_half_width_a", "A", "half of the 95 % interval of the friction-compensated current"),
        Channel("voltage_v", "V", "voltage at the motor terminals"),
        Channel("supply_v", "V", "supply voltage"),
        Channel("temperature_c", "degC", "temperature that the drive reports"),
        Channel("torque_n_m", "N m", "joint torque of the motor"),
        Channel("force_n", "N", "motor force of a linear joint"),
        Channel("load_torque_n_m", "N m", "what a torque sensor measures between gear and load: the load on the joint"),
        Channel("enabled", "1", "power stage on (1) or off (0)"),
        Channel("age_s", "s", "age of the sample when it was received"),
        # of a pair: the others are the slave's
        Channel("master_position_rad", "rad", "the master's motor-side position / gear ratio"),
        Channel("master_velocity_rad_s", "rad/s", "the master's motor-side speed / gear ratio"),
        Channel("master_duty", "1", "signed PWM duty applied to the master, -1 .. 1"),
        Channel("master_current_a", "A", "the master's motor current measured by its drive"),
        Channel("master_current_estimate_a", "A", "the master's motor current from duty and speed, paper, eq. (3)"),
        Channel("master_current_command_a", "A", "the master's motor current asked for"),
        Channel("master_supply_v", "V", "the master's supply voltage"),
        Channel("master_temperature_c", "degC", "temperature that the master's drive reports"),
        Channel("master_enabled", "1", "the master's power stage on (1) or off (0)"),
        Channel("master_age_s", "s", "age of the master's sample when it was received"),
        Channel("reflected_n_m", "N m", "load of the slave that is reflected to the operator"),
        Channel(
            "interaction_n_m", "N m", "what truly holds up load and arm and presses on a wall; simulated pairs only"
        ),
        Channel("hand_n_m", "N m", "what the operator's hand truly does to the master; simulated pairs only"),
    )
}
EVENT_COLUMN = "event"
SESSION_START = "session_s"  # condition: time from the start of the session to that of the trial [s]


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
