"""The mapping file: how files of another shape become recordings (`mapping.toml`).

delimiter = ";"               # between columns; "," where left out
decimal = ","                 # "." where left out
ignore = ["pulse_v"]          # columns that are not wanted

[columns.force_n]             # channel = scale x column + offset
from = "drive_v"
scale = 35.15065

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
from typing import Annotated, Any

from pydantic import AfterValidator, ConfigDict, Field, model_validator

from bench.config.rig import Section
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.text.toml_file import parse_toml
from compensator.lab.recordings.channels import CHANNELS, EVENT_COLUMN
from compensator.lab.recordings.recording import Condition

Finite = Annotated[float, Field(allow_inf_nan=False)]


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


class Column(Section):
    """Where a quantity comes from: scale x column + offset."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    source: str = Field(alias="from", min_length=1, description="Name of the column in the file")
    scale: Annotated[Finite, AfterValidator(_is_factor)] = Field(1.0, description="Factor to SI, not 0")
    offset: Finite = Field(0.0, description="Added after the factor, SI")


class MappedTrial(Section):
    """One trial of a set without trials.csv."""

    file: str = Field(description="CSV file of the trial")
    kind: str = Field("recording", description="Kind of trial")
    conditions: dict[str, Annotated[Any, AfterValidator(_is_condition)]] = Field(
        default_factory=dict, description="What was held constant: numbers in SI, text, true or false"
    )


class Mapping(Section):
    """How files of another shape become recordings."""

    delimiter: str = Field(",", min_length=1, max_length=1, description="Sign between columns")
    decimal: str = Field(".", pattern=r"^[.,]$", description="Decimal sign: a point or a comma")
    ignore: list[str] = Field(default_factory=list, description="Columns that are not wanted")
    columns: dict[Annotated[str, AfterValidator(_is_known)], Column] = Field(
        default_factory=dict, description="Channel of a trial, and the column that it comes from"
    )
    trials_columns: dict[str, str | Column] = Field(
        default_factory=dict, description="Column of trials.csv, and the one that it comes from there"
    )
    trials: list[MappedTrial] = Field(default_factory=list, description="The trials, where there is no trials.csv")

    @model_validator(mode="after")
    def _signs_differ(self) -> "Mapping":
        if self.delimiter == self.decimal:
            raise ValueError(f"delimiter and decimal are both '{self.decimal}'; wanted two different signs")
        return self

    def trials_column(self, name: str) -> Column | None:
        """Where a column of trials.csv comes from, if it has another name there."""
        column = self.trials_columns.get(name)
        return Column(source=column) if isinstance(column, str) else column


def read_mapping(path: Path) -> Mapping:
    """Read a mapping file.

    Raises:
        RecordingSetError: not there, no TOML, an unknown channel or key; names file, line and key.
    """
    try:
        return parse_toml(path.read_bytes(), Mapping, path.name)
    except OSError as error:
        raise RecordingSetError(str(path), f"cannot be read: {error.strerror}; name a mapping file") from error
