"""/audit: who did what."""

from datetime import datetime
from typing import Annotated

from fastapi import Depends, Query
from pydantic import BaseModel, Field

from bench.service.auth.access import require_admin
from bench.service.http.api_router import api_router
from bench.service.http.pages import Limit, Offset, Page, cut
from bench.service.http.problems import problems
from bench.service.services import StoreOf

router = api_router("/audit", tags=["audit"], dependencies=[Depends(require_admin)])


class Deed(BaseModel):
    """A request that changed something, or was refused to."""

    at_utc: datetime
    token: str = Field(description="name of the token; empty where none was accepted", examples=["ada"])
    role: str = Field(description="viewer, operator or admin; empty likewise", examples=["operator"])
    client: str = Field(description="network address; empty for the command line", examples=["127.0.0.1"])
    method: str = Field(examples=["POST"])
    path: str = Field(examples=["/api/v1/experiments"])
    status: int = Field(description="what was answered", examples=[201])
    detail: str = Field(description="what was changed", examples=["started experiment 12 (steps)"])


class Deeds(Page):
    """One page of the audit log, newest first."""

    items: list[Deed]


@router.get("", summary="Who did what", responses=problems(401, 403, 422))
def audit(
    store: StoreOf,
    token: Annotated[str, Query(max_length=100, description="name of a token; without it, all")] = "",
    limit: Limit = 100,
    offset: Offset = 0,
) -> Deeds:
    """Newest first; for admins. A deed appears within a second."""
    found = store.access.audit.find(token or None, limit + 1, offset)
    items, page = cut(found, limit, offset)
    return Deeds(items=[Deed.model_validate(one, from_attributes=True) for one in items], **page)
