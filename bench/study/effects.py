"""The catalogue of effects, and a small simulated example of each."""

import numpy as np
from pydantic import Field

from bench.json_types import Numbers
from bench.store.errors import NotFoundError
from bench.study.models.base import StudyModel
from compensator.lab.effects import effect as lab
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.errors import UnknownEffectError
from compensator.lab.example import example_of


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


def effects_catalogue() -> list[Effect]:
    """Every effect with its physics, equation, parameters, what excites it and what it is confused with."""
    return [_effect(effect) for effect in catalogue().values()]


def effect_example(name: str) -> Example:
    """What an effect adds to the effort of a simulated joint, for the page.

    Raises:
        NotFoundError: there is no such effect.
    """
    try:
        found = example_of(name)
    except UnknownEffectError as error:
        raise NotFoundError(str(error)) from error
    return Example(
        effect=name,
        motion=found.motion,
        effort_unit=found.effort_unit,
        driver=found.driver_title,
        driver_unit=found.driver_unit,
        trials=[
            ExampleTrial(
                load_kg=trial.load_kg,
                time_s=trial.time_s.tolist(),
                driver=trial.driver.tolist(),
                without=trial.without.tolist(),
                effect=trial.effect.tolist(),
            )
            for trial in found.trials
        ],
    )


def _effect(effect: lab.Effect) -> Effect:
    return Effect(
        name=effect.name,
        title=effect.title,
        physics=effect.physics,
        equation=effect.equation,
        parameters=[
            EffectParameter(
                name=parameter.name,
                unit=parameter.unit_in("effort", "position"),
                low=parameter.low if np.isfinite(parameter.low) else None,
                high=parameter.high if np.isfinite(parameter.high) else None,
            )
            for parameter in effect.parameters
        ],
        driver=effect.driver,
        channels=list(effect.channels),
        excited_by=effect.excited_by,
        confused_with=list(effect.confused_with),
        source=effect.source,
    )
