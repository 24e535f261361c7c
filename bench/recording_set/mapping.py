"""The mapping file: how files of another shape become recordings (`mapping.toml`).

delimiter = ";"               # between columns; told by the file where left out, and so are decimal and encoding
decimal = ","
ignore = "rest"               # or a list of columns that are not wanted
rate_hz = 1000.0              # where no column holds the time
stamps = "sort"               # times that repeat or run backwards are refused where left out
counts_per_turn = 4096        # of the joint, for columns in counts

[columns.force_n]             # channel = scale x column + offset
from = "drive_v"
scale = 35.15065

[columns.position_rad]        # or with the unit of the column
from = "angle"
unit = "deg"
period = 360                  # it wraps, and is unwrapped; in the unit of the column

[columns.current_a]           # a magnitude, with the sign of another column
from = "current"
sign_from = "duty"

[columns.time_s]              # one channel of two columns: their sum
from = ["seconds", "nanoseconds"]
scale = [1, 1e-9]

[constants]                   # channels that nobody recorded
supply_v = 24.0

[conditions.load_kg]          # a condition of each trial, of a column that keeps one value throughout it
from = "payload"
unit = "g"

[trials_columns]              # columns of trials.csv that have another name there
kind = "trajectory"           # stays a condition too
load_kg = { from = "load_g", scale = 0.001 }

[[trials]]                    # where there is no trials.csv
file = "reference.csv"
kind = "reference"
conditions = { repeat = 1 }
"""

import math
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, ConfigDict, Field, model_validator

from bench.config.rig import Section
from bench.recording_set.conditions import KNOWN, OTHER_UNITS, RESERVED, TEXTS
from bench.recording_set.text.encoding import is_text
from bench.recording_set.text.toml_file import read_model
from bench.recording_set.units import TURN, UNITS, Unit, unit_named, units_of
from compensator.lab.recordings.recording import CHANNELS, EVENT_COLUMN, Condition

Finite = Annotated[float, Field(allow_inf_nan=False)]
STAMP = "stamp"
"""Unit of a column of date and time, ISO 8601 or as spreadsheets write it."""
SPEED_UNITS = {"velocity_rad_s": "rad", "velocity_m_s": "m"}


def _is_factor(scale: float) -> float:
    if scale == 0:
        raise ValueError("wanted a number other than 0")
    return scale


def _is_known(channel: str) -> str:
    if channel not in CHANNELS and channel != EVENT_COLUMN:
        raise ValueError(f"wanted one of {', '.join([*CHANNELS, EVENT_COLUMN])}")
    return channel


def _is_condition(value: Any) -> Condition:
    if isinstance(value, (bool, str)):
        return value
    if isinstance(value, (int, float)) and math.isfinite(value):
        return float(value)
    raise ValueError("wanted a finite number, text, true or false")


def _is_named(name: str) -> str:
    if name in OTHER_UNITS:
        known, _ = OTHER_UNITS[name]
        raise ValueError(f'wanted {known}, with unit = "{name.rpartition("_")[2]}" of the column')
    if name in RESERVED or name != name.strip() or not name.isprintable() or not name:
        raise ValueError(f"a condition cannot be called so; known are {', '.join(KNOWN)}, and any name of your own")
    return name


def _is_unit(unit: str) -> str:
    if unit != STAMP and unit_named(unit) is None:
        names = dict.fromkeys([STAMP, *(known.name for known in UNITS.values())])
        raise ValueError(f"wanted a unit such as {', '.join(names)}")
    return unit


Factor = Annotated[Finite, AfterValidator(_is_factor)]


