"""Removing an experiment with all that belongs to it, in transactions of bounded size.

It is marked first: from then on nobody sees it, and whoever opens the store next goes on where this ended.
"""

from sqlalchemy import delete, select, update

from bench.store.database import Database
from bench.store.records import REMOVING
from bench.store.schema import EXPERIMENT, SAMPLE_BLOCK, TRIAL

BLOCKS_AT_ONCE = 64


def remove(database: Database, experiment_id: int) -> None:
    """Remove an experiment, its trials and their samples. Nothing happens where it is gone."""
    with database.writing() as connection:
        mark = update(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id).values(outcome=REMOVING, owner=None)
        connection.execute(mark)
        connection.execute(update(TRIAL).where(TRIAL.c.experiment_id == experiment_id).values(outcome=REMOVING))
    with database.reading() as connection:
        trials = connection.execute(select(TRIAL.c.id).where(TRIAL.c.experiment_id == experiment_id)).scalars().all()
    for trial_id in trials:
        while _remove_blocks(database, trial_id):
            pass
        with database.writing() as connection:
            connection.execute(delete(TRIAL).where(TRIAL.c.id == trial_id))  # conditions, events, overview with it
    with database.writing() as connection:
        connection.execute(delete(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id))


def _remove_blocks(database: Database, trial_id: int) -> int:
    table = SAMPLE_BLOCK.c
    with database.writing() as connection:
        query = select(table.first_row).where(table.trial_id == trial_id).order_by(table.first_row)
        rows = connection.execute(query.limit(BLOCKS_AT_ONCE)).scalars().all()
        if rows:
            connection.execute(delete(SAMPLE_BLOCK).where(table.trial_id == trial_id, table.first_row <= rows[-1]))
    return len(rows)
