"""The floor of a ladder is that of the model that predicts best, whichever is the newest."""

from math import nan
from types import SimpleNamespace
from typing import Any

import pytest

from bench.study import ladder as module
from bench.study.models.base import EffortName
from bench.study.models.kept import KeptModel


@pytest.mark.parametrize(
    ("kept", "floor"),
    [
        ([(0.05, 0.01, 8), (0.02, 0.004, 8), (0.05, 0.01, 8)], 0.004),
        ([(0.02, 0.004, 8), (0.03, 0.006, 12), (0.04, 0.008, 12)], 0.006),  # of as many trials as the newest
        ([(nan, None, 8), (0.02, 0.004, 8)], 0.004),  # of older versions: not known
    ],
)
def test_the_floor_is_that_of_the_best_model(monkeypatch, kept, floor):
    models = [SimpleNamespace(id=number, parent_id=None, effects=["coulomb"]) for number in range(len(kept))]
    found = [KeptModel(held_out=error, floor=own, trials=trials) for error, own, trials in kept]
    monkeypatch.setattr(module, "kept_of", lambda model: found[model.id])
    effort = EffortName(name="torque", unit="N m", title="torque")
    material = SimpleNamespace(effort=effort, dataset=SimpleNamespace(rows="sliding"))
    monkeypatch.setattr(module, "load", lambda *_: material)
    store: Any = SimpleNamespace(models=lambda _: models)
    assert module.ladder(store, 1).floor == floor
