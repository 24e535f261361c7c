"""What a stored model may be missing: found once, and kept for the page, suggestions and reports that ask again."""

from functools import lru_cache

from bench.store.records import ModelRow
from bench.study.errors import lab_errors
from bench.study.keep import kept_of
from bench.study.material import Material
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.model.fitted import Fit

MOST = 16  # kept: some kB each, beside their datasets' own few


def diagnosis_of_model(material: Material, model: ModelRow, fit: Fit) -> Diagnosis:
    """The diagnosis of a model; neither finished trials nor models ever change, so that it stays what it was.

    Raises:
        StudyError: no effect can be judged on these trials.
    """
    asked = _Asked(material, model, fit)
    return asked.diagnosis() if material.source is None else _kept(asked)


class _Asked:
    """A model of a study; equal where store, trials and model are. The fit is let go of once it was judged."""

    def __init__(self, material: Material, model: ModelRow, fit: Fit) -> None:
        shapes = tuple(kept_of(model).shapes.items())
        self._key = (material.source, material.definition, tuple(model.effects), shapes)
        self._fits = [fit]

    def diagnosis(self) -> Diagnosis:
        with lab_errors():
            return diagnose(self._fits.pop())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Asked) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)


@lru_cache(maxsize=MOST)
def _kept(asked: _Asked) -> Diagnosis:
    return asked.diagnosis()
