"""A study: which physical effect is missing in the model."""

from collections.abc import Sequence
from typing import Any, Literal

from bench.client.connection import Connection
from bench.study.models.change import Changed
from bench.study.models.closed_loop import ClosedLoop
from bench.study.models.comparison import Comparison
from bench.study.models.diagnosis import Diagnosis
from bench.study.models.ladder import Ladder
from bench.study.models.study import Study as Facts
from bench.study.models.units import UnitComparison


class Study:
    """What `Bench.new_study` returns.

    Attributes:
        study_id: its number.
    """

    def __init__(self, connection: Connection, study_id: int) -> None:
        self._connection = connection
        self.study_id = study_id

    @property
    def facts(self) -> Facts:
        """Trials and their roles, effort, the model that it stands at."""
        return Facts.model_validate(self._get(""))

    def compare(self, model_id: int | None = None) -> Comparison:
        """Measured against predicted: series, residuals, errors, parameters."""
        return Comparison.model_validate(self._get("/compare", model_id=model_id))

    def diagnose(self, model_id: int | None = None) -> Diagnosis:
        """What is missing, how sure that is, and what adding it would bring."""
        return Diagnosis.model_validate(self._get("/diagnose", model_id=model_id))

    def simulate(self, model_id: int | None = None, refine: bool = False) -> ClosedLoop:
        """Where the model's joint goes under the servo of the trials: error of the motion; refined coefficients."""
        return ClosedLoop.model_validate(self._get("/closed-loop", model_id=model_id, refine=refine))

    def units(self, beside: Sequence["Study"], model_id: int | None = None) -> UnitComparison:
        """Units of one kind, this study's the first: what they have in common, how they scatter, which is an outlier.

        Args:
            beside: a study for each other unit; beside one alone, `differences` tells what differs.
            model_id: of this study, fitted to all; None takes the newest.
        """
        numbers = [one.study_id for one in beside]
        return UnitComparison.model_validate(self._get("/units", beside=numbers, model_id=model_id))

    def add(self, effect: str, model_id: int | None = None) -> Changed:
        """One effect more: refit; the error before and after."""
        return self._change(effect, "add", model_id)

    def drop(self, effect: str, model_id: int | None = None) -> Changed:
        """One effect less."""
        return self._change(effect, "drop", model_id)

    def ladder(self) -> Ladder:
        """Error of every model of the study, on the trials of the fit and on the others."""
        return Ladder.model_validate(self._get("/ladder"))

    def remove(self, reason: str) -> None:
        """Remove the study with its models for good, not its trials; takes an admin's token.

        Args:
            reason: why; the audit log keeps it, with who and when.

        Raises:
            Refused: a calibration carries a model of it.
        """
        self._connection.send("DELETE", f"/studies/{self.study_id}", reason=reason)

    def _get(self, path: str, **query: object) -> Any:
        return self._connection.get(f"/studies/{self.study_id}{path}", **query)

    def _change(self, effect: str, action: Literal["add", "drop"], model_id: int | None) -> Changed:
        body = {"effect": effect, "action": action, "model_id": model_id}
        return Changed.model_validate(self._connection.post(f"/studies/{self.study_id}/models", body))

    def __repr__(self) -> str:
        facts = self.facts
        return f"<Study {self.study_id} {facts.name}: {len(facts.trials)} trials, model {facts.model_id}>"

    def _repr_html_(self) -> str:
        return self.facts._repr_html_()
