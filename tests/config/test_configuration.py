"""bench.toml, in and out of order."""

import pytest

from bench.config.configuration import (
    default_configuration,
    parse_configuration,
    preset_configuration,
    read_configuration,
)
from bench.config.quantities import unit_of
from bench.control.drive_factory import make_equipment
from bench.errors import ConfigurationError
from tests.paths import EXAMPLES


def test_the_default_is_the_simulated_bench_of_the_paper():
    configuration = default_configuration()
    assert configuration.name == "paper"
    assert configuration.drive.kind == "sim"
    assert make_equipment(configuration).drive.describe().simulated


def test_the_example_is_the_default():
    assert read_configuration(EXAMPLES / "paper" / "bench.toml") == default_configuration()


def test_a_rig_may_stand_in_its_own_file(tmp_path):
    (tmp_path / "rig.toml").write_text('name = "mine"\n[gear]\nratio = 30\n')
    (tmp_path / "bench.toml").write_text('name = "b"\nrig = "rig.toml"\n')
    assert read_configuration(tmp_path / "bench.toml").rig.gear.ratio == 30


@pytest.mark.parametrize("rig", sorted(EXAMPLES.glob("*/rig.toml")), ids=lambda path: path.parent.name)
def test_a_rig_file_in_place_of_a_bench_is_called_so(rig, tmp_path):
    with pytest.raises(ConfigurationError, match=r"is a rig file.*wanted is the file of a bench") as caught:
        read_configuration(rig)
    assert len(str(caught.value).splitlines()) == 1
    (tmp_path / "bench.toml").write_text("[limits]\nspeed_rad_s = 1.0\n[gear]\nratio = 30\n")
    with pytest.raises(ConfigurationError, match="gear: unknown key"):
        read_configuration(tmp_path / "bench.toml")


WRONG = [
    ("[limits]\nspeed_rad_s = -1", "limits.speed_rad_s: found -1; should be greater than 0 rad/s"),
    ("[limits]\nspeed_rad_s = 'fast'", "limits.speed_rad_s: found 'fast'; should be a valid number"),
    ("[limits]\nspeed_rads = 1", "limits.speed_rads: unknown key; did you mean 'speed_rad_s'? (allowed: "),
    ("[limits]\ncurrent_a = inf", "limits.current_a: found inf; should be a finite number"),
    ("[limits]\nposition_min_rad = 3", "limits: found"),
    ("[rig.arm]\ncentre_of_mass_m = nan", "rig.arm.centre_of_mass_m: found nan; should be a finite number"),
    ("[control]\nperiod_s = 0.2", "control.period_s: found 0.2; should be less than or equal to 0.1 s"),
    ("[rig.motor]\nresistance_ohm = -8.0", "rig.motor.resistance_ohm: found -8.0; should be greater than 0 ohm"),
    ("[drive]\nkind = 'can'", "drive: found {'kind': 'can'}; kind should be one of sim, "),
    ("[drive]\nseed = -1", "drive.seed: found -1; should be greater than or equal to 0"),
]


@pytest.mark.parametrize(("text", "message"), WRONG)
def test_errors_name_file_key_value_bound_and_unit(tmp_path, text, message):
    path = tmp_path / "bench.toml"
    path.write_text(f'name = "b"\n[rig]\nname = "r"\n{text}\n')
    with pytest.raises(ConfigurationError) as caught:
        read_configuration(path)
    assert str(caught.value).startswith(f"{path}: {message}")


def test_every_problem_is_told_at_once():
    with pytest.raises(ConfigurationError) as caught:
        parse_configuration({"limits": {"speed_rad_s": 0, "current_a": 0}}, "bench.toml")
    assert len(str(caught.value).splitlines()) == 4  # both limits, name and rig


def test_a_file_that_is_not_there_or_no_toml(tmp_path):
    with pytest.raises(ConfigurationError, match="No such file"):
        read_configuration(tmp_path / "bench.toml")
    (tmp_path / "bench.toml").write_text("name = ")
    with pytest.raises(ConfigurationError, match="is no TOML"):
        read_configuration(tmp_path / "bench.toml")


def test_an_unknown_preset_names_those_there_are():
    with pytest.raises(ConfigurationError, match="known are paper"):
        preset_configuration("papers")


def with_drive(**changes):
    configuration = default_configuration()
    return configuration.model_copy(update={"drive": configuration.drive.model_copy(update=changes)})


def test_the_plant_may_differ_from_its_preset():
    drive = make_equipment(with_drive(plant={"encoder": {"counts_per_turn": 1024}})).drive
    usual = make_equipment(default_configuration()).drive
    finer, coarser = (d.describe().resolution["position_rad"] for d in (usual, drive))
    assert coarser == pytest.approx(4 * finer)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"preset": "papers"}, "papers"),
        ({"plant": {"encoder": {"counts": 1}}}, "counts"),
        ({"plant": {"gear": {"ratio": 0.0}}}, "ratio"),
    ],
)
def test_an_impossible_plant_is_refused(changes, message):
    with pytest.raises(ConfigurationError, match=message):
        make_equipment(with_drive(**changes))


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("speed_rad_s", "rad/s"),
        ("integral_a_rad_s", "A/(rad s)"),
        ("derivative_a_s_rad", "A s/rad"),
        ("back_emf_v_s_rad", "V s/rad"),
        ("torque_constant_n_m_a", "N m/A"),
        ("rotor_inertia_kg_m2", "kg m2"),
        ("loads_kg", "kg"),
        ("settled_cycles", "cycles"),
        ("repeats", ""),
    ],
)
def test_the_unit_of_a_name_is_its_longest_ending(name, unit):
    assert unit_of(name) == unit


def test_a_gain_without_bounds_is_refused():
    with pytest.raises(ConfigurationError, match=r"servo.proportional_a_rad: found inf; should be a finite number"):
        parse_configuration(
            {"name": "x", "rig": {"name": "x"}, "servo": {"proportional_a_rad": float("inf")}}, "bench.toml"
        )


@pytest.mark.parametrize("text", ["period_s = " + "9" * 5000, "x = " + "[" * 5000])
def test_a_file_beyond_any_use_is_refused_with_its_name(tmp_path, text):
    file = tmp_path / "bench.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"bench\.toml: is no TOML"):
        read_configuration(file)
