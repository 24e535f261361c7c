"""The queue in operation, on the simulated bench: in order, held by whatever goes wrong, and after a restart."""

import threading

import pytest

from bench.config.configuration import default_configuration
from bench.control import station
from bench.control.drive_factory import Equipment
from bench.control.technician import PersonTechnician
from bench.errors import BusyError, LimitError
from bench.runs.lease import LeaseHeldError
from bench.runs.queue.conductor import RESTARTED, Conductor
from bench.runs.queue.overview import queue_state
from bench.runs.runner import Runner
from bench.store import Store
from bench.store.errors import NotFoundError, StoreStateError
from bench.store.tables.queue import NewItem
from tests.control.fake_drive import FakeDrive
from tests.queue.waiting import wait_for


def steps(repeats=1, pace="fast", **more):
    return NewItem("steps", {"repeats": repeats}, pace=pace, **more)


SLOW = steps(3, "real-time")


def done(conductor):
    return conductor.running is None and not conductor.table.items("waiting", "running")


def test_items_are_run_one_after_the_other_in_order(conductor, runner, store):
    conductor.add(
        [steps(), NewItem("coast-down", {"speeds_rad_s": [1.0]}, "Ada", "first", ["b", "a"], "fast"), steps()]
    )
    wait_for(lambda: done(conductor))
    assert conductor.held is None
    found = conductor.table.items()
    assert [(item.kind, item.state) for item in found] == [(k, "completed") for k in ("steps", "coast-down", "steps")]
    experiments = [store.experiment(item.experiment_id) for item in found]
    assert [one.kind for one in experiments] == ["steps", "coast-down", "steps"]
    assert (experiments[1].operator, experiments[1].note, experiments[1].tags) == ("Ada", "first", ("a", "b"))
    assert experiments[0].finished_utc <= experiments[1].started_utc
    assert queue_state(conductor, runner).state == "idle"


def test_what_would_be_refused_is_not_taken_in(conductor):
    with pytest.raises(LimitError, match="load_kg is 5 kg"):
        conductor.add([steps(), NewItem("steps", {"load_kg": 5.0})])
    assert conductor.table.items() == []


def test_stop_ends_what_runs_and_holds_the_queue(conductor, runner, store):
    first, second = conductor.add([SLOW, steps()])
    wait_for(lambda: len(runner.live().rows) > 20)
    conductor.stop("cable is caught")
    runner.stop("cable is caught")
    wait_for(lambda: conductor.running is None)
    assert (conductor.table.item(first).state, conductor.table.item(second).state) == ("stopped", "waiting")
    assert conductor.held == "cable is caught"
    assert queue_state(conductor, runner).state == "held"
    conductor.resume()
    wait_for(lambda: done(conductor))
    assert conductor.table.item(second).state == "completed"


def test_stop_with_nothing_running_holds_the_queue_too(conductor, store):
    conductor.stop()
    conductor.add([steps()])
    wait_for(lambda: store.queue("paper").held() == "stopped")
    assert conductor.table.items("waiting")
    assert store.experiments() == []


def test_stop_while_an_item_is_being_started_ends_it(conductor, runner, store, monkeypatch):
    starting, go_on = threading.Event(), threading.Event()
    plain = runner.start

    def slowly(*arguments):
        starting.set()
        assert go_on.wait(20.0)
        return plain(*arguments)

    monkeypatch.setattr(runner, "start", slowly)
    conductor.add([SLOW, steps()])
    assert starting.wait(20.0)
    conductor.stop("wait")
    runner.stop("wait")  # nothing runs yet: it hears nothing
    go_on.set()
    wait_for(lambda: conductor.running is None)
    assert [item.state for item in conductor.table.items()] == ["stopped", "waiting"]


def test_a_trip_holds_the_queue_and_says_why(store):
    plain = default_configuration()
    runner = Runner(plain.model_copy(update={"limits": plain.limits.model_copy(update={"speed_rad_s": 4.2})}), store)
    conductor = Conductor(runner, store)
    conductor.begin()
    conductor.add([NewItem("steps", {"repeats": 1, "slowest_rad_s": 4.0}, pace="fast"), steps()])
    wait_for(lambda: conductor.held is not None)
    found = conductor.table.items()
    assert found[0].state == "tripped"
    assert conductor.held.startswith(f"item {found[0].id} (steps, experiment 1) is tripped: trial 'step-001': speed is")
    assert found[1].state == "waiting"
    conductor.close()
    runner.close()


