"""An effect that explains a part of what another cause makes is named as a part; one that is the cause is not."""

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from compensator.lab.diagnosis import remaining
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.left_over import left_over, orders
from compensator.lab.left_over.error_budget import NAMED, PLAIN
from compensator.lab.left_over.left_over import in_its_place, left_beside
from compensator.lab.left_over.orders import Line
from compensator.lab.model.fit import fit_effects
from compensator.lab.screening.candidates import gather
from compensator.lab.screening.clearing import with_noise
from compensator.lab.screening.evidence import screen
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
    (told,) = [note.text for note in found.notes if "in part" in note.text]
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
    (told,) = [note.text for note in found.notes if "in part" in note.text]
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


def screened(gathered, name):
    """The best evidence for an effect."""
    blocks = [block for block in gathered.named if block.name == name]
    return screen(gathered.bases, blocks, gathered.fit.dataset.block_index[gathered.rows]).evidence[0]


def goes_round(law):
    """A joint with a ripple of some law."""
    return fitted(lambda x: 0.3 * RIPPLE_N_M * law(x) * np.cos(ORDER * x.q), 2)


def friction(x):
    return np.sign(x.v)


def force(x):
    return np.ones_like(x.q)


@pytest.mark.parametrize(
    ("law", "named", "instead"),
    [
        (friction, "cogging", True),
        (friction, "position_periodic_friction", False),
        (force, "position_periodic_friction", True),
        (force, "cogging", False),
    ],
)
def test_friction_that_goes_round_is_no_force_nor_the_other_way_round(law, named, instead):
    gathered = with_noise(gather(goes_round(law)))
    found = in_its_place(gathered, screened(gathered, named))
    assert (found is not None) == instead
    if found is not None:
        assert found.against_motion == (law is friction)
        assert found.order == pytest.approx(ORDER, abs=0.5)  # the travel is less than a turn


def test_what_goes_round_in_another_way_than_its_name_says_so(monkeypatch):
    monkeypatch.setattr(remaining, "what_remains", lambda *_: [])  # so much of it is told as such, too
    fit = goes_round(friction)
    gathered = with_noise(gather(fit))
    explained = fit_effects(fit.dataset, [*fit.names, "cogging"], fit.training)
    (told,) = remaining.beside_a_name(explained, gathered, screened(gathered, "cogging"), "cogging")
    assert "against the motion" in told.text
    assert "turns with the motion, as friction does, as cogging does not" in told.text


@pytest.mark.parametrize("named", ["cogging", "position_periodic_friction"])
def test_neither_a_force_nor_friction_grows_with_the_speed(named):
    gathered = with_noise(gather(fitted(lambda x: 0.3 * RIPPLE_N_M * x.v**2 * np.cos(9.3 * x.q), 2)))
    found = in_its_place(gathered, screened(gathered, named))
    assert found is not None
    assert found.growing


def test_a_line_whose_phase_a_delay_may_turn_tells_nothing(monkeypatch):
    gathered = with_noise(gather(goes_round(friction)))
    found = screened(gathered, "cogging")
    assert in_its_place(gathered, found) is not None
    speed = float(np.median(np.abs(np.concatenate([t.motion.velocity for t in gathered.fit.dataset.trials]))))
    turned = ORDER * speed / gathered.fit.dataset.trials[0].signals.rate_hz
    for share, told in ((2.0, True), (0.5, False)):
        monkeypatch.setattr(orders, "MOST_TURNED", share * turned)
        assert (in_its_place(gathered, found) is not None) == told


@pytest.mark.parametrize(("enough", "told"), [(100.0, True), (1e6, False)])
def test_beside_any_name_what_grows_with_the_speed_is_told_if_it_is_much(enough, told):
    """As friction that differs with the direction was named for an angle that is misread, whose name nobody had."""
    fit = fitted(lambda x: 0.01 * np.abs(x.v) + 0.06 * RIPPLE_N_M * x.v**2 * np.cos(20.7 * x.q), 2)
    gathered = with_noise(gather(fit))
    explained = fit_effects(fit.dataset, [*fit.names, "viscous_asymmetry"], fit.training)
    evidence = screened(gathered, "viscous_asymmetry")
    found = left_beside(explained, gathered, replace(evidence, noncentrality=enough))
    assert (found is not None) == told
    assert found is None or (isinstance(found, Line) and found.growing)


def test_an_earlier_name_may_leave_more_of_its_own_line():
    fit = goes_round(friction)
    grown = fit_effects(fit.dataset, [*fit.names, "viscous_asymmetry"], fit.training)
    gathered = with_noise(gather(grown))
    assert in_its_place(gathered, screened(gathered, "cogging")) is None


def test_what_an_effect_near_reversals_leaves_that_grows_with_the_speed_is_told_if_it_is_much(monkeypatch):
    """An angle that is misread is misread at reversals, too, and imitates what lives there."""
    fit = fitted(lambda x: 0.3 * RIPPLE_N_M * x.v**2 * np.cos(9.3 * x.q), 2)
    evidence = screened(with_noise(gather(fit)), "cogging")
    diagnosing = import_module("compensator.lab.diagnosis.diagnose")
    monkeypatch.setattr(diagnosing, "what_remains", lambda *_: [])
    for enough, told in ((100.0, True), (1e6, False)):
        named = replace(evidence, noncentrality=enough)
        memory = SimpleNamespace(
            verdict="missing",
            remains=False,
            named=named,
            candidates=[SimpleNamespace(effect=SimpleNamespace(name="frictional_lag"))],
        )
        notes = diagnosing._left_in_sliding(fit, gather(fit), memory)
        assert any("grows with the speed" in note.text for note in notes) == told, notes
