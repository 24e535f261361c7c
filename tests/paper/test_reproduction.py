"""The paper's page on the simulated bench, with fewer loads and repeats than `friction-bench paper` takes."""

import re
from dataclasses import replace

import pytest

from bench.config.configuration import default_configuration
from bench.evaluation.paper import reproduce, summary
from bench.evaluation.paper.measurements import Plan
from bench.evaluation.paper.row import in_words, spans
from bench.report import write_html
from bench.store import Store
from bench.store.errors import NotFoundError

pytestmark = pytest.mark.timeout(300)  # seconds by itself; a shared machine may take minutes
SWEEP = {"currents_a": (0.3,), "duties": (0.2,), "speeds_rad_s": (0.03, 0.1, 0.3, 0.6, 1.5), "strokes": 3}
SMALL = Plan(
    loads_kg=(0.0, 0.05, 0.1),
    steps=4,
    trials=2,
    speeds_rad_s=(1.0, 3.0),
    periods=1,
    speed_sweep=tuple(SWEEP.items()),
    reaches_rad=(1.2,),
    wall_reaches_rad=(0.83,),
    largest_force_scale=0.5,
)
CONFIGURATION = default_configuration()


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    with Store.open(f"sqlite:///{tmp_path_factory.mktemp('paper') / 'bench.sqlite'}") as opened:
        yield opened


@pytest.fixture(scope="module")
def rows(store):
    return reproduce(CONFIGURATION, store, plan=SMALL)


def ours(rows, name):
    return next(row.ours for row in rows if row.name == name)


def test_every_row_names_the_trials_that_it_was_drawn_from(store, rows):
    known = {trial.id: trial.experiment_id for trial in store.trials()}
    for row in rows:
        assert row.trial_ids, row.name
        assert {known[trial_id] for trial_id in row.trial_ids} == set(row.experiment_ids), row.name
        assert "Drawn from trial" in row.with_source().sentences[-1]


def test_it_is_drawn_again_from_the_store_without_motion(store, rows):
    before = len(store.experiments())
    again = reproduce(CONFIGURATION, store, from_store=True, plan=SMALL)
    assert [row.to_json() for row in again] == [row.to_json() for row in rows]
    assert len(store.experiments()) == before


def test_what_the_store_does_not_hold_is_named(store, rows):
    with pytest.raises(NotFoundError, match="no completed experiment 'steps' with parameters"):
        reproduce(CONFIGURATION, store, from_store=True, plan=replace(SMALL, steps=5))


def test_friction_curves_are_those_of_the_preset(rows):
    # 24 V, 8 ohm, 0.05 V s/rad; without load (60 + 6.25) mA and (2.1 + 0.0625) mA s/rad
    assert ours(rows, "fig-2")["speed_at_500_ma_rpm"] == pytest.approx(1916.0, rel=0.05)
    assert ours(rows, "fig-3")["duty_at_1200_rpm_lightest"] == pytest.approx(0.374, rel=0.03)
    assert ours(rows, "fig-3")["duty_at_1200_rpm_heaviest"] == pytest.approx(0.408, rel=0.03)


def test_compensation_does_what_the_paper_says(rows):
    assert ours(rows, "fig-4")["compensated_spread_ma"] < ours(rows, "fig-4")["spread_ma"] / 15
    assert ours(rows, "fig-7")["largest_compensated_ma"] < 0.05 * ours(rows, "fig-7")["largest_uncompensated_ma"]
    assert ours(rows, "table-1")["max_error_g"] < 2.73
    assert ours(rows, "fig-10")["compensated_max_error_g"] < 0.2 * ours(rows, "fig-10")["uncompensated_max_error_g"]
    assert ours(rows, "fig-11")["compensated_mean_absolute_error_g"] < 4.0
    assert (
        ours(rows, "fig-11")["compensated_max_mean_error_g"]
        < 0.3 * ours(rows, "fig-11")["uncompensated_max_mean_error_g"]
    )
    assert ours(rows, "accelerated")["rms_ratio"] < 0.25
    assert ours(rows, "teleoperation")["error_ratio"] < 0.25
    assert ours(rows, "teleoperation")["calm_up_to_force_scale"] == 0.5
    assert (
        ours(rows, "teleoperation")["wall_compensated_error_rms_g"]
        < 0.7 * ours(rows, "teleoperation")["wall_uncompensated_error_rms_g"]
    )


def test_the_loads_of_table_1_were_not_those_of_the_calibration(store, rows):
    by_name = {row.name: row for row in rows}
    assert not set(by_name["table-1"].trial_ids) & set(by_name["fig-2"].trial_ids)
    swept = store.experiment(by_name["table-1"].experiment_ids[0])
    assert swept.provenance["configuration"]["friction"]["calibration_id"] is not None


def test_the_angle_is_said_where_nothing_is_reflected_and_where_all_is(rows):
    said = {row.name: row.section.sentences[0] for row in rows}
    assert said["fig-7"].startswith("At 0 degrees nothing is to be reflected. ")
    assert said["fig-9"].startswith("At 90 degrees, uncompensated, the current lies anywhere from ")


def test_the_report_holds_every_number_and_asks_nothing_of_the_network(rows, tmp_path):
    write_html(tmp_path / "paper.html", "the paper", [summary(rows), *(row.with_source() for row in rows)])
    page = (tmp_path / "paper.html").read_text(encoding="utf-8")
    for row in rows:
        for name in row.ours:
            assert in_words(name) in page
    assert not re.findall(r'<(?:script|link|img)[^>]+(?:src|href)="', page)


def test_quantities_read_as_words_with_their_unit():
    assert in_words("speed_at_500_ma_rpm") == "speed at 500 mA [rpm]"
    assert in_words("spread_ratio") == "spread ratio"


def test_runs_of_numbers_are_shortened():
    assert spans([3, 1, 2, 5, 6, 9]) == "1 .. 3, 5, 6, 9"
