"""What a bench recorded is handed in to the laboratory's database: nothing is lost and nothing comes twice.

The bench's own store is where its rows are safe first, whether the network is there or not. An experiment that has
ended is copied, block by block, into one that nobody sees; where the copy breaks off, the next goes on behind the last
block that the laboratory has. The last transaction shows it and says that it is complete, both or neither: a link that
is cut while it commits leaves no doubt that asking again does not settle.
"""

from collections.abc import Generator
from contextlib import closing
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import Connection, RowMapping, Table, func, insert, select, update

from bench.store.database import Database
from bench.store.records import HIDDEN, IMPORTING
from bench.store.schema import EVENT, EXPERIMENT, EXPERIMENT_TAG, HANDED_IN, SAMPLE_BLOCK, SAMPLE_OVERVIEW, TRIAL
from bench.store.schema import TRIAL_CONDITION as CONDITION
from bench.store.tables import chain
from bench.store.tables.experiments import insert_row
from bench.store.upkeep.importing import parts

TRANSACTION_BYTES = 4 * 2**20  # what a link that is cut has to send again, at most
FETCHED = 16
Row = dict[str, object]


@dataclass(frozen=True, slots=True)
class _Origin:
    """An experiment of the bench, and what it is called in the laboratory."""

    row: RowMapping
    trials: list[RowMapping]


class HandIn:
    """From one bench to the laboratory."""

    def __init__(self, bench: Database, lab: Database, name: str) -> None:
        self._bench, self._lab, self._name = bench, lab, name
        # asked for once: a laboratory of a thousand benches would do little else than list what it has
        self._there: set[tuple[int, datetime]] | None = None

    def waiting(self) -> list[int]:
        """Experiments that have ended and are not in the laboratory yet, oldest first.

        Raises:
            StoreError: either database cannot be read.
        """
        own = EXPERIMENT.c
        ended = select(own.id, own.started_utc).where(own.outcome.not_in(("running", *HIDDEN))).order_by(own.id)
        with self._bench.reading() as connection:
            found = [(row.id, row.started_utc) for row in connection.execute(ended)]
        there = self._known()
        return [number for number, started_utc in found if (number, started_utc) not in there]

    def _known(self) -> set[tuple[int, datetime]]:
        if self._there is None:
            mine = HANDED_IN.c
            query = select(mine.origin_id, mine.started_utc).where(mine.bench == self._name, mine.complete)
            with self._lab.reading() as connection:
                self._there = {(row.origin_id, row.started_utc) for row in connection.execute(query)}
        return self._there

    def hand_in(self, experiment_id: int) -> int:
        """Copy one, or the rest of it. Does nothing where it is there. Returns its number in the laboratory.

        Raises:
            StoreError: either database does not answer; call again, later.
        """
        origin = self._read(experiment_id)
        with self._lab.writing() as connection:
            there, complete = self._begin(connection, origin)
        if not complete:
            trials = {trial["id"]: self._copy_trial(trial, there) for trial in origin.trials}
            with self._lab.writing(durable=True) as connection:
                if not self._begin(connection, origin)[1]:  # another process of this bench may have been faster
                    self._finish(connection, origin, there, trials)
        self._known().add((experiment_id, origin.row["started_utc"]))
        return there

    def _read(self, experiment_id: int) -> _Origin:
        with self._bench.reading() as connection:
            found = connection.execute(select(EXPERIMENT).where(EXPERIMENT.c.id == experiment_id)).mappings().one()
            of_it = select(TRIAL).where(TRIAL.c.experiment_id == experiment_id).order_by(TRIAL.c.id)
            return _Origin(found, list(connection.execute(of_it).mappings()))

    def _begin(self, connection: Connection, origin: _Origin) -> tuple[int, bool]:
        """Its number in the laboratory, and whether all of it is there."""
        own, key = HANDED_IN.c, {"bench": self._name, "origin_id": origin.row["id"]}
        key["started_utc"] = origin.row["started_utc"]
        query = select(own.experiment_id, own.complete).where(*(own[name] == value for name, value in key.items()))
        found = connection.execute(query).one_or_none()
        if found is not None:
            return found.experiment_id, found.complete
        hidden = {**_without_id(origin.row), "outcome": IMPORTING, "owner": None}
        there = insert_row(connection, EXPERIMENT, hidden)
        connection.execute(insert(HANDED_IN).values(**key, experiment_id=there, complete=False))
        return there, False

    def _copy_trial(self, trial: RowMapping, experiment_id: int) -> int:
        with self._lab.writing() as connection:
            known = (TRIAL.c.experiment_id == experiment_id) & (TRIAL.c.name == trial["name"])
            there = connection.execute(select(TRIAL.c.id).where(known)).scalar_one_or_none()
            if there is None:
                hidden = {**_without_id(trial), "experiment_id": experiment_id, "outcome": IMPORTING}
                there = insert_row(connection, TRIAL, hidden)
        for table in (SAMPLE_BLOCK, SAMPLE_OVERVIEW):
            last = select(func.max(table.c.first_row)).where(table.c.trial_id == there)
            with self._lab.reading() as connection:
                newest = connection.execute(last).scalar()
            with closing(self._parts(table, trial["id"], -1 if newest is None else newest)) as blocks:
                for part in blocks:
                    with self._lab.recording() as connection:
                        connection.execute(insert(table), [{**row, "trial_id": there} for row in part])
        return int(there)

    def _parts(self, table: Table, trial_id: int, after: int) -> Generator[list[Row], None, None]:
        """Blocks behind a row, so many at a time as one transaction takes."""
        query = select(table).where(table.c.trial_id == trial_id, table.c.first_row > after).order_by(table.c.first_row)
        with self._bench.reading() as connection:
            found = (row._asdict() for row in connection.execute(query, execution_options={"yield_per": FETCHED}))
            yield from parts(found, lambda row: len(row["data"]), TRANSACTION_BYTES)

    def _finish(self, connection: Connection, origin: _Origin, there: int, trials: dict[int, int]) -> None:
        """All that is small, and the ends; with this it is seen."""
        with self._bench.reading() as read:
            for table in (EVENT, CONDITION):
                order = table.primary_key.columns
                query = select(table).where(table.c.trial_id.in_(list(trials)))
                rows = list(read.execute(query.order_by(*order)).mappings())
                if rows:
                    own = [{**_without_id(row), "trial_id": trials[row["trial_id"]]} for row in rows]
                    connection.execute(insert(table), own)
            tags = read.execute(select(EXPERIMENT_TAG.c.tag).where(EXPERIMENT_TAG.c.experiment_id == origin.row["id"]))
            labels = [{"experiment_id": there, "tag": tag} for tag in tags.scalars()]
        if labels:
            connection.execute(insert(EXPERIMENT_TAG), labels)
        for trial in origin.trials:
            shown = update(TRIAL).where(TRIAL.c.id == trials[trial["id"]])
            connection.execute(shown.values(outcome=trial["outcome"], rows=trial["rows"]))
        connection.execute(update(EXPERIMENT).where(EXPERIMENT.c.id == there).values(outcome=origin.row["outcome"]))
        connection.execute(update(HANDED_IN).where(HANDED_IN.c.experiment_id == there).values(complete=True))
        chain.seal(connection, "trial", trials.values())
        chain.seal(connection, "experiment", [there])


def _without_id(row: RowMapping) -> Row:
    return {name: value for name, value in row.items() if name != "id"}
