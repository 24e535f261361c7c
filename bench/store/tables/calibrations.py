"""Calibrations in the store: friction curves, where they come from, and which of them is to be used."""

from collections.abc import Sequence
from typing import Any

from sqlalchemy import Connection, select, update

from bench.store.database import Database
from bench.store.records import CalibrationRow
from bench.store.schema import CALIBRATION
from bench.store.tables import chain
from bench.store.tables.experiments import insert_row, now, row_of


class Calibrations:
    """The calibrations of one store; `Store.calibrations`. Every method may be called from any thread."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def add(self, **values: Any) -> int:
        """Add one, of the fields of `CalibrationRow` other than id and times. Returns its id."""
        with self._database.writing() as connection:
            calibration_id = insert_row(connection, CALIBRATION, values | {"created_utc": now()})
            chain.seal(connection, "calibration", [calibration_id])
            return calibration_id

    def get(self, calibration_id: int) -> CalibrationRow:
        """One calibration, or `NotFoundError`."""
        with self._database.reading() as connection:
            return _get(connection, calibration_id)

    def find(self, limit: int | None = None, offset: int = 0) -> list[CalibrationRow]:
        """Newest first; all of them without a limit."""
        query = select(CALIBRATION).order_by(CALIBRATION.c.id.desc()).limit(limit).offset(offset)
        with self._database.reading() as connection:
            return [CalibrationRow(**row._asdict()) for row in connection.execute(query)]

    def choose(self, calibration_id: int) -> None:
        """Name one as the one to use, or `NotFoundError`."""
        with self._database.writing() as connection:
            _get(connection, calibration_id)
            connection.execute(update(CALIBRATION).where(CALIBRATION.c.id == calibration_id).values(chosen_utc=now()))
            chain.seal(connection, "calibration", [calibration_id])

    def unchoose(self, calibration_ids: Sequence[int]) -> None:
        """Forget that these were named."""
        with self._database.writing() as connection:
            chosen = CALIBRATION.c.id.in_(list(calibration_ids))
            connection.execute(update(CALIBRATION).where(chosen).values(chosen_utc=None))
            chain.seal(connection, "calibration", calibration_ids)


def _get(connection: Connection, calibration_id: int) -> CalibrationRow:
    query = select(CALIBRATION).where(CALIBRATION.c.id == calibration_id)
    return CalibrationRow(**row_of(connection, query, f"calibration {calibration_id}", "calibrations")._asdict())
