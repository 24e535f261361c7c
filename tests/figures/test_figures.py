"""The table of figures, from results made up here; and the rigs that it is measured on."""

from math import isnan, pi, sqrt

import numpy as np
import pytest

from bench.config.configuration import default_configuration
from bench.config.reflected_load import load_current_a
from bench.config.sections import RestSettings
from bench.control.drive_factory import with_seed
from bench.evaluation.figures import rigs
from bench.evaluation.figures.bounds import SLACK, rest_bound_g, stroke_bound_g
from bench.evaluation.figures.coverage import Share, median_interval, reached_by_most, true_load_a
from bench.evaluation.figures.rigs import drawn_rig
from bench.evaluation.figures.table import COLUMNS, figures_table
from bench.evaluation.figures.trials import SeedResults, calibrated, calibrated_at_rest, drawn_loads
from sim_backend.plant.presets import paper

CONFIGURATION = default_configuration()


def results(
    error_kg=2e-4, held=True, search_s=2.0, hanging_a=0.001, ratio=0.05, stroke_kg=4e-4, cycle_kg=1e-3, late_g=40.0,
    calm=20.0,
):  # fmt: skip
    """One seed in which every number is known."""
    truth_a = load_current_a(0.1, pi / 2, CONFIGURATION.rig)
    raised = {
        "load_kg": 0.1,
        "angle_rad": pi / 2,
        "reflected_load_kg": 0.1 + error_kg,
        "load_interval_a": [truth_a - 0.01, truth_a + 0.01] if held else [truth_a + 0.01, truth_a + 0.02],
        "load_current_a": truth_a,
    }
    hanging = {
        **raised,
        "angle_rad": 0.0,
        "reflected_load_kg": None,
        "load_interval_a": None,
        "load_current_a": hanging_a,
    }
    stroke = {
        "mean_error_kg": error_kg,
        "mean_absolute_error_kg": cycle_kg,
        "forward_mean_error_kg": stroke_kg,
        "backward_mean_error_kg": -stroke_kg,
    }
    return SeedResults(
        {
            "loads": {"rows": [raised, hanging]},
            "drawn": {"rows": [raised]},
            "steps": {"spread_ratio": 50.0},
            "speeds": {"rows": [stroke]},
            "sinusoid": {"rms_ratio": ratio},
            "wall": {
                "compensated_late_error_max_g": late_g,
                "compensated_reflected_error_max_g": 239.0,
                "compensated_least_error_max_g": 240.0,
                "compensated_latency_s": 0.02,
                "raw_late_error_max_g": 90.0,
                "compensated_drag_n_m": -0.01,
                "raw_drag_n_m": 0.2,
            },
            "margin": {"compensated_stability_margin": calm, "raw_stability_margin": 2.5},
            "quick": {"rows": [{**raised, "search_s": search_s}]},
            "paper": {"rows": [{**raised, "search_s": 8.0, "reflected_load_kg": 0.1 + 4e-4}]},
        },
        {},
    )


def table(*seeds, drawn=()):
    rows = figures_table(CONFIGURATION, list(seeds), [CONFIGURATION] * len(drawn), list(drawn))
    return {row.name: row for row in rows}


def row(rows, start):
    return next(one for name, one in rows.items() if name.startswith(start))


def test_each_figure_is_taken_from_its_trials():
    rows = table(results())
    assert row(rows, "Table 1, 90 degrees: mean").measured == pytest.approx(0.2)
    assert row(rows, "25 steps").measured == pytest.approx(0.02)
    assert row(rows, "angle 0").measured == pytest.approx(1.0 / 4.903, rel=1e-3)
    assert row(rows, "steady speeds 100").measured == pytest.approx(0.2)
    assert row(rows, "sinusoid").measured == pytest.approx(0.05)
    assert row(rows, "95 %").measured == 100.0
    assert row(rows, "that interval, in the sweep").measured == 100.0
    assert row(rows, "time of a search").measured == pytest.approx(0.25)
    assert row(rows, "error rms of that search").measured == pytest.approx(0.5)
    # a quarter of the time for half of the error
    assert row(rows, "that time at the same accuracy").measured == pytest.approx(0.25 * 0.5**2)
    assert row(rows, "steady speeds, each stroke").measured == pytest.approx(0.4)
    assert row(rows, "steady speeds: largest error of one stroke").measured == pytest.approx(0.4)
    assert row(rows, "steady speeds, every control cycle").measured == pytest.approx(1.0)


def test_a_load_that_hangs_straight_down_is_left_out_of_the_interval_at_90_degrees():
    seed = results(held=False)
    _, hanging = seed.results["loads"]["rows"]
    hanging["load_interval_a"] = [-0.01, 0.01]
    assert row(table(seed), "that interval, in the sweep").measured == 0.0


