"""The hash chain: what is altered, removed, put in or reordered past the store is found, and named."""

from datetime import timedelta
from pathlib import Path
from zlib import crc32

import pytest
from sqlalchemy import text, update

from bench.store import Store
from bench.store.schema import SAMPLE_BLOCK
from bench.store.tables.audit import AuditEntry
from bench.store.tables.experiments import now
from bench.store.tables.samples import columns_of, encode
from bench.store.upkeep.chain_check import broken_chain
from tests.store.examples import begin, begin_trial, rows
from tests.store.flips import count


def entry(number: int, days_ago: float = 0.0) -> AuditEntry:
    return AuditEntry(now() - timedelta(days=days_ago), "ada", "admin", "", "POST", f"/{number}", 200, "")


@pytest.fixture
def full(store: Store) -> Store:
    """Two experiments of two trials, a study of two models, a calibration, a token, three audit entries."""
    for _ in range(2):
        experiment_id = begin(store)
        for name in ("step 1", "step 2"):
            writer = begin_trial(store, experiment_id, name, load_kg=0.1, grease="NLGI 2")
            writer.append(rows(0, 100), [(1.0, "breakaway", "up")])
            writer.finish("completed", "", {"current_a": 0.25})
        store.finish_experiment(experiment_id, "completed")
    study_id = store.create_study("arm", {"trial_ids": [1]})
    store.add_model(study_id, store.add_model(study_id, None, ["coulomb"], {}), ["coulomb", "inertia"], {})
    store.calibrations.choose(
        store.calibrations.add(
            note="", source="real", rig={}, drive={}, provenance={}, experiment_ids=[1], trial_ids=[1], result={}
        )
    )
    store.access.tokens.add("ada", "admin", "d1")
    store.access.audit.add([entry(1), entry(2)])
    store.access.audit.add([entry(3)])
    return store


def problems(store: Store, head: str | None = None) -> list[str]:
    with store._database.reading() as connection:
        return broken_chain(connection, head)


def past_the_store(store: Store, *statements: str) -> None:
    with store._database.writing() as connection:
        for statement in statements:
            connection.execute(text(statement))


def test_what_the_store_does_itself_is_borne_out(full: Store) -> None:
    assert full.upkeep.check() == []
    noted = full.upkeep.info().chain_head
    full.annotate(1, "new grease", ["winter"])
    full.change_study(1, {"trial_ids": [2]})
    full.change_model(2, {"error": 0.5})
    full.remove_model(2)
    full.access.tokens.revoke("ada")
    full.calibrations.unchoose([1])
    full.removal.study(1)
    full.retention.remove([2])
    full.access.audit.add([entry(4, days_ago=40)])
    assert full.access.audit.remove_older(30) == 1
    running = begin(full)
    begin_trial(full, running).append(rows(0, 10))
    assert full.upkeep.check(noted) == []
    full.finish_experiment(running, "stopped")
    assert full.upkeep.check(noted) == []


