"""The kinds of experiment, on the simulated bench of the paper."""

import re
from math import pi

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.config.quantities import unit_of
from bench.config.reflected_load import reflected_load_kg
from bench.config.rig import Arm, Gear, Motor, Rig
from bench.config.sections import RestSettings
from bench.errors import ConfigurationError, LimitError, ParameterError, UnknownKindError
from bench.experiments.registry import KINDS, find_kind, parse_parameters
from tests.experiments.bench_run import Ran

CONFIGURATION = default_configuration()
NEEDED = {"waveform": {"csv": "t_s,position_rad\n0,0\n1,0\n"}}  # what has no default


def _method(name):
    search = CONFIGURATION.search.model_copy(update={"method": name})
    return CONFIGURATION.model_copy(update={"search": search})


@pytest.fixture(scope="module")
def steps():
    return Ran(CONFIGURATION, "steps", repeats=6)


@pytest.fixture(scope="module")
def sweep():
    return Ran(CONFIGURATION, "load-sweep", loads_kg=(0.0, 0.05, 0.1))


@pytest.fixture(scope="module")
def excitation():
    return Ran(CONFIGURATION, "excitation", loads_kg=(0.05,), repeats=1, duration_s=4.0)


@pytest.mark.parametrize("name", ["steps", "sweep", "excitation"])
def test_every_trial_completes_and_ends_at_rest_at_angle_0(name, request):
    ran = request.getfixturevalue(name)
    assert [outcome.outcome for outcome in ran.outcomes] == ["completed"] * len(ran.plans)
    for trial in range(len(ran.plans)):
        assert abs(ran.channel(trial, "position_rad")[-1]) < 0.1


def test_the_uncompensated_current_scatters_and_the_compensated_does_not(steps):
    # Fig. 4: anywhere in the friction band; the compensated one within what friction itself scatters
    assert steps.summary["spread_steady_current_a"] > 0.25
    assert steps.summary["spread_load_current_a"] < 0.025


def test_the_steady_current_lies_within_the_band_that_the_search_finds(steps):
    for outcome in steps.outcomes:
        results = outcome.results
        assert results["min_current_a"] - 0.02 <= results["steady_current_a"] <= results["max_current_a"] + 0.02


def test_the_compensated_current_is_on_record(steps):
    load_a = steps.channel(0, "current_load_a")
    results = steps.outcomes[0].results
    assert np.nanmin(load_a) == np.nanmax(load_a) == results["load_current_a"]
    half_a = steps.channel(0, "current_load_half_width_a")
    widest_a = max(abs(end_a - results["load_current_a"]) for end_a in results["load_interval_a"])
    assert np.nanmin(half_a) == np.nanmax(half_a) == pytest.approx(widest_a)


def test_a_flow_chart_that_tells_no_interval_records_none():
    ran = Ran(_method("paper"), "steps", repeats=1)
    assert np.any(np.isfinite(ran.channel(0, "current_load_a")))
    assert not np.any(np.isfinite(ran.channel(0, "current_load_half_width_a")))


def test_the_phases_of_the_search_are_events(steps):
    details = [detail for _, name, detail in steps.events[0] if name == "search"]
    assert details[:2] == ["stand before a ramp", "ramp"]
    assert details[-1] == "done"


def test_the_flow_chart_of_the_paper_can_be_chosen():
    ran = Ran(_method("paper"), "steps", repeats=2)
    details = [detail for _, name, detail in ran.events[0] if name == "search"]
    assert (details[0], details[-1]) == ("raising the current", "done")
    assert ran.summary["spread_load_current_a"] < 0.025
    assert ran.outcomes[0].results["load_interval_a"] is None  # one breakaway each way shows no scatter


def test_the_improved_search_takes_less_time_and_motion_than_the_flow_chart(steps):
    plain = Ran(_method("paper"), "steps", repeats=1).outcomes[0].results
    for outcome in steps.outcomes:
        assert outcome.results["search_s"] < 0.5 * plain["search_s"]
        assert outcome.results["search_travel_rad"] < 0.5 * plain["search_travel_rad"]


def test_the_interval_of_the_reflected_load_is_given_where_there_is_one(sweep):
    for row in sweep.summary["rows"]:
        assert row["load_interval_a"][0] < row["load_current_a"] < row["load_interval_a"][1]
        if row["reflected_load_kg"] is None:
            assert row["reflected_interval_kg"] is None
        else:
            low_kg, high_kg = row["reflected_interval_kg"]
            assert low_kg < row["reflected_load_kg"] < high_kg


def test_what_known_loads_told_corrects_the_load():
    told = RestSettings(gain=2.0, step_a=0.0, asymmetry=0.0)
    plain = Ran(CONFIGURATION, "steps", repeats=1).outcomes[0].results
    corrected = Ran(CONFIGURATION.model_copy(update={"rest": told}), "steps", repeats=1).outcomes[0].results
    assert corrected["load_current_a"] == pytest.approx(plain["load_current_a"] / 2.0)
    assert corrected["min_current_a"] == plain["min_current_a"]


