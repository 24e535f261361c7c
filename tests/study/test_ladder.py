"""The floor of a ladder is that of the model that predicts best, whichever is the newest."""

from math import nan
from types import SimpleNamespace
from typing import Any

import pytest

from bench.cli.lab.study_tables import ladder as show
from bench.study import ladder as module
from bench.study.models.base import NEAR_REVERSALS, ROWS_IN_WORDS, EffortName
from bench.study.models.kept import KeptModel
from bench.study.models.ladder import Ladder, Rung, StepGain
from bench.study.report.model_sections import UNLIKE, ladder_section
from bench.study.report.report import summary


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


def rung(number: int, held_out: float, *, shows: str = "", gain: StepGain | None = None, **change: Any) -> Rung:
    added = ["load_friction", "pre_sliding"][: max(0, number - 1)]
    return Rung.model_construct(
        model_id=number, parent_id=number - 1 or None, effects=["coulomb", *added], training=held_out,
        held_out=held_out, held_out_low=held_out, held_out_high=held_out, held_out_kind="leave-one-trial-out",
        breakaway=None, motion=None, reflected_error_g=None, trials=8, shows=shows, gain=gain,
        **{"added": None, "removed": None, **change},
    )  # fmt: skip


def climbed(last: float, gain: StepGain | None = None) -> Ladder:
    """Load friction, then pre-sliding, after which the error of steady sliding is the last."""
    rungs = [
        rung(1, 0.0291),
        rung(2, 0.0045, added="load_friction"),
        rung(3, last, added="pre_sliding", shows=NEAR_REVERSALS, gain=gain),
    ]
    return Ladder.model_construct(study_id=1, floor=None, rows="steady sliding", rungs=rungs)


MARKED = "* Pre sliding shows near reversals, which these errors do not count"
STUDY: Any = SimpleNamespace(trials=[SimpleNamespace(role="training")] * 8)
JUDGED = StepGain(
    rows=ROWS_IN_WORDS["moving"], held_out_before=0.02, held_out_after=0.01, gain=0.5, gain_low=0.4, gain_high=0.6
)


def test_what_shows_near_reversals_has_no_credit_for_the_fall_in_steady_sliding():
    _, error, elsewhere, left = summary(STUDY, climbed(0.0046), "Nothing is missing.")
    assert error.startswith("With load friction the error goes from 2.91% to 0.46%")
    assert elsewhere == "Pre sliding was added, too: it shows near reversals, which this error does not count."
    assert left == "Nothing is missing."


def test_what_it_did_near_reversals_is_told_where_that_is_known():
    *_, elsewhere, _ = summary(STUDY, climbed(0.0046, JUDGED), "")
    assert elsewhere.endswith("does not count; counting them, too, the error went from 2.00% to 1.00%.")


def test_it_has_where_the_error_of_steady_sliding_falls_with_it():
    _, error, left = summary(STUDY, climbed(0.0023), "Nothing is missing.")
    assert error.startswith("With load friction and pre sliding the error goes from 2.91% to 0.23%")
    assert left == "Nothing is missing."


@pytest.mark.parametrize(
    ("gain", "told"),
    [
        (None, f"{MARKED}."),
        (JUDGED, f"{MARKED}: counting them, too, the error went from 2.00% to 1.00%."),
    ],
)
def test_the_table_marks_it_and_says_why(gain, told, capsys):
    found = climbed(0.0046, gain)
    section = ladder_section(found)
    assert section.sentences[1:] == [told]
    assert [row[1] for row in section.tables[0].rows][1:] == ["+ load friction", "+ pre sliding *"]
    show(found)
    printed = capsys.readouterr().out
    assert "+ pre_sliding *" in printed
    assert told in printed
    assert ("50.0, 40.0 .. 60.0" in printed) == (gain is not None)


def test_a_gain_that_is_unlike_the_errors_says_why():
    weighted = JUDGED.model_copy(update={"held_out_after": 0.003})
    assert ladder_section(climbed(0.0046, weighted)).sentences[-1] == UNLIKE
