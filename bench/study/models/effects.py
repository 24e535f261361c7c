"""The effects of the catalogue, and an example of each."""

from pydantic import Field

from bench.json_types import Numbers
from bench.study.models.base import StudyModel


class EffectParameter(StudyModel):
    """One parameter of an effect, with the bounds of its fit."""

    name: str
    unit: str
    low: float | None = Field(description="lower bound; null where there is none")
    high: float | None = Field(description="upper bound; null where there is none")


class Effect(StudyModel):
    """One physical mechanism that a model can contain."""

    name: str = Field(examples=["coulomb_asymmetry"])
    title: str = Field(examples=["Direction-asymmetric Coulomb friction"])
    physics: str = Field(description="one paragraph")
    equation: str
    parameters: list[EffectParameter]
    driver: str = Field(description="the variable that drives it; its picture is drawn against this")
    channels: list[str] = Field(description="channels that a recording must have")
    excited_by: str = Field(description="what a trial must do for the effect to show")
    confused_with: list[str] = Field(description="effects that look alike where the trials are poor")
    source: str


class LeftOutEffect(StudyModel):
    """An effect that an installed package offers, and that is not in the catalogue."""

    package: str = Field(description="that offers it, with its version", examples=["my-package 1.0"])
    entry_point: str = Field(description="as the package names it", examples=["hose = my_package.hose:EFFECT"])
    reason: str = Field(description="in words", examples=["ImportError: no module named 'hose'"])


class ExampleTrial(StudyModel):
    """One swing of the simulated joint; all lists have the same length."""

    load_kg: float
    time_s: list[float]
    driver: Numbers
    without: list[float] = Field(description="effort without the effect")
    effect: list[float] = Field(description="what the effect adds; add any multiple of it")


class Example(StudyModel):
    """What an effect adds to the effort of a simulated joint that is moved with two loads."""

    effect: str
    motion: str = Field(description="what the joint does, in a sentence")
    effort_unit: str
    driver: str = Field(description="the variable that drives the effect")
    driver_unit: str
    trials: list[ExampleTrial]
