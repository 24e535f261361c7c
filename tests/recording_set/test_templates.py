"""What a guess writes for a user to fill in: every key of a rig, and where the zero of the position lies."""

import re
from pathlib import Path

import pytest

from bench.config.rig import Rig
from bench.recording_set import read_mapping, read_rig
from bench.recording_set.guess import guess_of, mapping_text, rig_text
from bench.recording_set.guess.guess import NOTHING
from tests.paths import ROOT
from tests.recording_set.foreign_files import FILES

EXAMPLE = ROOT / "docs" / "reference" / "recording-set.md"


def filled_in(text: str) -> str:
    """A template without the # before its keys; its remarks stay."""
    return re.sub(r"^# (?=\[|\w+ = )", "", text, flags=re.MULTILINE)


def keys_of(told: dict) -> set[str]:
    return {f"{table}.{key}" for table, values in told.items() if isinstance(values, dict) for key in values}


def test_a_template_has_every_key_of_a_rig_with_a_unit_and_a_value_that_can_be(tmp_path: Path) -> None:
    text = rig_text(Rig(name="my joint"))
    (tmp_path / "rig.toml").write_text(text)
    assert read_rig(tmp_path / "rig.toml") == Rig(name="my joint")  # comments tell nothing
    (tmp_path / "rig.toml").write_text(filled_in(text))
    told = read_rig(tmp_path / "rig.toml").model_dump()
    assert not [key for key in keys_of(told) if told[key.split(".")[0]][key.split(".")[1]] is None]
    assert "# torque_constant_n_m_a = 0.05  # N m/A: Torque constant\n" in text
    assert max(map(len, text.splitlines())) <= 120


def test_what_a_rig_tells_is_kept_among_the_comments(tmp_path: Path) -> None:
    told = {"name": 'a "joint"', "horizontal": True, "motor": {"resistance_ohm": 0.7}, "sensor": {"at": "joint"}}
    rig = Rig.model_validate(told)
    (tmp_path / "rig.toml").write_text(rig_text(rig))
    assert read_rig(tmp_path / "rig.toml") == rig
    assert "# torque_constant_n_m_a" in rig_text(rig)


def test_a_linear_joint_is_not_asked_for_gear_and_arm(tmp_path: Path) -> None:
    rig = Rig(name="carriage", joint="linear")
    text = rig_text(rig)
    (tmp_path / "rig.toml").write_text(text)
    assert read_rig(tmp_path / "rig.toml") == rig
    assert "[motor]" in text
    assert "[arm]" not in text


def test_the_document_shows_every_key() -> None:
    example = filled_in(rig_text(Rig(name="my joint")).partition("what it is.\n")[2])
    assert example in EXAMPLE.read_text(), f"write this into {EXAMPLE}:\n{example}"


@pytest.mark.parametrize("what", ["plain", "german excel, utf-8 mark"])
def test_the_zero_of_the_position_is_explained_where_it_is_mapped(tmp_path: Path, what: str) -> None:
    (tmp_path / "log.csv").write_bytes(FILES[what].data)
    guess, _, _ = guess_of([tmp_path / "log.csv"], None, NOTHING)
    text = mapping_text(guess.mapping, (), guess.files)
    assert "[columns.position_rad]\n# 0 has to be where the arm hangs straight down" in text
    (tmp_path / "mapping.toml").write_text(text)
    assert read_mapping(tmp_path / "mapping.toml") == guess.mapping
    (tmp_path / "mapping.toml").write_text(text.replace("# offset", "offset"))
    moved = read_mapping(tmp_path / "mapping.toml")
    assert moved.columns["position_rad"].offset == 1.5708
    assert "hangs straight down" not in mapping_text(moved)
