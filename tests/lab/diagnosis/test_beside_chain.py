"""What the measuring chain's columns predict as well near reversals is no reason for a name."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis import examination
from compensator.lab.diagnosis.confirmation import LEAST_GAIN, is_confirmed
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.diagnosis import Candidate
from compensator.lab.diagnosis.examination import gain_beside_chain
from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.model.fit import fit_effects, fit_model, widened
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain
from compensator.lab.model.held_out_error import HeldOut
from compensator.lab.model.validation import held_out
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from compensator.lab.screening.nuisance import nuisance_columns, smoothed_signs
from tests.lab.diagnosis.test_diagnose import SHAKEN, late
from tests.lab.synthetic import FACTS, Joint, Truth, plans, recordings

LAG = "frictional_lag"
EARLY_S = 0.009


def early(x: Truth) -> np.ndarray:
    """Friction that turns round before the speed does, less the friction that turns round with it."""
    return 0.12 * (np.sign(np.interp(x.time_s + EARLY_S, x.time_s, x.v)) - np.sign(x.v))


def moving(joint: Joint) -> Fit:
    """The default model, on rows near reversals, too."""
    dataset = make_dataset(recordings(joint, seed=4), FACTS, Processing())
    return widened(fit_model(dataset, default_effects(FACTS)), "moving")


def held_out_moving(fit: Fit) -> HeldOut:
    return held_out(fit, "moving")


@pytest.mark.parametrize(("law", "stands"), [(early, False), (late, True)])
def test_friction_that_turns_round_early_is_no_lag_and_a_lag_is(law, stands):
    fit = moving(Joint(extra=law))
    explained = fit_effects(fit.dataset, [*fit.names, LAG], fit.training)
    assert held_out_moving(explained).relative < 0.95 * held_out_moving(fit).relative
    gain = gain_beside_chain(effect_named(LAG), fit, explained, held_out_moving)
    assert gain is not None
    assert (gain.value >= LEAST_GAIN and gain.low > 0.0) == stands


def test_what_is_a_lag_but_for_being_the_least_of_its_scan_is_not_named():
    made = recordings(Joint(extra=early), trials=[*plans(), *SHAKEN], seed=4)
    found = diagnose(fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS)))
    first = next(one for one in found.candidates if one.effect.name == LAG)
    assert is_confirmed(replace(first, physical=True, beside_chain=None))
    assert (found.verdict, first.physical) == ("nothing", False)


def test_an_effect_that_stands_in_for_none_of_the_chain_is_not_held_against_it():
    fit = moving(Joint())
    assert gain_beside_chain(effect_named("elasticity"), fit, fit, held_out_moving) is None


@pytest.mark.parametrize(
    ("beside", "confirmed"),
    [
        (None, True),
        (Gain(0.02, 0.01, 0.03), True),
        (Gain(0.02, -0.01, 0.05, 0.01), True),  # few trials hold it, but the evidence is very strong
        (Gain(0.02, -0.01, 0.05, -0.01), False),  # one trial holds it
        (Gain(0.004, 0.002, 0.006), False),  # of no use
        (Gain(-0.1, -0.2, 0.1), False),
    ],
)
def test_beside_the_chain_the_error_must_fall(beside, confirmed):
    effect, gain = effect_named(LAG), Gain(0.3, 0.2, 0.4)
    one = Candidate(effect, (0.1,), 50.0, 1e-6, 9.0, (), 0.1, 0.07, gain, True, None, "moving", beside_chain=beside)
    assert is_confirmed(one) == confirmed


@pytest.mark.parametrize(("rows", "asked"), [("moving", 1), ("sliding", 0)])
def test_near_reversals_only_what_is_confirmed_is_held_against_the_chain(monkeypatch, rows, asked):
    calls: list[str] = []

    def gain(effect, *_):
        calls.append(effect.name)
        return Gain(-0.1, -0.2, 0.1)

    monkeypatch.setattr(examination, "gain_beside_chain", gain)
    sure = Candidate(effect_named(LAG), (0.1,), 50.0, 1e-6, 9.0, (), 0.1, 0.07, Gain(0.3, 0.2, 0.4), True, None, rows)
    unsure = replace(sure, gain=Gain(-0.3, -0.4, -0.2))
    fit = moving(Joint())
    found = [examination._beside_chain(one, fit, fit, rows) for one in (sure, unsure)]
    assert len(calls) == asked
    assert [is_confirmed(one) for one in found] == [not asked, False]


def test_smoothed_signs_are_the_chains_own_columns():
    dataset = moving(Joint()).dataset
    every = nuisance_columns(dataset)
    found = smoothed_signs(dataset, {"sign_rate", "slow_sign"})
    assert found == pytest.approx(np.column_stack([every["slow_sign"], every["sign_rate"]]))
