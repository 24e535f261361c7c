"""Units of one kind beside each other: what is common to them, how they scatter, which is an outlier."""

from pydantic import Field

from bench.json_types import Number
from bench.study.models.base import EffortName, StudyModel


class Unit(StudyModel):
    """One unit: the study of its trials."""

    study_id: int
    name: str
    trials: int
    error: Number = Field(description="of the model on its training trials, relative (0..1)")


class UnitValue(StudyModel):
    """One parameter of one unit; intervals hold with 95 %."""

    study_id: int
    name: str
    value: Number
    low: Number
    high: Number
    deviation: Number = Field(description="from the mean of the other units")
    deviation_low: Number
    deviation_high: Number
    expected_low: Number = Field(description="where the other units, and its own error, let its value be expected")
    expected_high: Number
    p_value: Number = Field(description="of a unit like the others; corrected for all units and parameters")
    outlier: bool


class UnitParameter(StudyModel):
    """One parameter of all units; mean and scatter are of those that are no outliers. Intervals hold with 95 %."""

    effect: str
    name: str
    unit: str
    mean: Number
    mean_low: Number
    mean_high: Number
    scatter: Number = Field(description="standard deviation between units, without their errors")
    scatter_low: Number
    scatter_high: Number
    next_low: Number = Field(description="where one more unit of the kind is expected, measured as these are")
    next_high: Number
    p_value: Number = Field(description="of units that are all the same; corrected for all parameters")
    differs: bool = Field(description="whether units are shown to differ")
    values: list[UnitValue] = Field(description="of the units whose trials determine it")


class UnitDifference(StudyModel):
    """One parameter of two units, of which nobody can know how such units scatter."""

    effect: str
    name: str
    unit: str
    first: Number
    second: Number
    difference: Number = Field(description="of the second from the first")
    low: Number = Field(description="of its 90 % interval")
    high: Number


class UnitComparison(StudyModel):
    """Units of one kind, fitted with the same model."""

    effects: list[str]
    effort: EffortName
    cutoff_hz: float = Field(description="low-pass of all, the lowest of their studies [Hz]")
    units: list[Unit]
    parameters: list[UnitParameter]
    differences: list[UnitDifference] = Field(
        default_factory=list, description="of two units, in the place of `parameters`", examples=[[]]
    )
    undetermined: list[str] = Field(
        description="parameters that the trials of fewer than three units determine; of two, of fewer than both"
    )
    sentence: str
    notes: list[str]
