"""Live rows as they are answered."""

from pydantic import BaseModel, Field

from bench.runs.live import LiveRows
from bench.service.http.written_samples import column


class Rows(BaseModel):
    """Rows since `after_row`. A quantity that was not measured is null."""

    channels: list[str]
    rows: list[list[float | None]]
    last_row: int = Field(description="send it as `after_row` next time")
    restarted: bool = Field(description="True where rows before these belong to something else or are gone")
    trial_id: int | None = Field(description="of these rows; null where that is not known")


def rows_of(found: LiveRows) -> Rows:
    """Rows for JSON."""
    return Rows(
        channels=list(found.channels),
        rows=[column(row) for row in found.rows],
        last_row=found.last_row,
        restarted=found.restarted,
        trial_id=found.trial_id,
    )
