"""What cannot be compared ends in a sentence that says why, what was found and what to do; the rest is answered."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from compensator.lab.comparison.comparison import compare
from compensator.lab.diagnosis.data_checks import fatal_problems, lesser_problems
from compensator.lab.diagnosis.diagnose import diagnose
from compensator.lab.diagnosis.diagnosis import Diagnosis
from compensator.lab.effects.catalogue import default_effects
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fit import fit_model
from compensator.lab.recordings.facts import Facts
from compensator.lab.recordings.recording import Recording
from compensator.lab.rows.assembly import make_dataset
from compensator.lab.rows.dataset import Processing
from tests.lab.synthetic import FACTS, Bench, Joint, Plan, Truth, plans, recordings

NO_GRAVITY = Joint(arm_moment=0.0)
LINEAR = Facts(joint="linear")


FEW = plans((0.0, 0.25))


Made = Callable[[], list[Recording]]  # recorded when its test runs, not whenever tests are collected


def changed(change: Callable[[Recording], None], which: slice = slice(None)) -> list[Recording]:
    made = recordings(trials=FEW, seed=3)
    for recording in made[which]:
        change(recording)
    return made


def put(channel: str, value: object) -> Callable[[Recording], None]:
    def change(recording: Recording) -> None:
        old = recording.channels.get(channel)
        recording.channels[channel] = value(old) if callable(value) else np.full(len(recording), value)

    return change


def condition(name: str, value: object) -> Callable[[Recording], None]:
    return lambda recording: recording.conditions.update({name: value})


def first_samples(count: int) -> list[Recording]:
    one = recordings(seed=3)[0]
    return [Recording("short", "x", {}, {name: values[:count] for name, values in one.channels.items()})]


def steps_only() -> list[Recording]:
    time_s = np.arange(0, 20, 0.005)
    position = np.where(time_s // 2 % 2 > 0, 1.0, 0.0)
    return [Recording("s", "x", {}, {"time_s": time_s, "position_rad": position, "torque_n_m": 0.1 * position})]


def jitter_of_the_encoder(old: np.ndarray) -> np.ndarray:
    return 1e-4 * np.round(np.random.default_rng(0).standard_normal(len(old)))


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (list, "no recordings: choose at least one trial"),
        (
            lambda: changed(put("position_rad", 0.3)),
            "the joint does not move in any trial, under .*; record trials with",
        ),
        (
            lambda: changed(put("position_rad", jitter_of_the_encoder)),
            "0 rows count, and at least 40 are needed: the joint moves faster than 0.000",
        ),
        (steps_only, "0 rows count, and at least 40 are needed: the joint moves faster than"),
        (lambda: changed(put("torque_n_m", 0.3)), "torque_n_m is 0.3 N m all the time; check the channel's mapping"),
        (lambda: changed(put("torque_n_m", 0.0)), "torque_n_m is 0 N m all the time"),
        (lambda: changed(put("torque_n_m", np.nan)), "'load-0g-0-1' has no effort channel"),
        (lambda: changed(put("torque_n_m", np.nan), slice(2, 3)), "'load-0g-2-1' has no effort channel"),
        (lambda: changed(put("position_rad", np.nan), slice(2, 3)), "'load-0g-2-1': position_rad has no finite sample"),
        (
            lambda: changed(put("enabled", 0.0)),
            "no usable rows: the power stage is off in 100% of the samples; record with it on",
        ),
        (lambda: changed(put("duty", 1.0)), "no usable rows: the duty is at its limit in 100% of the samples"),
        (lambda: first_samples(2), "'short' has 2 samples; at least .* are needed to filter"),
        (lambda: first_samples(1), r"'short' has 1 sample\(s\); record longer"),
        (lambda: first_samples(0), "'short' has no effort channel"),
        (lambda: [*recordings(seed=3), *first_samples(50)], "'short' has 50 samples; at least"),
        (
            lambda: changed(put("time_s", lambda t: 1e3 * t)),
            "0.2 samples a second; at least 4 .* check that time_s is in seconds",
        ),
        (
            lambda: changed(condition("load_kg", "heavy")),
            "'load-0g-0-1': condition load_kg is 'heavy', wanted is a number",
        ),
        (lambda: changed(condition("arm_m", float("nan"))), "condition arm_m is 'nan', wanted is a number"),
    ],
)
def test_unusable_data_say_what_is_wrong_and_what_to_do(made: Made, words: str) -> None:
    with pytest.raises(UnusableDataError, match=words):
        fit_model(make_dataset(made(), FACTS, Processing()), default_effects(FACTS))


def diagnosed(made: list[Recording], facts: Facts = FACTS) -> Diagnosis:
    fit = fit_model(make_dataset(made, facts, Processing()), default_effects(facts))
    assert np.isfinite(compare(fit).held_out.relative)
    found = diagnose(fit)
    assert found.sentence
    assert np.isfinite([candidate.score for candidate in found.candidates]).all()
    return found


def lost_stretches(recording: Recording) -> None:
    for first in range(300, 2300, 400):
        recording.channels["torque_n_m"][first : first + 100] = np.nan
        recording.channels["position_rad"][first + 50 : first + 120] = np.nan


def cold(recording: Recording) -> None:
    recording.channels["temperature_c"][:] = np.nan


@pytest.mark.parametrize(
    "made",
    [
        lambda: changed(lost_stretches),
        lambda: changed(cold),
        lambda: changed(lambda recording: recording.channels["torque_n_m"].__setitem__(500, np.inf)),
        lambda: recordings(seed=3)[:1],
        lambda: recordings(seed=3)[3:5],
        lambda: recordings(trials=plans((0.2,)), seed=3),
        lambda: recordings(trials=plans((0.1, 0.1, 0.1)), seed=3),
        lambda: [replace(one, name="same") for one in recordings(seed=3)],
        lambda: [*recordings(seed=3)[:5], *recordings(bench=Bench(rate_hz=50.0), seed=3)[5:]],
        lambda: recordings(bench=Bench(noise=0.0, quantum=0.0), seed=3),
        lambda: changed(put("torque_n_m", lambda torque: 1e-6 * torque), slice(0, 3))[:3],
        lambda: changed(put("torque_n_m", lambda torque: 1e9 * torque), slice(0, 3))[:3],
    ],
    ids=[
        "lost stretches", "no temperature", "infinite effort", "one trial", "two trials", "one load", "alike loads",
        "one name for all", "mixed rates", "no noise", "micro-units", "giga-units",
    ],
)  # fmt: skip
def test_a_complete_model_of_poor_data_lacks_nothing(made: Made) -> None:
    found = diagnosed(made())
    assert found.verdict == "nothing", found.sentence
    assert found.data_problems == []


def test_a_trial_without_any_row_that_can_be_used_is_told_and_left_out():
    found = diagnosed(changed(put("duty", 1.0), slice(2, 3)))
    assert found.verdict == "nothing", found.sentence
    assert any("not used, since the duty is at its limit" in problem for problem in found.data_problems)


def test_loads_that_count_as_none_are_told():
    half = diagnosed(changed(lambda recording: recording.conditions.pop("load_kg"), slice(0, 1)))
    assert any("'load-0g-0-1' do not tell load_kg, others do" in problem for problem in half.data_problems)
    armless = diagnosed(changed(lambda recording: recording.conditions.pop("arm_m")), Facts())
    assert any("is told, and not where it hangs" in problem for problem in armless.data_problems)


def test_a_temperature_that_is_empty_in_part_is_told_with_the_trial():
    made = changed(cold, slice(1, 2))
    found = diagnosed(made)
    words = f"needs temperature_c to differ over the data, and it is empty, in part or all the time, in {made[1].name}"
    assert words in found.left_out["coulomb_temperature"]


def test_a_slide_carries_its_load_without_an_arm():
    made = [
        Recording(one.name, one.kind, {"load_kg": 2.0}, {
            "time_s": one.channels["time_s"],
            "position_m": one.channels["position_rad"],
            "force_n": one.channels["torque_n_m"],
        })
        for one in recordings(NO_GRAVITY, Bench(arm_m=0.0), FEW, seed=3)
    ]  # fmt: skip
    assert make_dataset(made, LINEAR, Processing()).trials[0].motion.load_inertia_kg_m2 == 2.0


@pytest.mark.parametrize(
    ("channel", "value", "words"),
    [
        (
            "enabled",
            0.0,
            "power stage is off in all that could be used of them (enabled = 0): 'load-0g-2-1'; record with",
        ),
        (
            "duty",
            1.0,
            "not used, since the duty is at its limit in all that could be used of them: 'load-0g-2-1'; record",
        ),
        (
            "position_rad",
            0.3,
            "not used, since the joint does not move in any usable row of theirs: 'load-0g-2-1'; record motion, or",
        ),
    ],
)
def test_why_a_trial_is_not_used(channel, value, words):
    made = changed(put(channel, value), slice(2, 3))
    fit = fit_model(make_dataset(made, FACTS, Processing()), ("inertia", "gravity", "coulomb", "viscous"))
    assert any(words in problem for problem in lesser_problems(fit))


@pytest.mark.parametrize(("stiffness", "told_n_m", "words"), [
    (0.0, 0.25, ""),
    (0.0, 0.3, ""),  # data sheets are off by as much
    (0.0, 0.15, "the arm weighs 0.25 N m at 90 degrees by the model, and 0.15 N m by the rig"),
    (0.25, 0.25, "N m by the rig (arm.mass_kg x arm.centre_of_mass_m x g): check these; if they are right, something"),
])  # fmt: skip
def test_an_arm_that_weighs_otherwise_than_the_rig_says_is_told(stiffness, told_n_m, words):
    made = recordings(Joint(extra=lambda x: stiffness * x.q), seed=3)
    dataset = make_dataset(made, replace(FACTS, arm_moment_n_m=told_n_m), Processing())
    found = [one for one in lesser_problems(fit_model(dataset, default_effects(FACTS))) if "the arm weighs" in one]
    assert len(found) == bool(words)
    assert not words or words in found[0]


def test_a_coarse_sensor_is_told_where_a_longer_trial_would_not_help():
    made = recordings(trials=plans((0.0,)), bench=Bench(duration_s=30.0, quantum=2.0 * np.pi / 12.0), seed=3)
    with pytest.raises(UnusableDataError, match="the position resolves no slower motion: use a sensor of more counts"):
        make_dataset(made, FACTS, Processing(cutoff_hz=6.0))


def test_a_study_with_next_to_no_steady_sliding_is_refused_with_what_to_record():
    made = recordings(trials=[Plan("quick", [(0.2, 3.5, 0.0)], 0.15, 0.2, 25.0)], seed=3)
    fit = fit_model(make_dataset(made, FACTS, Processing(rows="all")), ("inertia", "gravity", "coulomb", "viscous"))
    with pytest.raises(UnusableDataError, match=r"0 of .* steady sliding, and a diagnosis needs 20: record longer"):
        diagnose(fit)


@pytest.mark.parametrize("scale", [1.0, 1e3, 1e-6])
def test_a_linear_joint_in_any_unit(scale):
    made = [
        Recording(one.name, one.kind, {}, {
            "time_s": one.channels["time_s"],
            "position_m": scale * one.channels["position_rad"],
            "force_n": 100.0 * one.channels["torque_n_m"],
        })
        for one in recordings(NO_GRAVITY, Bench(arm_m=0.0), seed=3)
    ]  # fmt: skip
    dataset = make_dataset(made, LINEAR, Processing())
    fit = fit_model(dataset, default_effects(LINEAR))
    assert "gravity" not in fit.names
    inertia, viscous = fit.coefficients[0], fit.coefficients[4]
    assert (scale * inertia, scale * viscous) == pytest.approx((2.0, 3.0), rel=0.05)
    assert diagnosed(made, LINEAR).verdict == "nothing"


def test_a_horizontal_joint_has_no_gravity_to_miss():
    facts = replace(FACTS, horizontal=True)
    found = diagnosed(recordings(NO_GRAVITY, Bench(arm_m=0.0), seed=3), facts)
    assert found.verdict == "nothing"
    assert not {"gravity", "centre_of_mass_angle"} & {one.effect.name for one in found.candidates}


@pytest.mark.parametrize("seed", range(3))
def test_an_effort_that_has_nothing_to_do_with_the_motion_is_a_problem_of_the_data(seed):
    random = np.random.default_rng(seed)
    made = changed(put("torque_n_m", lambda torque: np.cumsum(random.standard_normal(len(torque)))))
    found = diagnosed(made)
    assert found.verdict == "data-problem"
    assert found.candidates == []
    assert any("explain next to nothing" in problem for problem in found.data_problems)


def test_a_sine_that_is_turned_is_not_said_to_be_late():
    sines = [Plan(f"sine-{n}", ((0.6, 1.0, n), (0.1, 0.37, n)), load_kg=0.1 * n) for n in range(3)]
    made = recordings(trials=sines, seed=3)
    for recording in made:
        recording.channels["torque_n_m"] *= -1.0
    (told, *_) = diagnosed(made).data_problems
    assert "turn the sign of torque_n_m" in told


def test_copies_of_a_trial_are_told():
    made = recordings(seed=3)
    found = diagnosed([*made, replace(made[2], name="copy")])
    assert any(f"'{made[2].name}', 'copy' hold the same samples" in problem for problem in found.data_problems)


def test_repeats_of_one_commanded_effort_are_no_copies():
    made = recordings(seed=3)
    moved = made[2].channels["position_rad"] + 0.002 * np.sin(made[2].channels["time_s"])
    repeat = replace(made[2], name="repeat", channels={**made[2].channels, "position_rad": moved})
    assert not any("same samples" in problem for problem in diagnosed([*made, repeat]).data_problems)


def test_rows_that_go_one_way_only():
    time_s = np.arange(0, 20, 0.005)
    torque = 0.1 + 0.005 * np.random.default_rng(1).standard_normal(len(time_s))
    one_way = Recording("r", "x", {}, {"time_s": time_s, "position_rad": 2 * time_s, "torque_n_m": torque})
    found = diagnosed([one_way])
    assert found.verdict == "nothing"


def test_a_long_recording_is_answered_in_time():
    made = recordings(bench=Bench(duration_s=200.0, rate_hz=400.0), trials=plans((0.2,))[1:2], seed=3)
    assert len(made[0]) == 80_000  # a square of them, of 8 bytes each, is 50 GB
    assert diagnosed(made).verdict == "nothing"


@pytest.mark.parametrize(("missing", "turned"), [(0.0, True), (0.16, False)], ids=["small beside it", "as large"])
def test_a_small_effort_of_the_other_sign_is_no_turned_one_where_as_much_is_missing_anywhere(missing, turned):
    slow = Plan("slow", [(3.0, 0.01, -0.4)])

    def law(x: Truth) -> np.ndarray:
        return missing * np.sin(9.0 * x.q) if x.load_kg else np.full_like(x.q, -0.07)

    joint = Joint(arm_moment=0.0, coulomb=0.02, static_excess=0.0, viscous=0.01, extra=law)
    made = recordings(joint, trials=[*plans((0.1, 0.25)), slow], seed=3)
    found = fatal_problems(fit_model(make_dataset(made, FACTS, Processing()), default_effects(FACTS)))
    assert any("trial 'slow' has the other sign" in problem for problem in found) == turned
