"""A supply that sags while the effort is computed with its nominal voltage."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.errors import NotApplicableError
from compensator.lab.model.fit import fit_model
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Joint, plans, recordings

NOMINAL_V, SOURCE_OHM, WINDING_OHM, BACK_EMF_V_S, AMPERE_PER_N_M = 12.0, 1.2, 2.0, 0.4, 3.0
LARGE = 1.2  # of a back-EMF [V s/rad], at speed more than what the winding needs


def sagging(one: Recording, source_ohm: float, estimated: bool = False) -> Recording:
    """Duty x nominal supply of a stage that needs D (U - R_s D i) = R i + k_e w; or the current that it seems to be."""
    torque, time_s = one.channels["torque_n_m"], one.channels["time_s"]
    current_a = AMPERE_PER_N_M * torque
    back_emf_v = (LARGE if estimated else BACK_EMF_V_S) * np.gradient(one.channels["position_rad"], time_s)
    wanted_v = WINDING_OHM * current_a + back_emf_v
    duty = wanted_v / NOMINAL_V
    for _ in range(50):
        duty = wanted_v / (NOMINAL_V - source_ohm * duty * current_a)
    rest = {name: values for name, values in one.channels.items() if name != "torque_n_m"}
    if estimated:
        return replace(one, channels={**rest, "current_estimate_a": (duty * NOMINAL_V - back_emf_v) / WINDING_OHM})
    return replace(one, channels={**rest, "duty": duty, "supply_v": np.full(len(duty), NOMINAL_V)})


@pytest.fixture(scope="module")
def trials() -> list[Recording]:
    return recordings(Joint(), None, plans(loads_kg=(0.0, 0.1, 0.2, 0.3)), seed=5)


def diagnosed(trials, facts, source_ohm=SOURCE_OHM):
    dataset = make_dataset([sagging(one, source_ohm) for one in trials], facts, Processing())
    return diagnose(fit_model(dataset, default_effects(facts)))


def test_a_sagging_supply_is_in_the_first_class(trials):
    found = diagnosed(trials, replace(FACTS, supply_is_nominal=True))
    assert found.verdict == "missing"
    assert "supply_sag" in found.classes[0]


def test_the_duty_behind_an_estimated_current_holds_the_back_emf(trials):
    facts = replace(FACTS, supply_is_nominal=True)
    made = [sagging(one, 0.3, estimated=True) for one in trials]
    found = diagnose(fit_model(make_dataset(made, facts, Processing()), default_effects(facts)))
    assert found.verdict == "missing"
    assert found.classes[0][0] == "supply_sag"


def test_a_supply_that_never_changes_is_no_reading_of_it(trials):
    found = diagnosed(trials, FACTS)
    assert found.verdict == "missing"
    assert "supply_sag" in found.classes[0]


def read(one: Recording, step_v: float) -> Recording:
    """The supply as an instrument of that resolution reads it, once in a hundred samples one step lower."""
    supply_v = np.full(len(one), NOMINAL_V)
    supply_v[::100] -= step_v
    return replace(one, channels={**one.channels, "supply_v": supply_v})


@pytest.mark.parametrize(("told", "step_v"), [(None, 0.01), (False, 0.0)])
def test_where_the_supply_is_measured_it_cannot_be_missing(trials, told, step_v):
    facts = replace(FACTS, supply_is_nominal=told)
    dataset = make_dataset([read(sagging(one, SOURCE_OHM), step_v) for one in trials], facts, Processing())
    found = diagnose(fit_model(dataset, default_effects(facts)))
    assert "cannot hide behind a supply voltage that is measured" in found.left_out["supply_sag"]


def test_a_voltage_at_the_terminals_holds_the_sag(trials):
    """Nobody is asked for a supply, whatever the rig tells of one."""
    for told in (None, True):
        made = [replace(one, channels=one.channels | {"voltage_v": one.channels["torque_n_m"]}) for one in trials]
        facts = replace(FACTS, supply_is_nominal=told, effort="terminal_voltage")
        with pytest.raises(
            NotApplicableError, match="does not show in terminal voltage, but in current_estimate_a or duty x supply_v;"
        ):
            make_dataset(made, facts, Processing()).check_applicable(effect_named("supply_sag"))


def test_a_stiff_supply_is_no_finding(trials):
    found = diagnosed(trials, replace(FACTS, supply_is_nominal=True), source_ohm=0.0)
    assert found.verdict == "nothing"


BY_SPEED_V_S = BACK_EMF_V_S + WINDING_OHM * AMPERE_PER_N_M * Joint().viscous


@pytest.mark.parametrize(("told_v_s_rad", "held_v_s_rad"), [(0.3, 0.3), (None, BY_SPEED_V_S)])
def test_of_a_voltage_what_goes_by_the_speed_drives_no_current_where_no_constant_is_told(
    trials, told_v_s_rad, held_v_s_rad
):
    facts = replace(FACTS, back_emf_v_s_rad=told_v_s_rad)
    fit = fit_model(make_dataset([sagging(one, 0.0) for one in trials], facts, Processing()), default_effects(facts))
    found = with_own_prediction(fit.dataset, fit.terms).trials[0].motion.back_emf
    assert found == pytest.approx(held_v_s_rad, rel=0.05)


def test_a_back_emf_error_hides_in_viscous_friction(trials):
    told = diagnosed(trials, FACTS).left_out["back_emf_error"]
    assert "viscous" in told
    assert "coast-down" in told
