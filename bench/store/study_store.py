"""The part of the store that keeps studies and their models."""

from collections.abc import Sequence

from bench.json_types import Values
from bench.store.database import Database
from bench.store.records import ModelRow, StudyRow
from bench.store.tables import studies


class StudyStore:
    """Studies and models; `Store` is one."""

    _database: Database

    def create_study(self, name: str, definition: Values) -> int:
        """Add a study. Returns its id."""
        with self._database.writing() as connection:
            return studies.add(connection, name, definition)

    def change_study(self, study_id: int, definition: Values) -> None:
        """Replace the definition of a study, or `NotFoundError`."""
        with self._database.writing() as connection:
            studies.change(connection, study_id, definition)

    def study(self, study_id: int) -> StudyRow:
        """One study, or `NotFoundError`."""
        with self._database.reading() as connection:
            return studies.get(connection, study_id)

    def studies(self, limit: int | None = None, offset: int = 0) -> list[StudyRow]:
        """Studies, newest first; all of them without a limit."""
        with self._database.reading() as connection:
            return studies.find(connection, limit, offset)

    def add_model(self, study_id: int, parent_id: int | None, effects: Sequence[str], result: Values) -> int:
        """Add a model to a study, made from another model or from nothing. Returns its id."""
        with self._database.writing() as connection:
            return studies.add_model(connection, study_id, parent_id, effects, result)

    def model(self, model_id: int) -> ModelRow:
        """One model, or `NotFoundError`."""
        with self._database.reading() as connection:
            return studies.get_model(connection, model_id)

    def change_model(self, model_id: int, result: Values) -> None:
        """Replace what came out of a model, or `NotFoundError`."""
        with self._database.writing() as connection:
            studies.change_model(connection, model_id, result)

    def models(self, study_id: int) -> list[ModelRow]:
        """The models of a study, oldest first, or `NotFoundError`."""
        with self._database.reading() as connection:
            return studies.models(connection, study_id)

    def remove_model(self, model_id: int) -> None:
        """Remove a model; `StoreStateError` where others were made from it."""
        with self._database.writing() as connection:
            studies.remove_model(connection, model_id)
