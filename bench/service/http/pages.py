"""Lists come in pages, all of them in the same way."""

from collections.abc import Sequence
from typing import Annotated, TypedDict, TypeVar

from fastapi import Query
from pydantic import BaseModel, Field

T = TypeVar("T")
Limit = Annotated[int, Query(ge=1, le=1000, description="most items in one answer")]
Offset = Annotated[int, Query(ge=0, le=2**31, description="items to pass over; `next_offset` of the page before")]


class Page(BaseModel):
    """One page of a list. A subclass has the `items`."""

    limit: int = Field(examples=[100])
    offset: int = Field(examples=[0])
    next_offset: int | None = Field(description="offset of the next page; null on the last", examples=[None])


class PageFields(TypedDict):
    """The fields of `Page`."""

    limit: int
    offset: int
    next_offset: int | None


def cut(found: Sequence[T], limit: int, offset: int) -> tuple[Sequence[T], PageFields]:
    """The items of a page, and the fields of `Page`.

    Args:
        found: what was asked for with `limit + 1`: one more tells that there is a next page.
        limit: most items.
        offset: of the first.
    """
    more = offset + limit if len(found) > limit else None
    return found[:limit], {"limit": limit, "offset": offset, "next_offset": more}