def test_a_start_that_is_refused_in_the_end_holds_the_queue(conductor, runner, monkeypatch):
    def full(*_arguments):
        raise LimitError("150 MB are free")

    monkeypatch.setattr(runner, "_prepare", full)
    conductor.add([steps(), steps()])
    wait_for(lambda: conductor.held is not None and conductor.running is None)
    assert "was not started: 150 MB are free" in conductor.held
    assert [item.state for item in conductor.table.items()] == ["refused", "waiting"]


def test_a_pause_takes_effect_between_trials_with_the_power_off(conductor, runner, store):
    conductor.add([SLOW])
    wait_for(lambda: len(runner.live().rows) > 5)
    conductor.pause("coffee")
    assert queue_state(conductor, runner).state == "pausing"
    wait_for(lambda: runner.status().pausing == "paused")
    state = queue_state(conductor, runner)
    assert (state.state, state.reason) == ("paused", "coffee")
    experiment_id = runner.status().experiment_id
    [trial] = store.trials(experiment_id)
    assert trial.outcome == "completed"
    assert runner.status().reading.sample.status.name == "ENABLED"  # the last one of the trial; then comes power-off
    assert 0.0 < state.left_s < state.duration_s
    conductor.resume()
    wait_for(lambda: len(store.trials(experiment_id)) == 2)


def test_stop_ends_a_paused_experiment(conductor, runner):
    conductor.add([SLOW])
    wait_for(lambda: runner.status().outcome == "running")
    conductor.pause("coffee")
    wait_for(lambda: runner.status().pausing == "paused")
    runner.stop("enough")
    assert runner.wait(20.0)
    assert (runner.status().outcome, runner.status().reason) == ("stopped", "enough")


def test_a_run_is_waited_for_though_its_start_has_not_come_back(conductor, runner, monkeypatch):
    start, come_back = threading.Thread.start, threading.Event()

    def start_slowly(thread):
        start(thread)
        if thread.name.startswith("experiment"):
            come_back.wait(20.0)

    monkeypatch.setattr(threading.Thread, "start", start_slowly)
    conductor.add([SLOW])
    wait_for(lambda: len(runner.live().rows) > 20)
    runner.stop("enough")
    assert runner.wait(20.0)
    assert runner.status().outcome == "stopped"
    come_back.set()


def test_what_is_added_after_a_pause_stays_also_where_it_was_just_being_looked_for(runner, store, monkeypatch):
    conductor = Conductor(runner, store)
    look, added = conductor.table.next, []

    def while_looking():
        if not added:
            conductor.pause("later")
            added.extend(conductor.add([steps()]))
        return look()

    monkeypatch.setattr(conductor.table, "next", while_looking)
    conductor.begin()
    wait_for(lambda: store.queue("paper").held() == "later")
    conductor.close()
    assert [item.state for item in conductor.table.items()] == ["waiting"]
    assert store.experiments() == []


def test_after_a_restart_the_queue_is_held_and_nothing_moves_until_somebody_resumes(runner, store):
    first = Conductor(runner, store)
    first.begin()
    first.pause("later")
    first.add([steps()])
    first.close()
    store.queue("paper").hold(None)  # as if it had been going on
    again = Conductor(runner, store)
    again.begin()
    wait_for(lambda: store.queue("paper").held() == RESTARTED)
    assert store.experiments() == []
    again.resume()
    wait_for(lambda: done(again))
    assert [item.state for item in again.table.items()] == ["completed"]
    again.close()


def test_what_ran_when_the_process_died_is_as_its_record_says(runner, store):
    table = store.queue("paper")
    ids = table.add([_item()] * 3)
    for item_id in ids:
        table.begin(item_id)
    experiment_id = store.begin_experiment("steps", {}, "simulated", {}, {})
    store.finish_experiment(experiment_id, "interrupted", "killed")
    table.began(ids[0], experiment_id)
    table.began(ids[1], 77)
    conductor = Conductor(runner, store)
    conductor.begin()
    assert conductor.held == RESTARTED
    assert [(one.state, one.reason) for one in table.items()] == [
        ("interrupted", "killed"),
        ("interrupted", "its experiment is not in the store any more"),
        ("interrupted", "the process that ran the queue ended before its experiment was on record"),
    ]
    conductor.close()


