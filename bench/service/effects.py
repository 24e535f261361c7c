"""/effects: the catalogue of physical effects that a model can be made of."""

from typing import Any

from fastapi import APIRouter, Depends
from pydantic import BaseModel, Field

from bench.service.access import allow_read
from bench.service.json_numbers import plain

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


class Catalogue(BaseModel):
    """All effects."""

    items: list[Effect]


@router.get("", summary="All effects of the catalogue")
def catalogue() -> Catalogue:
    """Physics, equation, parameters, what excites each effect and what it is confused with."""
    from bench.study import effects_catalogue  # the lab is imported when it is first needed: `serve` starts at once

    found: list[dict[str, Any]] = plain(effects_catalogue())
    return Catalogue(items=[Effect.model_validate(one) for one in found])
