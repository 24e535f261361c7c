"""Rows of the tables of studies and models. Each function works inside the caller's transaction."""

from collections.abc import Sequence

from sqlalchemy import Connection, delete, select, update

from bench.json_types import Values
from bench.store.errors import NotFoundError, StoreStateError
from bench.store.records import ModelRow, StudyRow
from bench.store.schema import MODEL, STUDY
from bench.store.tables import chain
from bench.store.tables.experiments import insert_row, now


def add(connection: Connection, name: str, definition: Values) -> int:
    """Insert a study. Returns its id."""
    values = {"name": name, "definition": definition, "created_utc": now()}
    return _sealed(connection, "study", insert_row(connection, STUDY, values))


def get(connection: Connection, study_id: int) -> StudyRow:
    """One study.

    Raises:
        NotFoundError: no such study.
    """
    row = connection.execute(select(STUDY).where(STUDY.c.id == study_id)).one_or_none()
    if row is None:
        raise NotFoundError(f"study {study_id} is not in the store; list the studies to see which are")
    return StudyRow(**row._asdict())


def change(connection: Connection, study_id: int, definition: Values) -> None:
    """Replace the definition of a study.

    Raises:
        NotFoundError: no such study.
    """
    get(connection, study_id)
    connection.execute(update(STUDY).where(STUDY.c.id == study_id).values(definition=definition))
    chain.seal(connection, "study", [study_id])


def find(connection: Connection, limit: int | None, offset: int) -> list[StudyRow]:
    """Studies, newest first."""
    query = select(STUDY).order_by(STUDY.c.id.desc()).limit(limit).offset(offset)
    return [StudyRow(**row._asdict()) for row in connection.execute(query)]


def add_model(
    connection: Connection, study_id: int, parent_id: int | None, effects: Sequence[str], result: Values
) -> int:
    """Insert a model. Returns its id.

    Raises:
        NotFoundError: no such study, or the parent is no model of it.
    """
    get(connection, study_id)
    if parent_id is not None and get_model(connection, parent_id).study_id != study_id:
        raise NotFoundError(f"model {parent_id} belongs to another study than {study_id}; name one of its own models")
    values = {
        "study_id": study_id,
        "parent_id": parent_id,
        "effects": list(effects),
        "result": result,
        "created_utc": now(),
    }
    return _sealed(connection, "model", insert_row(connection, MODEL, values))


def get_model(connection: Connection, model_id: int) -> ModelRow:
    """One model.

    Raises:
        NotFoundError: no such model.
    """
    row = connection.execute(select(MODEL).where(MODEL.c.id == model_id)).one_or_none()
    if row is None:
        raise NotFoundError(f"model {model_id} is not in the store; list the models of the study to see which are")
    return ModelRow(**row._asdict())


def change_model(connection: Connection, model_id: int, result: Values) -> None:
    """Replace what came out of a model.

    Raises:
        NotFoundError: no such model.
    """
    get_model(connection, model_id)
    connection.execute(update(MODEL).where(MODEL.c.id == model_id).values(result=result))
    chain.seal(connection, "model", [model_id])


def models(connection: Connection, study_id: int) -> list[ModelRow]:
    """The models of a study, oldest first.

    Raises:
        NotFoundError: no such study.
    """
    get(connection, study_id)
    query = select(MODEL).where(MODEL.c.study_id == study_id).order_by(MODEL.c.id)
    return [ModelRow(**row._asdict()) for row in connection.execute(query)]


def remove_model(connection: Connection, model_id: int) -> None:
    """Remove a model that no other was made from.

    Raises:
        NotFoundError: no such model.
        StoreStateError: other models were made from it.
    """
    get_model(connection, model_id)
    children = connection.execute(select(MODEL.c.id).where(MODEL.c.parent_id == model_id)).scalars().all()
    if children:
        names = ", ".join(str(child) for child in children)
        raise StoreStateError(f"model {model_id} cannot be removed: made from it are {names}; remove those first")
    connection.execute(delete(MODEL).where(MODEL.c.id == model_id))
    chain.seal_removal(connection, "model", [model_id])


def _sealed(connection: Connection, subject: str, row_id: int) -> int:
    chain.seal(connection, subject, [row_id])
    return row_id