def test_a_second_service_leaves_what_the_first_runs_and_waits_for_its_turn(conductor, store, tmp_path):
    first, second = conductor.add([SLOW, steps()])
    wait_for(lambda: conductor.table.item(first).experiment_id is not None)
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as other:
        runner = Runner(default_configuration(), other)
        beside = Conductor(runner, other)
        beside.begin()
        assert (beside.held, beside.table.item(first).state) == (RESTARTED, "running")
        beside.resume()
        wait_for(lambda: beside.elsewhere)
        assert queue_state(beside, runner).reason == f"item {first} of this queue is run by another process"
        wait_for(lambda: done(conductor) and done(beside))
        beside.close()
        runner.close()
    assert [item.state for item in conductor.table.items()] == ["completed", "completed"]
    one, another = (store.experiment(conductor.table.item(item_id).experiment_id) for item_id in (first, second))
    assert one.finished_utc <= another.started_utc


def _item():
    from bench.runs.queue.items import checked_item

    return checked_item(steps(), default_configuration())


def test_an_experiment_beside_the_queue_is_waited_for(conductor, runner):
    runner.start("steps", {"repeats": 1}, pace="real-time")
    conductor.add([steps()])
    with pytest.raises(BusyError):
        runner.start("steps", {})
    assert conductor.table.items("waiting")
    runner.stop()
    wait_for(lambda: done(conductor))
    assert [item.state for item in conductor.table.items()] == ["completed"]


def test_who_has_the_bench_holds_the_queue(runner, store):
    asked = []

    class Held:
        def __init__(self, name):
            asked.append(name)

        def __enter__(self):
            raise LeaseHeldError("the bench is held by Ada", 10.0)

        def __exit__(self, *_error):
            return None

    conductor = Conductor(runner, store, Held)
    conductor.begin()
    conductor.add([steps()], by="bob")
    wait_for(lambda: conductor.held is not None and conductor.running is None)
    assert conductor.held == "the bench is held by Ada"
    assert asked == ["bob"]
    assert conductor.table.items("waiting")
    conductor.close()


def test_moved_removed_cleared(conductor):
    conductor.pause("arrange")
    first, second, third = conductor.add([steps(note=str(number)) for number in (1, 2, 3)])
    conductor.table.move(third, 0)
    assert [item.id for item in conductor.table.items("waiting")] == [third, first, second]
    conductor.table.move(third, 99)
    assert [item.id for item in conductor.table.items("waiting")] == [first, second, third]
    conductor.table.change(second, {"note": "new", "tags": ["x"]})
    assert (conductor.table.item(second).note, conductor.table.item(second).tags) == ("new", ["x"])
    conductor.table.remove(first)
    with pytest.raises(NotFoundError, match=f"item {first} is not in the queue"):
        conductor.table.remove(first)
    assert conductor.table.clear() == 2
    assert conductor.table.items() == []


def test_what_runs_or_has_ended_is_not_changed(conductor):
    [item_id] = conductor.add([steps()])
    wait_for(lambda: done(conductor))
    with pytest.raises(StoreStateError, match=f"item {item_id} is completed; only what waits"):
        conductor.table.remove(item_id)


def test_a_load_that_hangs_is_not_asked_for_again(runner, store, monkeypatch):
    asked = []
    monkeypatch.setattr(
        station,
        "make_equipment",
        lambda _c, _a: Equipment(FakeDrive(), PersonTechnician(lambda s: not asked.append(s))),
    )
    conductor = Conductor(runner, store)
    conductor.begin()
    chirp = {"duration_s": 2.0, "amplitude_rad": 0.02, "high_hz": 2.0}
    orders = [NewItem("chirp", {**chirp, "load_kg": load_kg}) for load_kg in (0.05, 0.05, 0.0)]
    conductor.add(orders)
    wait_for(lambda: done(conductor) or conductor.held)
    assert conductor.held is None
    assert asked == [
        "Hang 50 g at the tip of the arm, and stand clear.",
        "Take every load off the arm, and stand clear.",
    ]
    conductor.pause("somebody goes to the arm")
    wait_for(lambda: store.queue("paper").held() is not None)
    conductor.resume()
    conductor.add(orders[2:])
    wait_for(lambda: done(conductor))
    assert len(asked) == 3
    conductor.close()
