"""Rows of a trial whose blocks are lost: they stay in their place, empty, so that the others keep theirs."""

from collections.abc import Iterator

import numpy as np
from sqlalchemy import Connection, delete, insert, select, update

from bench.store.schema import SAMPLE_BLOCK, SAMPLE_OVERVIEW, TRIAL
from bench.store.tables.samples import decode, encode
from compensator.lab.recordings.recording import FloatArray


def fill_gaps(connection: Connection) -> Iterator[str]:
    """Fill the lost rows of each trial with NaN, cut off a lost end, and mark the trial as interrupted.

    Times are spread evenly between their neighbours, as they have to rise. An overview is left out: without one, plots
    read all rows.

    Yields:
        What is lost, in words.
    """
    for trial_id, rows, channels in connection.execute(select(TRIAL.c.id, TRIAL.c.rows, TRIAL.c.channels)).all():
        lost = list(_fill(connection, trial_id, rows, channels))
        if lost:
            words = f"rows {', '.join(lost)} of {rows} are lost, and empty or cut off since a repair of the store"
            changed = update(TRIAL).where(TRIAL.c.id == trial_id).values(outcome="interrupted", reason=words)
            connection.execute(changed)
            connection.execute(delete(SAMPLE_OVERVIEW).where(SAMPLE_OVERVIEW.c.trial_id == trial_id))
            yield f"trial {trial_id}: {words}"


def _fill(connection: Connection, trial_id: int, rows: int, channels: list[str]) -> Iterator[str]:
    table = SAMPLE_BLOCK.c
    query = select(table.first_row, table.rows).where(table.trial_id == trial_id).order_by(table.first_row)
    covered = 0
    for first, count in connection.execute(query).all():
        if first > covered:
            yield f"{covered} .. {first - 1}"
            between = _empty(connection, trial_id, (covered, first), channels)
            values = {"trial_id": trial_id, "first_row": covered, "rows": first - covered, "data": encode(between)}
            connection.execute(insert(SAMPLE_BLOCK).values(**values))
        covered = max(covered, first + count)
    if covered != rows:
        yield f"{covered} .. {rows - 1}"
        connection.execute(update(TRIAL).where(TRIAL.c.id == trial_id).values(rows=covered))


def _empty(connection: Connection, trial_id: int, gap: tuple[int, int], channels: list[str]) -> FloatArray:
    """Columns for the rows of a gap, shape (channels, rows): times between those of its neighbours, all else NaN."""
    count, time = gap[1] - gap[0], channels.index("time_s")
    found = np.full((len(channels), count), np.nan)
    after = _times(connection, trial_id, gap[1], time)
    before = _times(connection, trial_id, gap[0], time, ends_there=True)
    if len(before):
        found[time] = np.linspace(before[-1], after[0], count + 2)[1:-1]
    else:  # the beginning: by the period of what follows
        period_s = after[1] - after[0] if len(after) > 1 else 0.0
        found[time] = after[0] - period_s * np.arange(count, 0, -1)
    return found


def _times(connection: Connection, trial_id: int, row: int, time: int, ends_there: bool = False) -> FloatArray:
    """Times of the block that begins at a row, or ends before it; none where there is no such block."""
    table = SAMPLE_BLOCK.c
    place = table.first_row + table.rows if ends_there else table.first_row
    query = select(table.data, table.rows).where(table.trial_id == trial_id, place == row)
    found = connection.execute(query).first()
    if found is None:
        return np.empty(0)
    times: FloatArray = decode(found.data, len(found.data) // (8 * found.rows))[time]
    return times