class Renamed(Section):
    """A column of trials.csv: scale x column + offset."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    source: str = Field(alias="from", min_length=1, description="Name of the column in the file")
    scale: Factor = Field(1.0, description="Factor to SI, not 0")
    offset: Finite = Field(0.0, description="Added after the factor, SI")


class ConditionColumn(Renamed):
    """A column that says what was held constant, one value in each trial: scale x column + offset."""

    unit: Annotated[str, AfterValidator(_is_unit)] | None = Field(
        None, description="Unit of the column: kg, g, lb, oz of load_kg; m, mm, cm of arm_m; s, ms, min of session_s"
    )

    def to_si(self) -> tuple[float, float]:
        """Factor and offset, that of the unit in them."""
        unit = (None if self.unit is None else unit_named(self.unit)) or Unit("", "")
        return self.scale * unit.factor, self.offset + unit.offset


class Column(Section):
    """Where a channel comes from: scale x column + offset."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    source: str | list[str] = Field(
        alias="from", min_length=1, description="Name of the column in the file; of several, their sum is taken"
    )
    scale: Factor | list[Factor] = Field(1.0, description="Factor to SI, not 0; one for each column of several")
    offset: Finite = Field(0.0, description="Added after the factor, SI")
    unit: Annotated[str, AfterValidator(_is_unit)] | None = Field(
        None, description="Unit of the column, such as deg, rpm, counts, mA; `stamp`: date and time. SI where left out"
    )
    period: float | None = Field(
        None, gt=0, allow_inf_nan=False, description="The column wraps after so much, in its own unit: it is unwrapped"
    )

    sign_from: str | None = Field(
        None, min_length=1, description="Column whose sign it takes, where it is a magnitude; unknown where that is 0"
    )

    @property
    def sources(self) -> tuple[str, ...]:
        """Names of the columns."""
        return (self.source,) if isinstance(self.source, str) else tuple(self.source)

    @property
    def read(self) -> tuple[str, ...]:
        """Names of the columns, and of that of the sign."""
        return self.sources if self.sign_from is None else (*self.sources, self.sign_from)

    @property
    def is_stamp(self) -> bool:
        """Whether it is text: date and time."""
        return self.unit == STAMP

    def scales(self) -> list[float]:
        """The factor of each column, without that of the unit."""
        return [self.scale] * len(self.sources) if isinstance(self.scale, float) else list(self.scale)

    @model_validator(mode="after")
    def _one_scale_each(self) -> "Column":
        if isinstance(self.scale, list) and len(self.scale) != len(self.sources):
            raise ValueError(
                f"scale has {len(self.scale)} numbers for {len(self.sources)} columns; wanted one number, or one each"
            )
        return self


class MappedTrial(Section):
    """One trial of a set without trials.csv."""

    file: str = Field(description="File of the trial")
    kind: str = Field("recording", description="Kind of trial")
    conditions: dict[str, Annotated[Any, AfterValidator(_is_condition)]] = Field(
        default_factory=dict, description="What was held constant: numbers in SI, text, true or false"
    )


Stamps = Literal["rise", "sort", "spread"]


