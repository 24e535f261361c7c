"""The queue and tags in either database: order, states, several benches in one store."""

from pathlib import Path

import pytest
from sqlalchemy import select

from bench.store import Store
from bench.store.errors import NotFoundError, StoreStateError, StoreValueError
from bench.store.schema import CAMPAIGN
from bench.store.tables.queue import NewItem
from tests.queue.waiting import wait_for


def items(count):
    return [NewItem("steps", {"repeats": number}, loads=[[0.1, False]]) for number in range(count)]


def order(table):
    return [item.parameters["repeats"] for item in table.items("waiting")]


def test_items_keep_their_order_and_are_moved(store: Store) -> None:
    table = store.queue("mine")
    ids = table.add(items(4))
    table.move(ids[3], 1)
    assert order(table) == [0, 3, 1, 2]
    table.begin(ids[0])
    table.move(ids[2], 0)
    assert order(table) == [2, 3, 1]
    table.add(items(1))
    assert order(table) == [2, 3, 1, 0]
    assert table.next().id == ids[2]


def test_a_queue_is_that_of_its_bench(store: Store) -> None:
    mine, theirs = store.queue("mine"), store.queue("theirs")
    [item_id] = mine.add(items(1))
    mine.hold("coffee")
    assert theirs.items() == []
    assert (mine.held(), theirs.held()) == ("coffee", None)
    with pytest.raises(NotFoundError):
        theirs.remove(item_id)
    assert (theirs.clear(), mine.clear()) == (0, 1)


def test_states_follow_one_another(store: Store) -> None:
    table = store.queue("mine")
    first, second = table.add(items(2))
    table.begin(first)
    with pytest.raises(StoreStateError, match="is running"):
        table.begin(first)
    table.began(first, 7)
    table.finish(first, "tripped", "speed is 9 rad/s")
    found = table.item(first)
    assert (found.state, found.reason, found.experiment_id) == ("tripped", "speed is 9 rad/s", 7)
    assert [item.id for item in table.ended(5)] == [first]
    table.begin(second)
    table.give_back(second)
    assert table.next().id == second
    table.hold(None)
    assert table.held() is None


def test_an_item_of_a_living_process_is_left_alone_and_none_runs_beside_it(store: Store, store_url: str) -> None:
    mine = store.queue("mine")
    first, second = mine.add(items(2))
    with Store.open(store_url) as other:
        theirs = other.queue("mine")
        assert theirs.begin(first)
        assert mine.settle() == ([], [first])
        assert not mine.begin(second)
        assert [mine.item(item_id).state for item_id in (first, second)] == ["running", "waiting"]
        assert store.queue("another bench").settle() == ([], [])
        theirs.finish(first, "completed", "")
        assert theirs.begin(second)
    # a server notices some time later that a session is gone, and until then its claim lives
    wait_for(lambda: mine.settle() == ([second], []), timeout_s=10.0)
    assert mine.item(second).state == "interrupted"


def test_nothing_is_left_of_a_process_that_was_killed_beside_an_item(sqlite_url: str, tmp_path: Path) -> None:
    with Store.open(sqlite_url) as store:
        dead = Store.open(sqlite_url)
        [item_id] = dead.queue("mine").add(items(1))
        dead.queue("mine").begin(item_id)
        assert dead.custody._claim is not None
        dead.custody._claim.release(keep_note=True)  # as the operating system does
        assert store.queue("mine").settle() == ([item_id], [])
        assert list(tmp_path.glob("*-owner-*")) == []


def test_a_campaign_is_kept_with_its_items(store: Store) -> None:
    table = store.queue("mine")
    campaign = {"name": "c", "definition": {"kind": "steps"}, "operator": "Ada", "note": "", "tags": ["x"]}
    table.add(items(1))
    ids = table.add(items(2), campaign)
    with store._database.reading() as connection:
        [kept] = connection.execute(select(CAMPAIGN))
    assert (kept.name, kept.definition, kept.tags) == ("c", {"kind": "steps"}, ["x"])
    assert [item.id for item in table.items(campaign_id=kept.id)] == ids


def test_tags_are_found_and_go_with_their_experiment(store: Store) -> None:
    first, second = (store.begin_experiment("steps", {}, "simulated", {}, {}) for _ in range(2))
    store.annotate(first, note="loose", tags=["b", "a", "b"])
    store.annotate(second, tags=["b"])
    assert (store.experiment(first).tags, store.experiment(first).note) == (("a", "b"), "loose")
    assert [one.id for one in store.experiments(tag="b")] == [second, first]
    assert [one.id for one in store.experiments(tag="a")] == [first]
    store.annotate(first, tags=[])
    assert store.experiment(first).tags == ()
    store.finish_experiment(second, "completed")
    store.retention.remove([second])
    assert store.experiments(tag="b") == []


@pytest.mark.parametrize("tags", [[""], [" a"], ["x" * 101], [str(number) for number in range(51)]])
def test_tags_that_cannot_be_kept_are_named(store: Store, tags) -> None:
    experiment_id = store.begin_experiment("steps", {}, "simulated", {}, {})
    store.annotate(experiment_id, tags=["old"])
    with pytest.raises(StoreValueError, match="wanted"):
        store.annotate(experiment_id, tags=tags)
    assert store.experiment(experiment_id).tags == ("old",)


def test_an_experiment_that_is_not_there_has_no_tags(store: Store) -> None:
    with pytest.raises(NotFoundError):
        store.annotate(99, tags=["a"])
