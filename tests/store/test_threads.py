"""One writer and many readers, in one process."""

import threading
import time

import numpy as np

from bench.store import Store
from bench.store.address import database_of
from tests.store.examples import begin, begin_trial, rows


def test_readers_see_whole_blocks_while_a_writer_writes(store: Store) -> None:
    writer = begin_trial(store, begin(store))
    stop = threading.Event()
    seen: list[int] = []
    errors: list[BaseException] = []

    def reads() -> None:
        try:
            while not stop.is_set():
                found = store.samples(writer.trial_id)
                count = len(found["time_s"])
                assert count % 20 == 0
                assert np.array_equal(found["time_s"], np.arange(float(count)))
                seen.append(count)
        except BaseException as error:
            errors.append(error)

    readers = [threading.Thread(target=reads) for _ in range(4)]
    for reader in readers:
        reader.start()
    for block in range(150):
        writer.append(rows(20 * block, 20))
    stop.set()
    for reader in readers:
        reader.join()
    assert errors == []
    assert len(set(seen)) > 3
    assert store.trial(writer.trial_id).rows == 3000


def test_writers_in_several_threads_take_turns(store: Store) -> None:
    experiment_id = begin(store)
    writers = [begin_trial(store, experiment_id, name) for name in "abcd"]

    def writes(index: int) -> None:
        for block in range(40):
            writers[index].append(rows(5 * block, 5))

    threads = [threading.Thread(target=writes, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for writer in writers:
        assert np.array_equal(store.samples(writer.trial_id)["time_s"], np.arange(200.0))


def test_a_reader_does_not_wait_for_a_writer(store: Store, store_url: str) -> None:
    experiment_id = begin(store)
    other = database_of(store_url, 5.0)
    with other.writing():
        started = time.monotonic()
        assert store.experiment(experiment_id).outcome == "running"
        assert time.monotonic() - started < 1.0
    other.close()


def test_two_benches_on_one_store_take_turns(store: Store, store_url: str) -> None:
    errors: list[BaseException] = []

    def begins(opened: Store, kind: str) -> None:
        try:
            experiment_id = begin(opened, kind)
            for number in range(40):  # each reads before it writes: the write lock must be there from the start
                begin_trial(opened, experiment_id, f"{number}").append(rows(0, 5))
        except BaseException as error:
            errors.append(error)

    with Store.open(store_url) as other:
        threads = [threading.Thread(target=begins, args=pair) for pair in ((store, "a"), (other, "b"))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert errors == []
        assert len(store.trials()) == 80
