"""Where a result comes from."""

import json
from pathlib import Path

import pytest
from pydantic import BaseModel

from bench import provenance as provenance_module
from bench.provenance import provenance, software
from drivers.contract import Description, Mode


class Place(BaseModel):
    url: str


class Configuration(BaseModel):
    name: str = "bench 3"
    arm_m: float | None = None
    store: Place = Place(url="sqlite:////home/ada/private.sqlite")


DRIVE = Description(
    device="can0 node 5",
    vendor="v",
    product="p",
    firmware="1.2",
    serial="s",
    simulated=False,
    modes=frozenset({Mode.DUTY, Mode.CURRENT}),
    measured=frozenset({"position_rad", "duty"}),
    resolution={"position_rad": 1e-4},
    max_rate_hz=1000.0,
    watchdog_s=0.1,
)


def test_it_is_json_and_says_what_was_used() -> None:
    found = json.loads(json.dumps(provenance(Configuration(), DRIVE, seed=7), allow_nan=False))
    assert found["software"]["version"]
    assert found["software"]["libraries"]["numpy"]
    assert found["configuration"] == {"name": "bench 3"}
    assert found["drive"]["firmware"] == "1.2"
    assert found["drive"]["modes"] == ["current", "duty"]
    assert found["drive"]["measured"] == ["duty", "position_rad"]
    assert found["seed"] == 7


def test_what_is_not_known_is_left_out() -> None:
    assert set(provenance()) == {"software"}


def test_nothing_about_the_user_of_the_machine_is_told() -> None:
    text = json.dumps(provenance(Configuration(), DRIVE))
    assert "/home" not in text
    assert str(Path.cwd()) not in text


def test_the_commit_is_named_in_a_checkout_only(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(provenance_module, "_ROOT", tmp_path)
    assert provenance_module._commit() == {}
    (tmp_path / ".git").mkdir()  # a folder that git does not take for a checkout of its own
    assert provenance_module._commit() == {}


def test_the_caller_may_change_what_it_got() -> None:
    software()["version"] = "changed"
    software()["libraries"].clear()
    assert software()["version"] != "changed"
    assert software()["libraries"]
