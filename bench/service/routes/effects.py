"""/effects: the catalogue of physical effects that a model can be made of."""

from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Request
from pydantic import BaseModel, Field

from bench.service.auth.access import allow_read
from bench.service.compute import in_worker
from bench.service.http.json_numbers import plain
from bench.service.http.pages import Limit, Offset, Page, cut
from bench.service.http.problems import problems

router = APIRouter(prefix="/effects", tags=["effects"], dependencies=[Depends(allow_read)])


class EffectParameter(BaseModel):
    """One parameter of an effect, with the bounds of its fit."""

    name: str
    unit: str
    low: float | None = Field(description="lower bound; null where there is none")
    high: float | None = Field(description="upper bound; null where there is none")


class Effect(BaseModel):
    """One physical mechanism that a model can contain."""

    name: str = Field(examples=["coulomb_asymmetry"])
    title: str = Field(examples=["Direction-asymmetric Coulomb friction"])
    physics: str = Field(description="one paragraph")
    equation: str
    parameters: list[EffectParameter]
    driver: str = Field(description="the variable that drives it; its picture is drawn against this")
    channels: list[str] = Field(description="channels that a recording must have")
    excited_by: str | list[str] = Field(description="what a trial must do for the effect to show")
    confused_with: list[str] = Field(description="effects that look alike where the trials are poor")
    source: str


class Catalogue(Page):
    """One page of effects."""

    items: list[Effect]


class ExampleTrial(BaseModel):
    """One swing of the simulated joint; all lists have the same length."""

    load_kg: float
    time_s: list[float]
    driver: list[float | None]
    without: list[float] = Field(description="effort without the effect")
    effect: list[float] = Field(description="what the effect adds; add any multiple of it")


class Example(BaseModel):
    """What an effect adds to the effort of a simulated joint that is moved with two loads."""

    effect: str
    motion: str = Field(description="what the joint does, in a sentence")
    effort_unit: str
    driver: str = Field(description="the variable that drives the effect")
    driver_unit: str
    trials: list[ExampleTrial]


@router.get("", summary="The effects of the catalogue", responses=problems(422))
def catalogue(limit: Limit = 100, offset: Offset = 0) -> Catalogue:
    """Physics, equation, parameters, what excites each effect and what it is confused with."""
    from bench.study import effects_catalogue  # the lab is imported when it is first needed: `serve` starts at once

    found: list[dict[str, Any]] = plain(effects_catalogue()[offset : offset + limit + 1])
    items, page = cut(found, limit, offset)
    return Catalogue(items=[Effect.model_validate(one) for one in items], **page)


@router.get("/{name}/example", summary="A small simulated example", responses=problems(404, 422))
async def example(request: Request, name: Annotated[str, Path(max_length=100, examples=["backlash"])]) -> Example:
    """To be looked at: a joint that is moved with two loads, without the effect, and what the effect adds."""

    def call() -> Any:
        from bench.study import effect_example

        return plain(effect_example(name))

    return Example.model_validate(await in_worker(request, call))
