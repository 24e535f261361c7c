"""A motor that warms over a session raises all of the effort; friction that falls over one is something else."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import SESSION_START, Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.effects.test_winding_temperature import BACK_EMF_V_S, COPPER_1_K, FERRITE_1_K, warm
from tests.lab.synthetic import FACTS, Array, Joint, Plan, Truth, plans, recordings

BETWEEN_S, WARM_S = 150.0, 900.0  # from start to start, and until a motor has 63 % of its warmth
DEFAULT = default_effects(FACTS)


def session(temperature_k: float | None = None) -> list[Plan]:
    """Trials in an order by chance, spread over a session; a thermometer would read so much more at its end."""
    order = np.random.default_rng(8).permutation(2 * 9)
    starts = [{SESSION_START: BETWEEN_S * float(place)} for place in order]
    made = []
    for plan, start in zip(plans(repeats=2), starts, strict=True):
        reads_c = None if temperature_k is None else 25.0 + temperature_k * float(warmth(start[SESSION_START]))
        made.append(replace(plan, temperature_c=reads_c, conditions={**plan.conditions, **start}))
    return made


def warmth(session_s: Array | float) -> Array:
    return np.asarray(1.0 - np.exp(-np.asarray(session_s) / WARM_S))


def risen(one: Recording, share: float) -> Recording:
    """The same torque by a motor that takes so much more for it at the end."""
    now = warmth(float(one.conditions[SESSION_START]) + one.channels["time_s"])
    effort = one.channels["torque_n_m"] * (1.0 + share * now)
    return replace(one, channels={**one.channels, "torque_n_m": effort})


def fitted(made: list[Recording], *added: str) -> Fit:
    return fit_model(make_dataset(made, FACTS, Processing()), [*DEFAULT, *added])


def named(found: Diagnosis) -> tuple[str, ...]:
    assert found.verdict == "missing", found.sentence
    return tuple(found.classes[0])


@pytest.fixture(scope="module")
def unmeasured() -> list[Recording]:
    return [risen(one, 0.2) for one in recordings(trials=session(), seed=3)]


def test_effort_that_grows_as_a_whole_over_a_session_is_the_motor(unmeasured):
    found = diagnose(fitted(unmeasured))
    assert named(found) == ("motor_warm_up",)
    assert found.candidates[0].gain.low > 0.0
    filled = fitted(unmeasured, "motor_warm_up")
    assert filled.terms[-1].coefficients[0] == pytest.approx(0.2, abs=0.03)
    assert filled.shapes["motor_warm_up"][0] == pytest.approx(WARM_S, rel=0.3)
    assert diagnose(filled).verdict == "nothing"


def test_friction_alone_that_falls_over_a_session_is_not_the_motor():
    def fallen(one: Recording) -> Recording:
        speed = np.gradient(one.channels["position_rad"], one.channels["time_s"])
        excess = 0.05 * (1.0 - warmth(float(one.conditions[SESSION_START]) + one.channels["time_s"]))
        effort = one.channels["torque_n_m"] + excess * np.tanh(speed / 0.02)
        return replace(one, channels={**one.channels, "torque_n_m": effort})

    found = diagnose(fitted([fallen(one) for one in recordings(trials=session(), seed=3)]))
    assert named(found) == ("warm_up",)


def test_an_effort_that_falls_over_a_session_is_no_warm_motor():
    found = diagnose(fitted([risen(one, -0.2) for one in recordings(trials=session(), seed=3)]))
    assert found.verdict != "missing", found.sentence
    best = next(one for one in found.candidates if one.effect.name == "motor_warm_up")
    assert not best.physical


def test_where_the_temperature_is_measured_both_are_named():
    found = diagnose(fitted([risen(one, 0.2) for one in recordings(trials=session(50.0), seed=3)]))
    assert set(named(found)) == {"motor_warm_up", "winding_temperature"}


def test_a_temperature_that_did_not_go_by_the_session_tells_the_motor_that_follows_it():
    def hot(x: Truth) -> Array:
        return 0.004 * (x.temperature_c - 25.0) * Joint().effort(x)

    starts = [plan.conditions for plan in session()]
    trials = [replace(plan, conditions=begun) for plan, begun in zip(plans(repeats=2), starts, strict=True)]
    found = diagnose(fitted(recordings(Joint(extra=hot), trials=trials, seed=3)))
    assert named(found) == ("winding_temperature",)


def test_a_voltage_grows_by_copper_and_magnets_and_the_back_emf_that_falls_with_them_is_nothing_more():
    def unmeasured(one: Recording) -> Recording:
        hot = warm(one)
        return replace(hot, channels={name: x for name, x in hot.channels.items() if name != "temperature_c"})

    made = [unmeasured(one) for one in recordings(trials=session(50.0), seed=3)]
    dataset = make_dataset(made, replace(FACTS, back_emf_v_s_rad=BACK_EMF_V_S), Processing())
    assert named(diagnose(fit_model(dataset, DEFAULT))) == ("motor_warm_up",)
    filled = fit_model(dataset, [*DEFAULT, "motor_warm_up"])
    risen_to = (1.0 + 50.0 * COPPER_1_K) / (1.0 - 50.0 * FERRITE_1_K)
    assert filled.terms[-1].coefficients[0] == pytest.approx(risen_to - 1.0, abs=0.03)
    assert diagnose(filled).verdict == "nothing"