def test_the_truth_is_where_the_arm_hung_and_not_where_it_was_sent():
    rig = CONFIGURATION.rig
    sent_rad, stood_rad = 0.5, 0.504
    row_there = {"load_kg": 0.1, "angle_rad": sent_rad, "breakaways": [[1.0, 0.3, 0.6, stood_rad]] * 2}
    # the load pulls the arm to the lower side of the free play
    arm_rad = stood_rad - rig.gear.backlash_rad / 2.0
    assert true_load_a(row_there, rig) == pytest.approx(load_current_a(0.1, arm_rad, rig))
    assert true_load_a({**row_there, "breakaways": [[1.0, 0.3, 0.6]]}, rig) == load_current_a(0.1, sent_rad, rig)


def test_a_share_is_as_sure_as_its_trials_are_many():
    # Clopper and Pearson, 95 of 100: 0.8872 .. 0.9836
    assert Share(95, 100).interval() == pytest.approx((0.8872, 0.9836), abs=1e-4)
    assert Share(0, 10).interval() == pytest.approx((0.0, 0.3085), abs=1e-4)
    assert Share(10, 10).interval() == pytest.approx((0.6915, 1.0), abs=1e-4)


def test_the_share_of_all_trials_is_told_with_its_interval():
    found = row(table(results(), results(held=False), drawn=[results()]), "95 %")
    assert found.sure == "1.3 .. 98.7 (2)"
    assert found.rigs_sure == "2.5 .. 100.0 (1)"
    assert row(table(results()), "sinusoid").sure == "-"


def test_the_median_lies_between_two_of_the_ordered_numbers():
    # of 20 the 6th and the 15th: 95.86 % (David and Nagaraja, "Order Statistics", 2003, section 7.1)
    numbers = [float(one) for one in np.random.default_rng(1).permutation(20) + 1]
    assert median_interval(numbers) == (6.0, 15.0)
    assert all(isnan(end) for end in median_interval(numbers[:5]))
    draws = np.random.default_rng(2).exponential(size=(2000, 20))
    held = [low <= np.log(2.0) <= high for low, high in map(median_interval, draws.tolist())]
    assert 0.945 <= np.mean(held) <= 0.97


def test_one_of_ten_may_be_worse_than_what_most_reach():
    numbers = [float(one) for one in np.random.default_rng(1).permutation(20) + 1]
    assert (reached_by_most(numbers, False), reached_by_most(numbers, True)) == (18.0, 3.0)
    assert isnan(reached_by_most([], True))


def test_a_stability_margin_is_told_with_its_median_its_interval_what_most_reach_and_the_worst():
    seeds = [results(calm=2.5 * one) for one in range(1, 11)]
    found = row(table(*seeds, drawn=seeds[:6]), "force scale up to which")
    assert (found.measured, found.sure, found.most_seeds, found.worst_seed) == (5.5, "2 .. 9 (10)", 2.0, 1.0)
    assert (found.rigs_median, found.rigs_sure, found.most_rigs, found.rigs_worst) == (3.5, "1 .. 6 (6)", 1.0, 1.0)


def test_the_largest_error_at_a_wall_stands_beside_what_bounds_it():
    rows = list(table(results()).values())
    place = next(place for place, one in enumerate(rows) if one.name == "wall, reflected: largest error at any moment")
    literal, bound = rows[place : place + 2]
    assert (literal.measured, literal.asked, literal.reached) == (239.0, "at most 60", False)
    assert (bound.name, bound.measured) == ("bound of it: the truth itself, a cycle late", 240.0)


def test_loads_and_angles_are_drawn_anew_with_each_seed_and_never_straight_down():
    one, again, other = drawn_loads(1), drawn_loads(1), drawn_loads(2)
    assert one == again != other
    assert all(0.25 <= abs(angle_rad) <= pi / 2 for angle_rad in one.parameters["angles_rad"])
    assert all(0.0 <= load_kg <= 0.1 for load_kg in one.parameters["loads_kg"])


def test_the_mean_of_the_seeds_and_the_worst_of_them():
    rows = table(results(2e-4), results(-6e-4))
    mean, largest = row(rows, "Table 1, 90 degrees: mean"), row(rows, "Table 1, 90 degrees: largest")
    assert (mean.measured, mean.worst_seed) == pytest.approx((0.4, 0.6))
    assert largest.measured == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("start", "wrong"),
    [
        ("Table 1, 90 degrees: mean", {"error_kg": 5e-4}),
        ("Table 1, 90 degrees: largest", {"error_kg": -1.1e-3}),
        ("angle 0", {"hanging_a": -0.006}),
        ("steady speeds 100", {"error_kg": 9e-4}),
        ("steady speeds, each stroke", {"stroke_kg": 9e-4}),
        ("steady speeds, every control cycle", {"cycle_kg": 1.6e-3}),
        ("sinusoid", {"ratio": 0.13}),
        ("wall, reflected: largest error that", {"late_g": 61.0}),
        ("time of a search", {"search_s": 4.1}),
        ("95 %", {"held": False}),
    ],
)
def test_what_is_not_reached_is_said(start, wrong):
    good = [results(), *([results(held=False)] if start != "95 %" else [])]
    assert row(table(results(**wrong)), start).reached is False
    assert start == "95 %" or row(table(*good), start).reached is True