class Mapping(Section):
    """How files of another shape become recordings."""

    delimiter: str | None = Field(
        None, min_length=1, max_length=1, description="Sign between columns; ' ' for any blanks. Told by the file"
    )
    decimal: str | None = Field(
        None, pattern=r"^[.,]$", description="Decimal sign: a point or a comma. Told by the file"
    )
    encoding: Annotated[str, AfterValidator(is_text)] | None = Field(
        None, description="Encoding of text files, such as cp1252. Told by the file"
    )
    ignore: list[str] | Literal["rest"] = Field(
        default_factory=list, description='Columns that are not wanted; "rest": all that are not mapped'
    )
    rate_hz: float | None = Field(
        None, gt=0, allow_inf_nan=False, description="Samples a second, without a time column"
    )
    stamps: Stamps = Field(
        "rise",
        description="Times: `rise` refuses those that repeat or run backwards; `sort` puts lines in order and keeps "
        "the first of each time; `spread` lays lines of one coarse time evenly over the step to the next",
    )
    counts_per_turn: float | None = Field(
        None, gt=0, allow_inf_nan=False, description="Counts per turn of the joint, for columns in counts"
    )
    columns: dict[Annotated[str, AfterValidator(_is_known)], Column] = Field(
        default_factory=dict, description="Channel of a trial, and the column that it comes from"
    )
    constants: dict[Annotated[str, AfterValidator(_is_known)], Finite] = Field(
        default_factory=dict, description="Channels that have one value throughout, SI"
    )
    position_from_speed: bool = Field(
        False, description="Position is the integral of the speed; where each trial begins is not known then"
    )
    conditions: dict[Annotated[str, AfterValidator(_is_named)], ConditionColumn] = Field(
        default_factory=dict,
        description="Condition of a trial, and the column of its file that holds it; the column keeps one value "
        f"throughout the trial. Known are {', '.join(f'`{name}`' for name in KNOWN)}; others may be named",
    )
    trials_columns: dict[str, str | Renamed] = Field(
        default_factory=dict, description="Column of trials.csv, and the one that it comes from there"
    )
    trials: list[MappedTrial] = Field(default_factory=list, description="The trials, where there is no trials.csv")

    @model_validator(mode="after")
    def _signs_differ(self) -> "Mapping":
        if self.delimiter is not None and self.delimiter == self.decimal:
            raise ValueError(f"delimiter and decimal are both '{self.decimal}'; wanted two different signs")
        return self

    @model_validator(mode="after")
    def _units_fit(self) -> "Mapping":
        for channel, column in self.columns.items():
            unit = None if column.unit is None or column.is_stamp else unit_named(column.unit)
            if column.is_stamp and channel != "time_s":
                raise ValueError(f"columns.{channel}: the unit '{STAMP}' is one of time_s alone")
            if unit is None:
                continue
            if unit.si != CHANNELS[channel].unit:
                wanted = ", ".join(units_of(CHANNELS[channel].unit))
                raise ValueError(f"columns.{channel}: the unit is '{column.unit}'; wanted one of {wanted}")
            if unit.counts and self.counts_per_turn is None:
                raise ValueError(f"columns.{channel} is in counts; add counts_per_turn, counts per turn of the joint")
        return self

    @model_validator(mode="after")
    def _units_of_conditions_fit(self) -> "Mapping":
        for name, column in self.conditions.items():
            if name in TEXTS and (column.scale != 1.0 or column.offset):
                raise ValueError(f"conditions.{name} is text; leave scale and offset out")
            if column.unit is None:
                continue
            if not (si := KNOWN.get(name)):
                raise ValueError(f"conditions.{name} has no unit; leave it out, or say a scale")
            unit = None if column.unit == STAMP else unit_named(column.unit)
            if unit is None or unit.si != si:
                wanted = ", ".join(units_of(si))
                raise ValueError(f"conditions.{name}: the unit is '{column.unit}'; wanted one of {wanted}")
        return self

    def factors(self, column: Column) -> tuple[list[float], float]:
        """The factor of each of a column's sources, and the offset, all to SI."""
        unit = Unit("", "") if column.unit is None or column.is_stamp else unit_named(column.unit) or Unit("", "")
        count = TURN / self.counts_per_turn if unit.counts and self.counts_per_turn else 1.0
        return [scale * unit.factor * count for scale in column.scales()], unit.offset + column.offset

    def ignores(self, name: str) -> bool:
        """Whether a column that is not mapped is not wanted."""
        return self.ignore == "rest" or name in self.ignore

    def trials_column(self, name: str) -> Renamed | None:
        """Where a column of trials.csv comes from, if it has another name there."""
        column = self.trials_columns.get(name)
        return Renamed(source=column) if isinstance(column, str) else column


def read_mapping(path: Path) -> Mapping:
    """Read a mapping file.

    Raises:
        RecordingSetError: not there, no TOML, an unknown channel or key; names file, line and key.
    """
    return read_model(path, Mapping)
