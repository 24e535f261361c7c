"""The part of the store that keeps studies and their models."""

from collections.abc import Sequence

from sqlalchemy import Connection, Table, delete, select, update

from bench.json_types import Values
from bench.store.database import Database
from bench.store.errors import NotFoundError, StoreStateError
from bench.store.records import ModelRow, StudyRow
from bench.store.schema import MODEL, STUDY
from bench.store.tables import chain
from bench.store.tables.experiments import insert_row, now, row_of


class StudyStore:
    """Studies and models; `Store` is one."""

    _database: Database

    def create_study(self, name: str, definition: Values) -> int:
        """Add a study. Returns its id."""
        with self._database.writing() as connection:
            return _add(connection, STUDY, {"name": name, "definition": definition})

    def change_study(self, study_id: int, definition: Values) -> None:
        """Replace the definition of a study, or `NotFoundError`."""
        with self._database.writing() as connection:
            _study(connection, study_id)
            _change(connection, STUDY, study_id, {"definition": definition})

    def study(self, study_id: int) -> StudyRow:
        """One study, or `NotFoundError`."""
        with self._database.reading() as connection:
            return _study(connection, study_id)

    def studies(self, limit: int | None = None, offset: int = 0) -> list[StudyRow]:
        """Studies, newest first; all of them without a limit."""
        query = select(STUDY).order_by(STUDY.c.id.desc()).limit(limit).offset(offset)
        with self._database.reading() as connection:
            return [StudyRow(**row._asdict()) for row in connection.execute(query)]

    def add_model(self, study_id: int, parent_id: int | None, effects: Sequence[str], result: Values) -> int:
        """Add a model to a study, made from another model of it or from nothing. Returns its id.

        Raises:
            NotFoundError: no such study, or the parent is no model of it.
        """
        with self._database.writing() as connection:
            _study(connection, study_id)
            if parent_id is not None and _model(connection, parent_id).study_id != study_id:
                raise NotFoundError(
                    f"model {parent_id} belongs to another study than {study_id}; name one of its own models"
                )
            row = {"study_id": study_id, "parent_id": parent_id, "effects": list(effects), "result": result}
            return _add(connection, MODEL, row)

    def model(self, model_id: int) -> ModelRow:
        """One model, or `NotFoundError`."""
        with self._database.reading() as connection:
            return _model(connection, model_id)

    def change_model(self, model_id: int, result: Values) -> None:
        """Replace what came out of a model, or `NotFoundError`."""
        with self._database.writing() as connection:
            _model(connection, model_id)
            _change(connection, MODEL, model_id, {"result": result})

    def models(self, study_id: int) -> list[ModelRow]:
        """The models of a study, oldest first, or `NotFoundError`."""
        query = select(MODEL).where(MODEL.c.study_id == study_id).order_by(MODEL.c.id)
        with self._database.reading() as connection:
            _study(connection, study_id)
            return [ModelRow(**row._asdict()) for row in connection.execute(query)]

    def remove_model(self, model_id: int) -> None:
        """Remove a model; `StoreStateError` where others were made from it."""
        with self._database.writing() as connection:
            _model(connection, model_id)
            children = connection.execute(select(MODEL.c.id).where(MODEL.c.parent_id == model_id)).scalars().all()
            if children:
                names = ", ".join(str(child) for child in children)
                raise StoreStateError(
                    f"model {model_id} cannot be removed: made from it are {names}; remove those first"
                )
            connection.execute(delete(MODEL).where(MODEL.c.id == model_id))
            chain.seal_removal(connection, "model", [model_id])


def _study(connection: Connection, study_id: int) -> StudyRow:
    query = select(STUDY).where(STUDY.c.id == study_id)
    return StudyRow(**row_of(connection, query, f"study {study_id}", "studies")._asdict())


def _model(connection: Connection, model_id: int) -> ModelRow:
    query = select(MODEL).where(MODEL.c.id == model_id)
    return ModelRow(**row_of(connection, query, f"model {model_id}", "models of the study")._asdict())


def _add(connection: Connection, table: Table, row: Values) -> int:
    row_id = insert_row(connection, table, {**row, "created_utc": now()})
    chain.seal(connection, table.name, [row_id])
    return row_id


def _change(connection: Connection, table: Table, row_id: int, values: Values) -> None:
    connection.execute(update(table).where(table.c.id == row_id).values(**values))
    chain.seal(connection, table.name, [row_id])