def test_a_wall_tells_the_compensated_load_from_the_raw_current():
    rows = table(results())
    assert row(rows, "wall, reflected: delay").measured == pytest.approx(20.0)
    assert row(rows, "wall: torque that drives the hand on").measured == pytest.approx(0.01)
    assert row(rows, "the same of the raw current").measured == pytest.approx(-0.2)
    assert row(rows, "wall, raw current").measured == 90.0


def test_a_stability_margin_tells_the_compensated_load_from_the_raw_current():
    alike = results()
    alike.results["margin"]["raw_stability_margin"] = 20.0
    found = row(table(results()), "force scale up to which")
    assert (found.measured, found.asked, found.reached) == (8.0, "at least 1.5", True)
    assert row(table(alike), "force scale up to which").reached is False
    assert row(table(results()), "the force scale itself, raw").measured == 2.5


def test_a_drawn_rig_may_err_by_more_where_the_table_says_so():
    found = row(table(results(), drawn=[results(stroke_kg=1.1e-3), results(stroke_kg=1.3e-3)]), "steady speeds, each")
    assert found.asked == "at most 0.5; drawn rigs 1.2"
    assert found.rigs_reached == 0.5


def test_too_many_held_intervals_are_no_success_either():
    assert row(table(results()), "95 %").reached is False


def test_drawn_rigs_are_summed_up_by_median_worst_and_share():
    drawn = [results(1e-4), results(3e-4), results(9e-4), SeedResults({}, {"everything": "not calibrated"})]
    found = row(table(results(), drawn=drawn), "Table 1, 90 degrees: mean")
    assert (found.rigs_median, found.rigs_worst) == pytest.approx((0.3, 0.9))
    assert found.rigs_reached == pytest.approx(2 / 3)
    assert found.rigs == 3


def test_what_was_not_measured_is_no_number():
    found = row(table(SeedResults({}, {"steps": "did not settle"})), "25 steps")
    assert isnan(found.measured)
    assert found.reached is False
    assert len(found.cells()) == len(COLUMNS)


def test_rigs_are_drawn_within_what_is_said_and_again_the_same():
    for seed in range(40):
        one, again = drawn_rig(CONFIGURATION, seed), drawn_rig(CONFIGURATION, seed)
        assert one == again
        plant = one.drive.plant
        assert 0.5 <= plant["friction"]["static_n_m"] / 5e-3 <= 2.0
        assert 0.0 <= one.rig.gear.backlash_rad == plant["gear"]["backlash_rad"] <= 0.03
        assert abs(plant["coulomb_asymmetry"]["fraction"]) <= 0.2
        assert (
            one.rig.sensor.counts_per_turn == plant["encoder"]["counts_per_turn"] in {2**bits for bits in range(10, 15)}
        )


def test_the_friction_that_is_drawn_round_is_that_of_the_paper_rig():
    plant = paper()
    for name, value in rigs.DRIVE_SIDE.items():
        assert getattr(plant.friction, name) == value
    for name, value in rigs.ARM_SIDE.items():
        assert getattr(plant.arm_friction, name) == value
    assert plant.gear.backlash_rad == rigs.GAP_RAD


def test_scatter_of_friction_bounds_the_mean_of_breakaways():
    rest = RestSettings(scatter=0.02, floor_a=1e-9)
    rows = [
        {"friction_current_a": 0.2, "min_current_a": -0.2, "max_current_a": 0.2, "breakaways": [[1.0, 0.2, 0.1]] * 16}
    ]
    per_g_a = load_current_a(1e-3, pi / 2, CONFIGURATION.rig)
    bound_g = rest_bound_g(rows, CONFIGURATION.model_copy(update={"rest": rest}))
    assert bound_g == pytest.approx(sqrt(2.0 / pi) * 0.02 * 0.2 / 4.0 / per_g_a)
    assert rest_bound_g(rows, CONFIGURATION) is None
    assert rest_bound_g([], CONFIGURATION.model_copy(update={"rest": rest})) is None


def test_twice_the_free_play_hides_twice_the_acceleration():
    def with_play(play_rad):
        gear = CONFIGURATION.rig.gear.model_copy(update={"backlash_rad": play_rad})
        return CONFIGURATION.model_copy(update={"rig": CONFIGURATION.rig.model_copy(update={"gear": gear})})

    count_rad = 2.0 * pi / 4096 / 20
    one, two = (stroke_bound_g(with_play(play_rad)) for play_rad in (0.01, 0.02 + count_rad))
    assert two == pytest.approx(2.0 * one)
    assert stroke_bound_g(with_play(None)) is None


def test_second_differences_of_an_unknown_place_spread_as_the_bound_says():
    places = np.random.default_rng(3).uniform(-0.5, 0.5, size=(3, 200_000))
    spread = np.std(4.0 * (places[0] - 2.0 * places[1] + places[2]))
    assert spread == pytest.approx(SLACK, rel=0.01)


def test_a_calibration_at_rest_tells_the_same_as_the_whole_one():
    bench = with_seed(drawn_rig(CONFIGURATION, 5), 3)
    assert calibrated_at_rest(bench).rest == calibrated(bench).rest is not None
