"""Campaigns: every combination once, in an order that takes the fewest load changes; checked before anything moves."""

from itertools import permutations

import pytest
from pydantic import ValidationError

from bench.config.configuration import default_configuration
from bench.errors import ConfigurationError, LimitError, ParameterError, UnknownKindError
from bench.runs.queue.campaign import Campaign, plan_campaign, read_campaign
from bench.runs.queue.items import fewest_changes, load_changes
from bench.store.tables.queue import NewItem

CONFIGURATION = default_configuration()
GRID = {"speed_rad_s": [0.5, 1.0, 2.0], "load_kg": [0.0, 0.05, 0.1]}


def campaign(**values):
    return Campaign.model_validate({"name": "c", "kind": "reversals", "grid": GRID} | values)


def chosen(plan):
    return [(item.parameters["load_kg"], item.parameters["speed_rad_s"]) for item in plan.items]


def item(*loads_kg):
    return NewItem("steps", {}, loads=[[load_kg, False] for load_kg in loads_kg])


@pytest.mark.parametrize("order", ["as-given", "random", "boustrophedon"])
def test_every_combination_is_run_as_often_as_asked_and_each_load_is_hung_once(order):
    plan = plan_campaign(campaign(order=order, repeats=2), CONFIGURATION)
    wanted = [(load, speed) for load in GRID["load_kg"] for speed in GRID["speed_rad_s"]] * 2
    assert sorted(chosen(plan)) == sorted(wanted)
    assert plan.load_changes == 3


def test_as_given_the_last_changes_fastest_and_loads_slowest():
    plan = plan_campaign(campaign(), CONFIGURATION)
    assert chosen(plan) == [(load, speed) for load in GRID["load_kg"] for speed in GRID["speed_rad_s"]]


def test_a_snake_turns_round_at_each_end():
    plan = plan_campaign(campaign(order="boustrophedon"), CONFIGURATION)
    speeds = [speed for _, speed in chosen(plan)]
    assert speeds == [0.5, 1.0, 2.0, 2.0, 1.0, 0.5, 0.5, 1.0, 2.0]


def test_a_seed_gives_its_order_again_and_another_seed_another():
    first, again, other = (
        chosen(plan_campaign(campaign(order="random", seed=seed, repeats=2), CONFIGURATION)) for seed in (3, 3, 4)
    )
    assert first == again
    assert first != other
    assert first != chosen(plan_campaign(campaign(repeats=2), CONFIGURATION))


def test_the_fewest_load_changes_are_no_more_than_in_any_order():
    items = [item(load_kg) for load_kg in (0.1, 0.0, 0.1, 0.05, 0.0)]
    best = min(load_changes(order) for order in permutations(items))
    assert load_changes(fewest_changes(items)) == best == 3
    assert load_changes(items) == 5


def test_an_item_that_changes_loads_is_followed_by_one_that_begins_where_it_ends():
    ordered = fewest_changes([item(0.0, 0.1), item(0.0), item(0.1)])
    assert [one.loads[0][0] for one in ordered] == [0.0, 0.1, 0.0]
    assert load_changes(ordered) == 3


def test_the_duration_is_that_of_all_items():
    plan = plan_campaign(campaign(repeats=2), CONFIGURATION)
    assert plan.duration_s == pytest.approx(sum(one.duration_s for one in plan.items))
    assert plan.duration_s == pytest.approx(2.0 * plan_campaign(campaign(), CONFIGURATION).duration_s)


@pytest.mark.parametrize(
    ("values", "error", "message"),
    [
        ({"kind": "jump"}, UnknownKindError, "there is no experiment 'jump'"),
        ({"grid": {"load_kg": [0.0, 5.0]}}, LimitError, "load_kg is 5 kg"),
        ({"grid": {"stroke": [1]}}, ParameterError, "campaign 'c', at stroke = 1: reversals: stroke: unknown key"),
    ],
)
def test_one_experiment_that_is_refused_refuses_the_whole(values, error, message):
    with pytest.raises(error, match=message):
        plan_campaign(campaign(**values), CONFIGURATION)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"parameters": {"load_kg": 0.0}}, "load_kg stands in grid and in parameters"),
        ({"grid": {"load_kg": []}}, "grid.load_kg has no values"),
        ({"repeats": 1000}, "9000 experiments; allowed are 1000"),
        ({"order": "sorted"}, "boustrophedon"),
    ],
)
def test_a_malformed_campaign_says_what_is_wrong(values, message):
    with pytest.raises(ValidationError, match=message):
        campaign(**values)


def test_a_file_is_read_and_what_is_wrong_with_it_is_named(tmp_path):
    file = tmp_path / "winter.toml"
    file.write_text('kind = "steps"\ntags = ["cold"]\n[grid]\nload_kg = [0.0, 0.1]\n', encoding="utf-8")
    found = read_campaign(file)
    assert (found.name, found.count, found.tags) == ("winter", 2, ["cold"])
    file.write_text('kind = "steps"\nrepeats = 0\n', encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"winter\.toml: repeats: found 0; should be greater than"):
        read_campaign(file)
    with pytest.raises(ConfigurationError, match="cannot be read"):
        read_campaign(tmp_path / "none.toml")
