"""What the store keeps of a fitted model, as JSON, older versions less of it; what the bench is given of one."""

from math import nan

from pydantic import Field

from bench.json_types import Number
from bench.study.models.base import StudyModel
from bench.study.models.closed_loop import LoopError, PositionUnit
from bench.study.models.ladder import BreakawayRung, StepGain


class KeptMotion(StudyModel):
    """Errors of a model in closed loop; `held_out` is None where there are too few trials."""

    training: LoopError
    held_out: LoopError | None
    position_unit: PositionUnit


class KeptBench(StudyModel):
    """Errors of the reflected load with a model at work on the bench, and without compensation, rms."""

    experiment_id: int
    reflected_error_g: float
    uncompensated_error_g: float


class KeptModel(StudyModel):
    """A fit: relative errors (0..1), its shapes, its coefficients in their units, and how many trials there were."""

    training: Number = nan
    held_out: Number = nan
    held_out_low: Number = nan
    held_out_high: Number = nan
    held_out_kind: str = ""
    trials: int | None = None
    floor: float | None = None
    breakaway: BreakawayRung | None = None
    shapes: dict[str, tuple[float, ...]] = Field(default={})
    coefficients: dict[str, list[float]] = Field(default={})
    closed_loop: KeptMotion | None = None
    bench: KeptBench | None = None
    gain: StepGain | None = None


class Used(StudyModel):
    """The calibration that a model was kept as."""

    calibration_id: int
    study_id: int
    model_id: int
    effects: list[str] = Field(description="of the model, those at work")
    left_out: list[str] = Field(description="effects that need more than the motion of the moment")
    sentence: str
