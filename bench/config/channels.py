"""The channels that a trial records: the one table that rows, store, export, interface and limits take them from.

A new channel is one line here, and a field of what is named under `read` where nothing measures it yet. Trials keep
the names of their own channels: those recorded before a line was added stay as they are.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from compensator.lab.recordings.recording import CHANNELS as LAB_CHANNELS


@dataclass(frozen=True, slots=True)
class Channel:
    """One column of the recorded rows.

    Attributes:
        name: ends in the unit; the column's name in store, export and interface.
        unit: SI, angles in rad, temperatures in degC; "1" where there is none.
        read: what of a control cycle it is, a path among `bench.control.cycle.VALUES`; of a pair, among
            `bench.control.pairs.pair.PAIR_VALUES`.
        plotted: whether a plot of the trial shows it unless asked otherwise.
        exported: whether a recording set, a CSV or a Parquet file holds it. The model lab has to know it, then.
    """

    name: str
    unit: str
    label: str
    description: str
    read: str
    plotted: bool = False
    exported: bool = True


JOINT_CHANNELS = (
    Channel("time_s", "s", "time", "time since the start of the trial", "reading.time_s"),
    Channel("target_rad", "rad", "target", "position set point, joint side", "action.target_rad", plotted=True),
    Channel(
        "position_rad",
        "rad",
        "position",
        "motor-side position / gear ratio; 0 is vertically down",
        "sample.position_rad",
        plotted=True,
    ),
    Channel(
        "velocity_rad_s", "rad/s", "speed", "motor-side speed / gear ratio", "reading.velocity_rad_s", plotted=True
    ),
    Channel("duty", "1", "duty", "signed PWM duty applied, -1 .. 1", "sample.duty", plotted=True),
    Channel("current_a", "A", "motor current", "motor current measured by the drive", "sample.current_a", plotted=True),
    Channel(
        "current_estimate_a",
        "A",
        "current from duty",
        "motor current from duty and speed, paper, eq. (3)",
        "reading.current_estimate_a",
        plotted=True,
    ),
    Channel("current_command_a", "A", "current asked for", "motor current asked for", "command.current_a"),
    Channel(
        "current_load_a",
        "A",
        "load current",
        "friction-compensated current, what the master is given",
        "action.current_load_a",
        plotted=True,
    ),
    Channel(
        "current_load_half_width_a",
        "A",
        "half width of the load current",
        "half of the 95 % interval of the friction-compensated current",
        "action.current_load_half_width_a",
    ),
    Channel("supply_v", "V", "supply", "supply voltage", "sample.supply_v"),
    Channel("temperature_c", "degC", "temperature", "temperature that the drive reports", "sample.temperature_c"),
    Channel("enabled", "1", "power", "power stage on (1) or off (0)", "sample.enabled"),
    Channel("age_s", "s", "age of the sample", "age of the sample when it was received", "sample.age_s"),
)
"""Of one joint, in the order of the columns; of a pair, the slave's."""

MASTER_CHANNELS = (
    Channel(
        "master_position_rad",
        "rad",
        "master's position",
        "the master's motor-side position / gear ratio",
        "master.sample.position_rad",
    ),
    Channel(
        "master_velocity_rad_s",
        "rad/s",
        "master's speed",
        "the master's motor-side speed / gear ratio",
        "master.reading.velocity_rad_s",
    ),
    Channel(
        "master_duty", "1", "master's duty", "signed PWM duty applied to the master, -1 .. 1", "master.sample.duty"
    ),
    Channel(
        "master_current_a",
        "A",
        "master's motor current",
        "the master's motor current measured by its drive",
        "master.sample.current_a",
    ),
    Channel(
        "master_current_estimate_a",
        "A",
        "master's current from duty",
        "the master's motor current from duty and speed, paper, eq. (3)",
        "master.reading.current_estimate_a",
    ),
    Channel(
        "master_current_command_a",
        "A",
        "master's current asked for",
        "the master's motor current asked for",
        "master.command.current_a",
    ),
    Channel("master_supply_v", "V", "master's supply", "the master's supply voltage", "master.sample.supply_v"),
    Channel(
        "master_temperature_c",
        "degC",
        "master's temperature",
        "temperature that the master's drive reports",
        "master.sample.temperature_c",
    ),
    Channel(
        "master_enabled", "1", "master's power", "the master's power stage on (1) or off (0)", "master.sample.enabled"
    ),
    Channel(
        "master_age_s",
        "s",
        "age of the master's sample",
        "age of the master's sample when it was received",
        "master.sample.age_s",
    ),
)
PAIR_CHANNELS = (
    *JOINT_CHANNELS,
    *MASTER_CHANNELS,
    Channel(
        "reflected_n_m",
        "N m",
        "reflected load",
        "load of the slave that is reflected to the operator",
        "pair.reflected_n_m",
    ),
    Channel(
        "interaction_n_m",
        "N m",
        "true load",
        "what truly holds up load and arm and presses on a wall; simulated pairs only",
        "pair.interaction_n_m",
    ),
    Channel(
        "hand_n_m",
        "N m",
        "true torque of the hand",
        "what the operator's hand truly does to the master; simulated pairs only",
        "pair.hand_n_m",
    ),
)
"""Of a master and a slave: the slave's channels, the master's, what passes between them, and what truly acts."""

CHANNELS: dict[str, Channel] = {channel.name: channel for channel in PAIR_CHANNELS}
RECORDED = tuple(channel.name for channel in JOINT_CHANNELS)
PAIR_RECORDED = tuple(channel.name for channel in PAIR_CHANNELS)
KEPT = tuple(dict.fromkeys((*LAB_CHANNELS, *CHANNELS)))
"""Names that a trial in the store may have: imported recordings hold what the bench never measures, too."""


def known_to_lab(names: Iterable[str]) -> list[str]:
    """Those that the model lab can use."""
    return [name for name in names if name in LAB_CHANNELS]


def exported(names: Iterable[str]) -> tuple[str, ...]:
    """Those that a recording set holds."""
    return tuple(name for name in names if name not in CHANNELS or CHANNELS[name].exported)
