"""The queue of a laboratory in either database: an item goes to one bench that fits, and comes back unless it began."""

from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import pytest

from bench.store import Store
from bench.store.errors import NotFoundError, StoreStateError
from bench.store.tables import lab_queue
from bench.store.tables.lab_queue import GIVEN_UP, NewLabItem, Taker

ONE = Taker("bench 1", "gear", frozenset({"torque sensor", "warm"}))
OTHER = Taker("bench 2", "screw", frozenset())


@pytest.fixture
def lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every bench counts as lost at once."""
    monkeypatch.setattr(lab_queue, "LOST_S", -1.0)


def test_an_item_goes_to_the_first_bench_that_fits(store: Store) -> None:
    queue = store.lab_queue
    asked = [
        NewLabItem("steps", {}, for_bench="bench 3"),
        NewLabItem("steps", {}, for_rig="screw"),
        NewLabItem("steps", {"repeats": 2}, for_tags=["warm"], asked_by="Ada"),
        NewLabItem("steps", {}),
    ]
    third, screw, warm, any_ = queue.add(asked)
    found = queue.take(ONE)
    assert found is not None
    assert (found.id, found.state, found.bench, found.asked_by) == (warm, "taken", "bench 1", "Ada")
    assert found.parameters == {"repeats": 2}
    assert abs(found.silent_s or 0.0) < 5.0
    taken = [item.id if (item := queue.take(taker)) else None for taker in (OTHER, OTHER, OTHER, ONE)]
    assert taken == [screw, any_, None, None]
    assert [one.id for one in queue.items("waiting")] == [third]
    assert [one.id for one in queue.items(bench="bench 2")] == [screw, any_]


def test_many_benches_at_once_never_take_the_same(store: Store) -> None:
    ids = store.lab_queue.add([NewLabItem("steps", {"number": number}) for number in range(24)])

    def take_all(number: int) -> list[int]:
        found = []
        while (item := store.lab_queue.take(Taker(f"bench {number}", "", frozenset()))) is not None:
            found.append(item.id)
        return found

    with ThreadPoolExecutor(6) as pool:
        taken = Counter(item for found in pool.map(take_all, range(6)) for item in found)
    assert taken == Counter(ids)


def test_what_its_bench_has_not_begun_comes_back_when_it_is_lost(store: Store, lost: None) -> None:
    queue = store.lab_queue
    queue.add([NewLabItem("steps", {})])
    first = queue.take(ONE)
    second = queue.take(OTHER)
    assert first is not None
    assert second is not None
    assert (second.id, second.bench) == (first.id, "bench 2")
    # the first comes back, and finds that it may not start any more
    assert not queue.renew(first.claim)
    assert not queue.begin(first.claim)
    assert not queue.give_back(first.claim)
    assert queue.begin(second.claim)
    assert not queue.begin(second.claim)  # once
    assert queue.take(ONE) is None  # what has begun is never given out again


def test_an_end_is_kept_with_the_experiment(store: Store) -> None:
    queue = store.lab_queue
    [item_id] = queue.add([NewLabItem("steps", {})])
    taken = queue.take(ONE)
    assert taken is not None
    assert queue.begin(taken.claim)
    assert queue.finish(taken.claim, "tripped", "too fast", 7)
    assert not queue.finish(taken.claim, "completed", "", 7)
    (found,) = queue.ended(5)
    assert (found.id, found.state, found.reason, found.bench, found.origin_id) == (
        item_id, "tripped", "too fast", "bench 1", 7)  # fmt: skip
    assert (found.experiment_id, found.silent_s) == (None, None)
    assert queue.items("waiting", "taken", "running") == []


def test_a_bench_that_declined_is_not_asked_again(store: Store) -> None:
    queue = store.lab_queue
    queue.add([NewLabItem("steps", {})])
    taken = queue.take(ONE)
    assert taken is not None
    queue.give_back(taken.claim, ONE.name, "load_kg is 5 kg")
    assert queue.take(ONE) is None
    again = queue.take(OTHER)
    assert again is not None
    assert again.declined == {"bench 1": "load_kg is 5 kg"}
    queue.give_back(again.claim)
    assert queue.take(OTHER) is not None


def test_only_what_no_bench_has_is_removed(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    queue = store.lab_queue
    waiting, running = queue.add([NewLabItem("steps", {}, for_bench="bench 3"), NewLabItem("steps", {})])
    taken = queue.take(ONE)
    assert taken is not None
    queue.remove(waiting)
    with pytest.raises(NotFoundError):
        queue.remove(waiting)
    with pytest.raises(StoreStateError, match="bench 'bench 1' has it"):
        queue.remove(running)
    queue.begin(taken.claim)
    monkeypatch.setattr(lab_queue, "LOST_S", -1.0)
    queue.remove(running)  # its bench is lost
    (found,) = queue.ended(1)
    assert (found.state, found.reason) == ("interrupted", GIVEN_UP)
    assert not queue.finish(taken.claim, "completed", "", 1)
    with pytest.raises(StoreStateError, match="it has ended"):
        queue.remove(running)
