"""An effect that explains a part of what another cause makes is named as a part; one that is the cause is not."""

import numpy as np
import pytest

from compensator.lab.diagnosis import remaining
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.left_over import left_over
from compensator.lab.left_over.error_budget import NAMED, PLAIN
from tests.lab.left_over.judged import fitted

ORDER, RIPPLE_N_M = 5.0, 0.02
IN_PART = "position_periodic_friction describes it in part: beside it, what is left comes back with the position"


def diagnosed(law, seed=2):
    """Friction that rises and falls with the position by some law of the phase."""
    return diagnose(fitted(lambda x: RIPPLE_N_M * law(ORDER * x.q) * np.sign(x.v), seed))


def in_steps(phase):
    """A square wave, of which a cosine explains four fifths."""
    return np.sign(np.cos(phase))


def nearly_a_cosine(phase):
    """With a fiftieth of the power at another order."""
    return np.cos(phase) + 0.15 * np.cos(2.4 * phase)


def test_a_cause_that_is_imitated_leaves_much_of_what_its_formula_explains():
    found = diagnosed(in_steps)
    assert found.classes[0][0] == "position_periodic_friction"
    assert found.remains
    (told,) = [note for note in found.notes if "in part" in note]
    assert told.startswith(IN_PART)


def test_beside_a_name_a_curve_need_not_be_as_sure_as_where_nothing_is_named(monkeypatch):
    asked = []
    monkeypatch.setattr(left_over, "following_of", lambda *given: asked.append(given[2:]))
    assert diagnosed(np.cos).classes[0][0] == "position_periodic_friction"
    assert asked == [(NAMED.following, NAMED.following_far, 0.0)]
    assert NAMED.following > PLAIN.following


def test_what_is_little_beside_the_named_effect_is_not_told(monkeypatch):
    assert diagnosed(nearly_a_cosine).remains
    monkeypatch.setattr(left_over, "PART_OF_NAMED", 1.0)
    assert not diagnosed(nearly_a_cosine).remains


def test_a_force_that_goes_round_is_as_large_at_any_speed(monkeypatch):
    """What grows with the square of the speed is an acceleration, and that may be one that never was."""
    monkeypatch.setattr(remaining, "what_remains", lambda *_: [])  # so much of it is told as such, too
    found = diagnose(fitted(lambda x: RIPPLE_N_M * np.cos(ORDER * x.q) * (1.0 + 0.5 * x.v**2)))
    assert found.classes[0][0] == "cogging"
    (told,) = [note for note in found.notes if "in part" in note]
    assert f"about {ORDER:.0f} times a turn of the joint, and grows with the speed" in told
    assert found.remains


def test_a_force_that_goes_round_does_not_grow():
    found = diagnose(fitted(lambda x: RIPPLE_N_M * np.cos(ORDER * x.q)))
    assert found.classes[0][0] == "cogging"
    assert not found.remains, found.notes


@pytest.mark.parametrize("seed", range(2))
def test_the_cause_itself_leaves_nothing(seed):
    found = diagnosed(np.cos, seed)
    assert found.classes[0][0] == "position_periodic_friction"
    assert not found.remains, found.notes