@pytest.mark.parametrize(
    ("statement", "named"),
    [
        ("UPDATE experiment SET operator = 'Eve' WHERE id = 2", "experiment 2 is not what was kept"),
        ("UPDATE experiment SET results = '{\"a\": 1}' WHERE id = 1", "experiment 1 is not what was kept"),
        ("INSERT INTO experiment_tag VALUES (1, 'good')", "experiment 1 is not what was kept"),
        ("UPDATE trial SET outcome = 'failed' WHERE id = 3", "trial 3 is not what was kept"),
        ("UPDATE trial_condition SET number = 0.2 WHERE trial_id = 4", "trial 4 is not what was kept"),
        ("UPDATE event SET time_s = 2.0 WHERE trial_id = 2", "trial 2 is not what was kept"),
        ("DELETE FROM event WHERE trial_id = 2", "trial 2 is not what was kept"),
        ("UPDATE model SET effects = '[]' WHERE id = 2", "model 2 is not what was kept"),
        ("UPDATE study SET name = 'leg' WHERE id = 1", "study 1 is not what was kept"),
        ("UPDATE calibration SET result = '{\"a\": 1}'", "calibration 1 is not what was kept"),
        ("UPDATE access_token SET role = 'viewer'", "access token 1 is not what was kept"),
        ("UPDATE audit SET token = 'eve' WHERE id = 2", "audit 2 is not what was kept"),
        ("DELETE FROM audit WHERE id = 3", "audit 3 is gone: removed past the store"),
        ("DELETE FROM trial WHERE id = 4", "trial 4 is gone: removed past the store"),
        ("DELETE FROM model WHERE id = 2", "model 2 is gone: removed past the store"),
        (
            "INSERT INTO audit SELECT 9, at_utc, token, role, client, method, path, status, detail FROM audit "
            "WHERE id = 1",
            "audit 9 was put in past the store",
        ),
        ("DELETE FROM chain WHERE id = 4", "chain: entry 4 is gone"),
        ("DELETE FROM chain WHERE id = 1", "chain: entry 1 is gone"),
        ("UPDATE chain SET digest = 'aa' WHERE id = 1", "chain: entry 1 (trial 1) is not what was written"),
    ],
)
def test_what_is_done_past_the_store_is_found_and_named(full: Store, statement: str, named: str) -> None:
    past_the_store(full, statement)
    assert any(problem.startswith(named) for problem in problems(full)), problems(full)


def test_samples_altered_with_their_checksum_are_found(full: Store) -> None:
    """The checksum is against accidents: who alters the data on purpose renews it."""
    forged = encode(columns_of(rows(1, 100)))
    with full._database.writing() as connection:
        of_trial = SAMPLE_BLOCK.c.trial_id == 3
        connection.execute(update(SAMPLE_BLOCK).where(of_trial).values(data=forged, crc32=crc32(forged)))
    assert [problem.split(" is not")[0] for problem in full.upkeep.check()] == ["trial 3"]


def test_records_that_changed_places_are_found(full: Store) -> None:
    past_the_store(
        full,
        "UPDATE audit SET id = 99 WHERE id = 1",
        "UPDATE audit SET id = 1 WHERE id = 2",
        "UPDATE audit SET id = 2 WHERE id = 99",
    )
    assert [problem.split(" is not")[0] for problem in problems(full)] == ["audit 1", "audit 2"]


def test_entries_that_changed_places_are_found(full: Store) -> None:
    past_the_store(
        full,
        "UPDATE chain SET id = 999 WHERE id = 1",
        "UPDATE chain SET id = 1 WHERE id = 2",
        "UPDATE chain SET id = 2 WHERE id = 999",
    )
    found = [problem for problem in problems(full) if problem.startswith("chain")]
    assert [problem.split(" (")[0] for problem in found] == ["chain: entry 1", "chain: entry 2", "chain: entry 3"]


def test_a_chain_that_was_cut_off_with_its_records_is_told_by_a_noted_head(full: Store) -> None:
    noted = full.upkeep.info().chain_head
    assert problems(full, noted) == []
    last = full.upkeep.info().chain_entries
    past_the_store(full, "DELETE FROM audit WHERE id = 3", f"DELETE FROM chain WHERE id = {last}")
    assert problems(full) == []  # nothing is left that would tell
    assert problems(full, noted) == [
        f"chain: the link {noted} is not in it; its end was cut off, or it was written anew"
    ]


def test_a_removed_record_that_is_put_back_is_found(full: Store) -> None:
    full.removal.study(1)
    past_the_store(full, "INSERT INTO study SELECT 1, 'arm', '{}', created_utc FROM calibration")
    assert problems(full) == ["study 1 was removed, and is there again"]


def test_a_backup_has_the_same_chain(full: Store, tmp_path: Path) -> None:
    full.upkeep.backup(f"{tmp_path}/copy.sqlite")
    with Store.open(f"sqlite:///{tmp_path}/copy.sqlite") as copy:
        assert copy.upkeep.check(full.upkeep.info().chain_head) == []
        assert copy.upkeep.info().chain_head == full.upkeep.info().chain_head


def test_flipped_bits_are_found(tmp_path: Path) -> None:
    """`python -m tests.store.flips 1000` asks for more of them."""
    found, _, missed = count(25, 11, tmp_path)
    assert (found, missed) == (25, [])