def test_the_load_is_reflected_better_than_in_the_paper(sweep):
    # Table 1 of the paper: 1.11 g mean, 2.73 g at most
    assert sweep.summary["estimates"] == 6
    assert sweep.summary["mean_absolute_error_kg"] < 1.11e-3
    assert sweep.summary["max_error_kg"] < 2.73e-3


def test_at_angle_0_no_load_is_reflected_and_friction_grows_with_the_load(sweep):
    hanging = [row for row in sweep.summary["rows"] if row["angle_rad"] == 0.0]
    assert all(abs(row["load_current_a"]) < 0.02 for row in hanging)  # of 0.49 A at 90 degrees and 100 g
    assert all(row["reflected_load_kg"] is None for row in hanging)
    friction_a = [row["friction_current_a"] for row in hanging]
    assert friction_a == sorted(friction_a)


def test_f_load_is_near_the_friction_of_the_plant(sweep):
    # preset paper: 0.1 A without load, 2.7 times that with 100 g
    found = {row["load_kg"]: row["friction_current_a"] for row in sweep.summary["rows"] if row["angle_rad"] == 0.0}
    assert found[0.0] == pytest.approx(0.1, rel=0.15)
    assert found[0.1] == pytest.approx(0.27, rel=0.15)


def test_excitation_covers_slow_and_fast_both_ways(excitation):
    velocity = np.concatenate([excitation.channel(trial, "velocity_rad_s") for trial in range(len(excitation.plans))])
    assert velocity.max() > 3.0
    assert velocity.min() < -3.0
    assert np.mean((np.abs(velocity) > 0.02) & (np.abs(velocity) < 0.3)) > 0.05
    assert excitation.summary["max_rms_tracking_error_rad"] < 0.06


def test_conditions_say_what_was_held_constant(excitation):
    conditions = excitation.plans[0].conditions
    assert conditions == {
        "load_kg": 0.05,
        "balanced": False,
        "waveform": conditions["waveform"],
        "repeat": 1,
        "arm_m": 0.5,
    }
    assert len({plan.name for plan in excitation.plans}) == len(excitation.plans)


def test_same_seed_same_bytes_and_another_seed_others():
    def rows(seed):
        drive = CONFIGURATION.drive.model_copy(update={"seed": seed})
        return Ran(CONFIGURATION.model_copy(update={"drive": drive}), "steps", repeats=2).rows

    first, again, other = rows(3), rows(3), rows(4)
    assert [block.tobytes() for block in first] == [block.tobytes() for block in again]
    assert [block.tobytes() for block in first] != [block.tobytes() for block in other]


def test_a_search_without_an_estimate_gives_none_and_says_why():
    search = CONFIGURATION.search.model_copy(update={"ceiling_a": 0.6})
    ran = Ran(CONFIGURATION.model_copy(update={"search": search}), "steps", repeats=1)
    results = ran.outcomes[0].results
    assert "ceiling" in results["search_failure"]
    assert results["load_current_a"] is None
    assert results["reflected_load_kg"] is None
    assert ran.summary == {
        "steps": 1,
        "estimates": 0,
        **{
            f"{what}_steady_current_a": pytest.approx(results["steady_current_a"] if what != "spread" else 0.0)
            for what in ("min", "max", "spread", "mean")
        },
    }


REFUSED = [
    ("steps", {"load_kg": 0.25}, "load_kg is 0.25 kg; allowed is at most 0.1 kg"),
    (
        "steps",
        {"angle_rad": 2.2},
        "angle_rad is 2.2 rad; allowed is -2.05 .. 2.05 rad (the limits less a margin of 0.15 rad)",
    ),
    ("steps", {"fastest_rad_s": 9.0}, "fastest_rad_s is 9 rad/s; allowed is at most 8 rad/s"),
    ("load-sweep", {"loads_kg": [0.0, 0.2]}, "a load of loads_kg is 0.2 kg; allowed is at most 0.1 kg"),
    ("load-sweep", {"angles_rad": [-3.0]}, "an angle of angles_rad is -3 rad"),
    ("excitation", {"amplitude_rad": 3.0}, "amplitude_rad is -3 rad; allowed is -2.1 .. 2.1"),
    ("excitation", {"speed_rad_s": 20.0}, "speed_rad_s is 20 rad/s; allowed is at most 8 rad/s"),
    ("excitation", {"loads_kg": [0.11]}, "a load of loads_kg is 0.11 kg"),
    ("steps", {"slowest_rad_s": 1e-300}, "slowest_rad_s is 1e-300 rad/s: a move of 1.571 rad would take 1.571e+300 s"),
]


@pytest.mark.parametrize(
    ("parameters", "hint"),
    [
        ({"load_kg": 100}, "Are grams meant? 100 g are 0.1 kg"),
        ({"angle_rad": 90}, "Are degrees meant? 90 degrees are 1.571 rad"),
    ],
)
def test_a_value_in_another_unit_is_recognised(parameters, hint):
    kind = find_kind("steps")
    with pytest.raises(LimitError, match=re.escape(hint)):
        kind.refuse(parse_parameters(kind, parameters), CONFIGURATION)


