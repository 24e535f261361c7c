"""A bench.toml that no bench can have: refused before anything moves, with parameter, value, unit and the law."""

from math import inf, nan
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from bench.config.configuration import default_configuration
from bench.store import Store
from tests.cli.conftest import Command

REFUSED = 3
STOP = {"present": True, "upper_rad": 1.0}

CASES: list[tuple[str, dict[str, Any], str]] = [
    (
        "drive.plant.friction",
        {"static_n_m": 0.001},
        "Friction.static_n_m = 0.001 [N m]: static friction is never below",
    ),
    ("drive.plant.gear", {"backlash_rad": -0.01}, "Gear.backlash_rad = -0.01 [rad at the joint, total]: must be at"),
    ("drive.plant.gear", {"ratio": 0.0}, "Gear.ratio = 0.0 [motor turns per joint turn]: must be greater than 0"),
    ("drive.plant.gear", {"ratio": 1e200}, "Gear.ratio = 1e+200 [motor turns per joint turn]: a finite number"),
    ("drive.plant.gear", {"stiffness_n_m_rad": 1e9}, "too coarse for Gear.stiffness_n_m_rad = 1e+09 [N m/rad]"),
    ("drive.plant.motor", {"resistance_ohm": nan}, "Motor.resistance_ohm = nan [ohm]: a finite number is wanted"),
    ("drive.plant.motor", {"rotor_inertia_kg_m2": -1e-5}, "Motor.rotor_inertia_kg_m2 = -1e-05 [kg m2]: must be"),
    ("drive.plant.friction", {"stribeck_rad_s": 0}, "Friction.stribeck_rad_s = 0 [rad/s]: must be greater than 0"),
    ("drive.plant.overload", {"peak_a": 0}, "Overload.peak_a = 0 [A]: must be greater than 0"),
    ("drive.plant.encoder", {"counts_per_turn": 0}, "Encoder.counts_per_turn = 0 [counts per motor turn]: must be at"),
    ("drive.plant.heat", {"present": True, "winding_j_k": 0}, "Heat.winding_j_k = 0 [J/K]: must be greater than 0"),
    ("drive.plant.heat", {"present": True, "winding_j_k": 1e-9}, "too coarse for heat.winding_j_k = 1e-09 [J/K]"),
    ("drive.plant.end_stops", {"lower_rad": 1.0, "upper_rad": -1.0}, "EndStops.lower_rad = 1.0 [rad]: the arm rests"),
    (
        "drive.plant",
        {"end_stops": STOP, "wall": {"present": True, "angle_rad": 2.0}},
        "the wall at 2 rad lies beyond it",
    ),
    ("drive.plant.arm", {"centre_of_mass_m": 0.5}, "Arm.inertia_kg_m2 = 0.01 [kg m2 about the axis]: a mass of 0.3 kg"),
    ("drive.plant.gaer", {"ratio": 20.0}, "unknown key 'gaer'; did you mean 'gear'?"),
    ("drive", {"preset": "papers"}, "preset 'papers' is unknown; known are paper"),
    ("rig.gear", {"ratio": 0.0}, "rig.gear.ratio: found 0.0"),
    ("rig.gear", {"backlash_rad": -0.01}, "rig.gear.backlash_rad: found -0.01"),
    ("rig.motor", {"resistance_ohm": inf}, "rig.motor.resistance_ohm: found inf"),
    ("rig.sensor", {"counts_per_turn": 0}, "rig.sensor.counts_per_turn: found 0"),
    ("limits", {"current_a": 0.0}, "limits.current_a: found 0.0"),
    ("limits", {"position_min_rad": 2.0, "position_max_rad": -2.0}, "position_min_rad must be below"),
    ("control", {"period_s": 0.0}, "control.period_s: found 0.0"),
]


@pytest.mark.parametrize(("table", "values", "message"), CASES)
def test_an_impossible_rig_is_refused(
    command: Command, tmp_path: Path, table: str, values: dict[str, Any], message: str
) -> None:
    tables = default_configuration().model_dump(mode="json", exclude_none=True)
    place = tables
    for name in table.split("."):
        place = place.setdefault(name, {})
    place |= values
    (tmp_path / "bench.toml").write_text(tomli_w.dumps(tables), encoding="utf-8")
    ran = command("--config", "bench.toml", "--store", "sqlite:///kept.sqlite", "run", "steps", "--repeats", 1)
    assert (ran.exit_code, message in " ".join(ran.stderr.split())) == (REFUSED, True), ran.output
    with Store.open("sqlite:///kept.sqlite") as store:
        assert not store.trials()
