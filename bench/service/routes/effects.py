"""/effects: the catalogue of physical effects that a model can be made of."""

from typing import TYPE_CHECKING, Annotated

from fastapi import Depends, Path, Request
from pydantic import Field

from bench.service.auth.access import allow_read
from bench.service.compute import in_worker
from bench.service.http.api_router import api_router
from bench.service.http.pages import Limit, Offset, Page, cut
from bench.service.http.problems import problems
from bench.study.models.effects import Effect, Example, LeftOutEffect

if TYPE_CHECKING:
    import bench.study.effects
else:
    from bench.service.later import bench

router = api_router("/effects", tags=["effects"], dependencies=[Depends(allow_read)])


class Catalogue(Page):
    """One page of effects."""

    items: list[Effect]
    left_out: list[LeftOutEffect] = Field(
        default=[], description="effects of other packages that are broken, and why; on every page"
    )


@router.get("", summary="The effects of the catalogue", responses=problems(422))
def catalogue(limit: Limit = 100, offset: Offset = 0) -> Catalogue:
    """Physics, equation, parameters, what excites each effect and what it is confused with."""
    items, page = cut(bench.study.effects.effects_catalogue()[offset : offset + limit + 1], limit, offset)
    return Catalogue(items=list(items), left_out=bench.study.effects.effects_left_out(), **page)


@router.get("/{name}/example", summary="A small simulated example", responses=problems(404, 422))
async def example(request: Request, name: Annotated[str, Path(max_length=100, examples=["backlash"])]) -> Example:
    """To be looked at: a joint that is moved with two loads, without the effect, and what the effect adds."""
    return await in_worker(request, bench.study.effects.effect_example, name)
