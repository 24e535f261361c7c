"""What an unknown column could be meant to be."""

import pytest

from bench.recording_set import Mapping
from bench.recording_set.text.columns import _UNITS, suggestion
from bench.recording_set.text.toml_file import parse_toml
from bench.recording_set.units import ENDINGS, unit_named
from compensator.lab.recordings.recording import CHANNELS


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("position_deg", 'columns.position_rad = { from = "position_deg", scale = 0.01745329252 }'),
        ("velocity_rpm", 'columns.velocity_rad_s = { from = "velocity_rpm", scale = 0.1047197551 }'),
        ("velocity_deg_s", 'columns.velocity_rad_s = { from = "velocity_deg_s", scale = 0.01745329252 }'),
        ("current_mA", 'columns.current_a = { from = "current_mA", scale = 0.001 }'),
        ("time_ms", 'columns.time_s = { from = "time_ms", scale = 0.001 }'),
        ("duty_percent", 'columns.duty = { from = "duty_percent", scale = 0.01 }'),
        ("position_mm", 'columns.position_m = { from = "position_mm", scale = 0.001 }'),
        ("torque_enabled", "is enabled meant?"),
        ("position", "is position_rad or position_m meant?"),
        ("positon_rad", "is position_rad"),
        ("Duty", "is duty meant?"),
    ],
)
def test_near_names_are_suggested(name: str, expected: str) -> None:
    assert expected in suggestion(name)


@pytest.mark.parametrize("name", ["position_deg", "torque_enabled"])
def test_what_is_suggested_is_a_mapping(name: str) -> None:
    text = suggestion(name).partition("mapping: ")[2]
    assert [column.source for column in parse_toml(text.encode(), Mapping, "mapping.toml").columns.values()] == [name]


def test_far_names_suggest_nothing() -> None:
    assert suggestion("humidity") == ""


def test_every_unit_leads_to_a_unit_of_a_channel() -> None:
    endings = {ENDINGS[unit.si] for unit in _UNITS.values()}
    assert all(any(name.endswith(ending) for name in CHANNELS) for ending in endings)


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ("percent", "%"),
        ("pct", "%"),
        ("rad per s", "rad/s"),
        ("permille", "permille"),
        ("U/min", "rpm"),
        ("°/s", "deg/s"),
    ],
)
def test_a_unit_has_the_names_that_people_give_it(said, name):
    found = unit_named(said)
    assert found is not None
    assert found.name == name
