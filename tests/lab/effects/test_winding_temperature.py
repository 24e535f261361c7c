"""Magnets that pull less as they warm: an effort that comes from a voltage holds their back-EMF, too."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.effects.electrical import motor_warm_up
from compensator.lab.effects.electrical.winding_temperature import EFFECT
from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.effects.test_effects import motion
from tests.lab.synthetic import FACTS, Joint, recordings

WINDING_OHM, BACK_EMF_V_S, AMPERE_PER_N_M = 2.0, 1.2, 3.0
COPPER_1_K, FERRITE_1_K = 0.0039, 0.002


def warm(one: Recording) -> Recording:
    """The voltage that the same torque takes with a winding that resists more, and magnets that pull less."""
    warmer_k = one.channels["temperature_c"] - 25.0
    pull = 1.0 - FERRITE_1_K * warmer_k
    current_a = AMPERE_PER_N_M * one.channels["torque_n_m"] / pull
    speed_rad_s = np.gradient(one.channels["position_rad"], one.channels["time_s"])
    voltage_v = WINDING_OHM * (1.0 + COPPER_1_K * warmer_k) * current_a + BACK_EMF_V_S * pull * speed_rad_s
    rest = {name: values for name, values in one.channels.items() if name != "torque_n_m"}
    return replace(one, channels={**rest, "voltage_v": voltage_v})


def test_a_back_emf_that_falls_as_magnets_warm_is_no_other_effect():
    facts = replace(FACTS, back_emf_v_s_rad=BACK_EMF_V_S)
    dataset = make_dataset([warm(one) for one in recordings(Joint(), seed=5)], facts, Processing())
    found = diagnose(fit_model(dataset, [*default_effects(facts), EFFECT.name]))
    assert found.verdict == "nothing", found.sentence


@pytest.mark.parametrize(
    ("effort", "open_columns"), [("terminal_voltage", 1), ("current_estimate", 1), ("current", 0), ("torque", 0)]
)
def test_only_an_effort_that_comes_from_a_voltage_holds_a_back_emf(effort, open_columns):
    moving = motion()
    found = EFFECT.discrepancy(replace(moving, facts=replace(moving.facts, effort=effort)), ())
    assert found.shape == (open_columns, len(moving.velocity))
    assert all(one == pytest.approx((moving.temperature_c - 25.0) * moving.velocity) for one in found)
    found = motor_warm_up.discrepancy(replace(moving, facts=replace(moving.facts, effort=effort)), (40.0,))
    assert found.shape == (open_columns, len(moving.velocity))
    warmth = 1.0 - np.exp(-(30.0 + moving.time_s) / 40.0)
    assert all(one == pytest.approx(warmth * moving.velocity) for one in found)


def test_motions_know_the_effort_that_was_chosen():
    dataset = make_dataset(recordings(Joint(), seed=5), FACTS, Processing())
    assert {trial.motion.facts.effort for trial in dataset.trials} == {"torque"}
