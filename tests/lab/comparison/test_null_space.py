"""What trials and channels leave open of a model, said in words."""

from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.comparison.null_space import left_open
from compensator.lab.effects.catalogue import default_effects, effect_named
from compensator.lab.model.fit import fit_model
from compensator.lab.model.intervals import estimates
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, Truth, noise_of, plans, recordings

DEFAULT = default_effects(FACTS)


def told(made: list[Recording], effects=DEFAULT, facts=FACTS) -> list[str]:
    return left_open(fit_model(make_dataset(made, facts, Processing(8.0)), effects))


def with_channel(made: list[Recording], **channels) -> list[Recording]:
    """The torque as another quantity: each channel by its function of the torque."""
    return [
        replace(
            one,
            channels={name: value for name, value in one.channels.items() if name != "torque_n_m"}
            | {name: of(one.channels["torque_n_m"]) for name, of in channels.items()},
        )
        for one in made
    ]


@pytest.fixture(scope="module")
def several() -> list[Recording]:
    return recordings(Joint(), None, plans(loads_kg=(0.0, 0.1, 0.2)), seed=4)


@pytest.fixture(scope="module")
def one_load() -> list[Recording]:
    return recordings(Joint(), None, plans(loads_kg=(0.2,)), seed=4)


def test_trials_that_tell_everything_leave_nothing_open(several):
    assert told(several) == []


def test_one_load_cannot_tell_the_arm_from_what_hangs_on_it(one_load):
    inertia, gravity = told(one_load)[:2]
    assert inertia.startswith("Load inertia scale (Inertia) cannot be told apart from inertia ")
    assert gravity.startswith("Load moment scale (Gravity) cannot be told apart from arm moment (Gravity) ")
    assert "all of them hang 0.2 kg: trials with another load settle it" in gravity


def test_another_effect_that_is_the_same_here_is_told_by_what_would_excite_it(several):
    (sentence,) = told(several, [*DEFAULT, "viscous"])
    assert sentence.startswith("Viscous friction cannot be told apart from viscous friction in these trials")
    assert "speeds spread over at least a factor of ten" in sentence


def test_what_noise_leaves_correlated_is_known_in_combination_only():
    """Nearly all motion is quicker than the Stribeck speed: its excess looks like the rest of friction."""
    quick = [
        Plan(f"quick-{index}", [(0.8, 0.5, 0.3 * index), (0.4, 0.9, index)], load_kg=0.1 * index) for index in range(4)
    ]
    loud, still = (recordings(Joint(stribeck_speed=3.0), Bench(noise=noise), quick, seed=4) for noise in (0.2, 0.001))
    (sentence,) = said(loud)
    assert sentence.startswith("Coulomb friction and static minus Coulomb friction (Stribeck effect) ")
    assert "slow motion: many rows" in sentence
    assert said(still) == []  # correlated they are all the same, but known


def said(made: list[Recording]) -> list[str]:
    fit = fit_model(make_dataset(made, FACTS, Processing(8.0)), DEFAULT, shapes={"stribeck": (2.0, 1.0)})
    return [one for one in left_open(fit) if "in combination only" in one]


@pytest.mark.parametrize(("swing_rad", "is_told"), [(0.0, False), (3e-4, False), (0.03, True)])
def test_an_inertia_of_encoder_noise_is_not_told(swing_rad, is_told):
    """Constant speeds, forward and backward; swinging meanwhile by less, and by far more, than the encoder's noise."""
    random = np.random.default_rng(6)
    made = [at_constant_speed(speed, swing_rad, random) for speed in (0.1, -0.1, 0.3, -0.3, 0.8, -0.8)]
    fit = fit_model(make_dataset(made, FACTS, Processing(4.0)), DEFAULT)
    (inertia,) = [one for one in estimates(fit) if one.parameter == "inertia"]
    sentences = [one for one in left_open(fit) if one.startswith("Inertia is not told by these trials: ")]
    if is_told:
        assert inertia.low < 0.02 < inertia.high
        assert not sentences
    else:
        assert np.isnan([inertia.value, inertia.low, inertia.high]).all()
        assert inertia.note == "the acceleration is hardly more than noise of the position: these trials do not tell it"
        assert sentences[0].endswith("; what settles it: " + effect_named("inertia").excited_by)


def at_constant_speed(rad_s: float, swing_rad: float, random: np.random.Generator) -> Recording:
    time_s, w = np.arange(0.0, 12.0, 1.0 / 200.0), 2.0 * np.pi * 0.7
    swing = swing_rad * np.sin(w * time_s)
    q, v, a = rad_s * time_s + swing, rad_s + swing_rad * w * np.cos(w * time_s), -(w**2) * swing
    truth = Truth(time_s, q, v, a, 0.0, 0.3, 25.0 + 0.0 * time_s)
    torque = Joint().effort(truth) + noise_of(Bench(), len(time_s), random)
    channels = {"time_s": time_s, "position_rad": q + 3e-4 * random.standard_normal(len(q)), "torque_n_m": torque}
    return Recording(f"speed-{rad_s:g}", "speed", {"load_kg": 0.0, "arm_m": 0.3}, channels)


def test_a_voltage_holds_more_than_torque(several, one_load):
    volts = {"duty": lambda torque: torque / 12.0, "supply_v": lambda torque: np.full(len(torque), 24.0)}
    with_loads = told(with_channel(several, **volts))
    assert len(with_loads) == 1
    assert "viscous friction and the back-EMF constant are one number" in with_loads[0]
    assert "(1 N m is 2 V, by the loads)" in with_loads[0]
    assert (
        "torque constant and winding resistance are known as their ratio only"
        in told(with_channel(one_load, **volts))[-1]
    )


def test_a_computed_current_says_what_it_inherits(several):
    (sentence,) = told(with_channel(several, current_estimate_a=lambda torque: torque))
    assert "back-EMF constant is off by looks like viscous friction" in sentence


def test_a_current_without_torque_constant_needs_known_loads(several, one_load):
    current = {"current_a": lambda torque: 2.0 * torque}
    assert told(with_channel(several, **current)) == []
    assert "The rig tells no torque constant" in told(with_channel(one_load, **current))[-1]
    known = replace(FACTS, torque_per_current_n_m_a=0.5)
    assert not any("torque constant" in one for one in told(with_channel(one_load, **current), facts=known))


def linear(one: Recording, **channels: np.ndarray) -> Recording:
    """The same motion in m."""
    kept = {"time_s": one.channels["time_s"], "position_m": one.channels["position_rad"]}
    return replace(one, channels=kept | channels)


def test_a_linear_joint_is_told_of_in_its_own_words():
    facts = Facts(joint="linear")
    made = recordings(Joint(arm_moment=0.0), None, plans(loads_kg=(0.0, 0.2)), seed=4)
    by_current = [linear(one, current_a=one.channels["torque_n_m"]) for one in made]
    (sentence,) = [one for one in told(by_current, default_effects(facts), facts) if "in A" in one]
    assert "force constant and friction are known as their ratio only. Record the force (force_n)" in sentence
    by_voltage = [linear(one, voltage_v=one.channels["torque_n_m"]) for one in made]
    fit = fit_model(make_dataset(by_voltage, facts, Processing(8.0)), default_effects(facts))
    assert left_open(fit)[-1].startswith("The effort is the terminal voltage, which holds ")
    assert "force constant and winding resistance" in left_open(fit)[-1]
    units = {one.parameter: one.unit for one in estimates(fit)}
    assert units["load inertia scale"] == "V s2/(m kg)"
