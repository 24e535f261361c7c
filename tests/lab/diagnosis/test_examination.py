"""When a candidate counts as confirmed."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from compensator.lab.diagnosis import examination
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.examination import is_confirmed, is_past_scan, is_possible, is_within_bounds
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.model.gain import Gain
from compensator.lab.recordings.facts import Facts
from compensator.lab.screening.evidence import Base, Block, Evidence


@pytest.mark.parametrize(
    ("score", "p_value", "gain", "low", "confirmed"),
    [
        (5.0, 0.001, 0.2, 0.1, True),
        (-1.0, 0.001, 0.2, 0.1, False),  # does not pay for its parameters
        (5.0, 0.02, 0.2, 0.1, False),  # may be luck
        (50.0, 0.02, 0.2, 0.1, True),  # few stretches hold the evidence, but it is very strong
        (5.0, 0.001, 0.2, -0.01, False),  # held-out trials may not gain
        (50.0, 0.001, 0.2, -0.01, True),  # few trials hold the gain, but the evidence is very strong
        (50.0, 0.001, -0.01, -0.2, False),  # held-out trials lose
        (50.0, 0.001, 0.0005, 0.0001, False),  # a gain of no use
    ],
)
def test_score_luck_and_gain_must_all_speak_for_it(score, p_value, gain, low, confirmed):
    gained = Gain(gain, low, 2.0 * gain)
    candidate = Candidate(effect_named("spring"), (), score, p_value, 7.0, (), 0.1, 0.08, gained, True, None)
    assert is_confirmed(candidate) == confirmed


@pytest.mark.parametrize(
    ("rows", "without_best", "confirmed"),
    [
        ("sliding", -0.1, True),
        ("moving", 0.06, True),  # one trial holds most of the gain, and the others gain as well
        ("moving", 0.04, False),  # no more than any measuring chain leaves
        ("breakaway", 0.06, False),
    ],
)
def test_where_one_trial_holds_most_of_a_gain_near_reversals_the_others_must_gain_too(rows, without_best, confirmed):
    gained = Gain(0.3, -0.01, 0.4, without_best)
    candidate = Candidate(effect_named("backlash"), (), 50.0, 0.001, 7.0, (), 0.1, 0.07, gained, True, None, rows)
    assert is_confirmed(candidate) == confirmed


@pytest.mark.parametrize(("rows", "weighted"), [("sliding", True), ("moving", False)])
def test_in_the_ladder_a_name_is_held_against_the_rows_that_it_shows_in(monkeypatch, rows, weighted):
    asked: list[Any] = []
    known = np.ones(3)
    fit: Any = SimpleNamespace(dataset=SimpleNamespace(rows="sliding"), determination=known)

    def held_out(model, chosen, weights):
        asked.append((chosen, weights))
        return SimpleNamespace(relative=0.05)

    monkeypatch.setattr(examination, "held_out", held_out)
    monkeypatch.setattr(examination, "held_out_gain", lambda *_: Gain(0.5, 0.4, 0.6))
    one = Candidate(
        effect_named("backlash"), (), 50.0, 0.001, 7.0, (), 0.1, 0.07, Gain(0.3, 0.2, 0.4), True, None, rows
    )
    found = examination.as_in_the_ladder(one, fit, fit, rows)
    assert asked == [(rows, known if weighted else None)] * 2
    assert (found.after, found.gain.value) == (0.05, 0.5)


@pytest.mark.parametrize(
    ("before", "after", "confirmed"),
    [
        (0.003, 0.00295, True),  # of the effort it explains 0.055 %
        (0.003, 0.00297, False),  # 0.042 %
        (0.0009, 0.0008, False),  # as large a share of a smaller error is less of the effort: 0.041 %
        (0.00295, 0.003, False),  # more is left than before
    ],
)
def test_what_explains_less_of_the_effort_than_sensors_are_linear_is_not_confirmed(before, after, confirmed):
    gained = Gain(1.0 - after / before, 0.005, 0.1)
    candidate = Candidate(effect_named("spring"), (), 50.0, 0.001, 7.0, (), before, after, gained, True, None)
    assert is_confirmed(candidate) == confirmed


@pytest.mark.parametrize("rows", ["sliding", "moving"])
def test_a_sign_or_size_that_cannot_be_is_the_shadow_of_something_else(rows):
    gained = Gain(0.2, 0.1, 0.3)
    for physical in (True, False):
        candidate = Candidate(effect_named("spring"), (), 50.0, 0.001, 7.0, (), 0.1, 0.08, gained, physical, None, rows)
        assert is_confirmed(candidate) == physical


@pytest.mark.parametrize(
    ("share", "noncentrality", "possible"),
    [
        (0.5, 400.0, True),
        (0.29, 400.0, True),  # 0.3 is the least, and lies within two standard errors
        (0.29, 40000.0, False),  # it does not: they are a tenth as large
        (0.2, 400.0, False),
        (-0.5, 400.0, False),
    ],
)
def test_a_size_beyond_its_bounds_for_sure_cannot_be(share, noncentrality, possible):
    column = np.sin(np.arange(200.0))
    item = Evidence(Block("backlash", column[:, None], 0, 15, (0.02,)), 50.0, noncentrality, 0.001, column)
    dataset = SimpleNamespace(effort_definition=SimpleNamespace(quantity="torque"))
    gathered: Any = SimpleNamespace(
        bases=[Base(np.zeros((200, 1)), share * column)], fit=SimpleNamespace(dataset=dataset)
    )
    assert is_within_bounds(gathered, item) == possible


@pytest.mark.parametrize(
    ("name", "shape", "possible"),
    [
        ("backlash", (0.009,), False),  # the data sheet says 5 mrad
        ("backlash", (0.011,), True),
        ("elasticity", (8.0, 0.06), False),  # and 10 Hz
        ("elasticity", (6.0, 0.06), True),
    ],
)
def test_hardly_more_than_the_owner_tells_of_is_not_missing(name, shape, possible):
    column = np.sin(np.arange(200.0))
    item = Evidence(Block(name, column[:, None], 0, 15, shape), 50.0, 400.0, 0.001, column)
    told = Facts(backlash_rad=0.005, stiffness_n_m_rad=0.02 * (20.0 * np.pi) ** 2, arm_inertia_kg_m2=0.02)
    for facts, expected in ((told, possible), (Facts(), True)):
        dataset = SimpleNamespace(effort_definition=SimpleNamespace(quantity="torque"), facts=facts)
        fit = SimpleNamespace(dataset=dataset, dry_friction=0.1)
        gathered: Any = SimpleNamespace(bases=[Base(np.zeros((200, 1)), column)], fit=fit, show_in="moving")
        assert is_possible(gathered, item) == expected


@pytest.mark.parametrize(
    ("shape", "past"),
    [
        ((38.0, 0.3), False),
        ((3.0, 0.06), False),  # at the lower ends
        ((40.0, 0.3), True),
        ((40.0 * (1.0 - 1e-15), 0.3), True),  # a logarithm and back may make that of 40
        ((8.0, 0.7), True),  # nothing swings
    ],
)
def test_a_shape_at_an_upper_end_of_a_scan_goes_on_beyond_it(shape, past):
    trial = SimpleNamespace(motion=SimpleNamespace(step_s=0.01))
    gathered: Any = SimpleNamespace(fit=SimpleNamespace(dataset=SimpleNamespace(trials=[trial])))
    block = Block("elasticity", np.zeros((1, 1)), 0, 1, shape)
    assert is_past_scan(gathered, Evidence(block, 50.0, 60.0, 0.001, np.zeros(1))) == past
