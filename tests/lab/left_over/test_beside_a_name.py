"""Beside a formula that is named, too, it is asked whether what is left comes back with the position."""

import numpy as np

from compensator.lab.diagnosis.remaining import what_remains
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.left_over.left_over import left_over
from compensator.lab.model.fit import fit_model
from compensator.lab.model.order_search import FRICTION
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.gathering import gather, with_noise
from tests.lab.synthetic import FACTS, Joint, recordings


def test_friction_that_goes_round_is_told_beside_a_spring():
    joint = Joint(extra=lambda x: 0.004 * np.cos(6.0 * x.q) * np.sign(x.v))
    dataset = make_dataset(recordings(joint, seed=3), FACTS, Processing(cutoff_hz=8.0))
    fit = fit_model(dataset, [*default_effects(FACTS), "spring"])
    line = left_over(gather(fit)).line
    assert line is not None
    assert (line.kind, round(line.order)) == (FRICTION, 6)
    before = with_noise(gather(fit_model(dataset, default_effects(FACTS))))
    assert {note.code for note in what_remains(fit, before, "spring")} & {"recurs", "structure-remains"}


def beside_a_spring(extra):
    dataset = make_dataset(recordings(Joint(extra=extra), seed=3), FACTS, Processing(cutoff_hz=8.0))
    before = with_noise(gather(fit_model(dataset, default_effects(FACTS))))
    fit = fit_model(dataset, [*default_effects(FACTS), "spring"])
    return left_over(gather(fit)), what_remains(fit, before, "spring")


def test_a_curve_that_helps_is_told_however_little_is_left():
    """What a name does not explain may be under one percent of the effort, and of use all the same."""
    left, notes = beside_a_spring(lambda x: 0.006 * np.exp(-(((x.q - 0.4) / 0.2) ** 2)) * np.sign(x.v))
    assert not left.is_more_than_noise
    assert [note.values["driver"] for note in notes] == ["position"]


def test_beside_a_name_that_explains_all_nothing_is_told():
    assert beside_a_spring(None)[1] == []
