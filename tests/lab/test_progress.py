"""How far a computation has come: told to whoever follows it, and to nobody else."""

from contextlib import suppress

from compensator.lab import progress
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.four_families import STAGES
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, plans, recordings


def test_a_diagnosis_tells_each_of_its_stages_in_order_and_that_it_has_ended():
    joint = Joint(extra=lambda x: 0.02 * abs(x.v))
    made = recordings(joint, Bench(duration_s=9.0), plans(loads_kg=(0.0, 0.2), repeats=1), seed=1)
    fit = fit_model(make_dataset(made, FACTS, Processing()), list(default_effects(FACTS)))
    told: list[progress.Stage] = []
    with progress.followed(told.append):
        diagnose(fit)
    assert list(dict.fromkeys(one.name for one in told)) == [*STAGES, ""]
    assert told[-1].done == told[-1].of == len(STAGES)
    places = [one.done + one.part for one in told]
    assert places == sorted(places)
    assert any(0.0 < one.part < 1.0 for one in told), "the longest stage tells how much of it is done"


def test_who_has_gone_is_told_nothing_more():
    told: list[progress.Stage] = []
    with progress.followed(told.append), progress.stages(["one", "two"]):
        progress.enter("two")
        list(progress.each([1, 2]))
    assert [(one.name, one.part) for one in told] == [("one", 0.0), ("two", 0.0), ("two", 0.5), ("", 0.0)]
    with progress.stages(["one"]):
        progress.enter("one")
    assert len(told) == 4


def test_stages_within_a_stage_are_parts_of_it():
    told: list[progress.Stage] = []
    with progress.followed(told.append), progress.stages(["one", "two"]):
        with progress.stages(["a", "b"]):
            progress.enter("b")
        progress.enter("two")
        progress.enter("one")  # has ended
    assert [(one.name, one.part, one.within) for one in told] == [
        ("one", 0.0, ""), ("one", 0.0, "a"), ("one", 0.5, "b"), ("one", 1.0, ""), ("two", 0.0, ""), ("", 0.0, ""),
    ]  # fmt: skip


def test_what_fails_within_leaves_the_stages_around_it():
    told: list[progress.Stage] = []
    with progress.followed(told.append), progress.stages(["one", "two"]):
        with suppress(ValueError), progress.stages(["a"]):
            raise ValueError
        progress.enter("two")
    assert [one.name for one in told] == ["one", "one", "two", ""]
