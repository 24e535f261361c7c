"""`friction-bench explain` alone on recordings that nobody described: commands of docs/explanation/recordings.md."""

import pytest

from tests.paths import measured


def explained(command, tmp_path, paths, *options):
    return command("explain", *paths, *options, "--html", tmp_path / "report.html")


def effects(found):
    return set(found["ladder"]["rungs"][-1]["effects"]) - set(found["ladder"]["rungs"][0]["effects"])


@pytest.mark.timeout(600)
def test_cogging_of_a_bare_outrunner_behind_the_filter_of_its_drive(command, tmp_path):
    # three turns of the seven that the document takes: enough for the same names, in a quarter of the time
    turns = sorted(measured("odrive").glob("slow2_nocomp_*.csv"))
    found = explained(command, tmp_path, turns, "--counts-per-turn", 8192)
    assert {"cogging", "cogging_orders"} & effects(found)
    assert "effort_filter" in effects(found)
    assert found["ladder"]["rungs"][-1]["held_out"] < 0.15


@pytest.mark.timeout(600)
def test_drag_of_a_free_shaft_that_differs_by_direction(command, tmp_path):
    found = explained(command, tmp_path, [measured("hsm150")])
    assert "viscous_asymmetry" in effects(found)
    assert found["ladder"]["rungs"][-1]["held_out"] < 0.037


@pytest.mark.timeout(600)
def test_the_carriage_of_emps(command, tmp_path):
    found = explained(command, tmp_path, [measured("emps")])
    assert found["ladder"]["rungs"][1]["added"] == "viscous_asymmetry"
    assert found["ladder"]["rungs"][-1]["held_out"] < 0.021