def test_a_configured_motion_without_end_is_refused():
    motion = CONFIGURATION.motion.model_copy(update={"acceleration_rad_s2": 1e-9})
    for name in ("steps", "load-sweep"):
        kind = find_kind(name)
        with pytest.raises(LimitError, match="allowed is at most 600 s"):
            kind.refuse(parse_parameters(kind, {}), CONFIGURATION.model_copy(update={"motion": motion}))


@pytest.mark.parametrize(("name", "parameters", "message"), REFUSED)
def test_what_lies_outside_the_limits_is_refused_before_motion(name, parameters, message):
    kind = find_kind(name)
    with pytest.raises(LimitError) as caught:
        kind.refuse(parse_parameters(kind, parameters), CONFIGURATION)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize("name", KINDS)
def test_a_servo_that_may_ask_for_more_than_the_limit_is_refused(name):
    kind = find_kind(name)
    limits = CONFIGURATION.limits.model_copy(update={"current_a": 1.0})
    with pytest.raises(LimitError, match=r"servo.current_a is 1.6 A; allowed is at most limits.current_a, 1 A"):
        kind.refuse(parse_parameters(kind, NEEDED.get(name, {})), CONFIGURATION.model_copy(update={"limits": limits}))


MALFORMED = [
    ("steps", {"repeats": 0}, "steps: repeats: found 0; should be greater than or equal to 1"),
    ("steps", {"load_kg": "heavy"}, "steps: load_kg: found 'heavy'; should be a valid number"),
    ("steps", {"load_g": 100}, "steps: load_g: unknown key"),
    ("steps", {"load_kg": float("nan")}, "steps: load_kg: found nan"),
    ("steps", {"slowest_rad_s": 5.0}, "steps: the whole: "),
    ("load-sweep", {"loads_kg": []}, "load-sweep: loads_kg: found []"),
    ("load-sweep", {"loads_kg": [-0.1]}, "load-sweep: loads_kg.0: found -0.1; should be greater than or equal to 0"),
    ("excitation", {"waveforms": ["square"]}, "excitation: waveforms: found ['square']; there is no motion 'square'"),
]


@pytest.mark.parametrize(("name", "parameters", "message"), MALFORMED)
def test_malformed_parameters_are_named(name, parameters, message):
    with pytest.raises(ParameterError) as caught:
        parse_parameters(find_kind(name), parameters)
    assert str(caught.value).startswith(message)


def test_an_unknown_kind_names_those_there_are():
    with pytest.raises(UnknownKindError) as caught:
        find_kind("step")
    assert str(caught.value) == f"there is no experiment 'step'; known are {', '.join(KINDS)}"


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_every_parameter_has_a_description_and_the_unit_of_its_name(kind):
    for name, schema in kind.parameters.model_json_schema()["properties"].items():
        assert schema["description"]
        assert schema["unit"] == unit_of(name)


@pytest.mark.parametrize(("name", "ran"), [("steps", "steps"), ("load-sweep", "sweep"), ("excitation", "excitation")])
def test_the_estimated_duration_is_about_right(name, ran, request):
    ran = request.getfixturevalue(ran)
    kind = find_kind(name)
    chosen = {
        "steps": {"repeats": 6},
        "load-sweep": {"loads_kg": (0.0, 0.05, 0.1)},
        "excitation": {"loads_kg": (0.05,), "repeats": 1, "duration_s": 4.0},
    }[name]
    estimated_s = kind.duration_s(parse_parameters(kind, chosen), CONFIGURATION)
    taken_s = sum(outcome.cycles for outcome in ran.outcomes) * CONFIGURATION.control.period_s
    assert 0.5 < estimated_s / taken_s < 2.0


RIG = Rig(name="r", motor=Motor(torque_constant_n_m_a=0.05), gear=Gear(ratio=20.0), arm=Arm(length_m=0.5))


def test_reflected_load_by_hand():
    # 0.5 A * 0.05 N m/A * 20 = 0.5 N m; / (9.80665 * 0.5 * sin 30 deg)
    assert reflected_load_kg(0.5, pi / 6, RIG) == pytest.approx(0.5 / (9.80665 * 0.5 * 0.5))
    assert reflected_load_kg(-0.5, -pi / 6, RIG) == pytest.approx(0.5 / (9.80665 * 0.5 * 0.5))
    assert reflected_load_kg(0.5, 0.0, RIG) is None


def test_the_arms_own_moment_is_not_a_load():
    rig = RIG.model_copy(update={"arm": Arm(length_m=0.5, mass_kg=0.2, centre_of_mass_m=0.25)})
    assert reflected_load_kg(0.0, pi / 2, rig) == pytest.approx(-0.1)


def test_a_rig_that_says_too_little_is_refused():
    with pytest.raises(ConfigurationError, match=r"arm.length_m"):
        reflected_load_kg(0.5, pi / 2, RIG.model_copy(update={"arm": Arm()}))
