"""Removing one experiment or study by number: for good, and only where nobody needs it."""

import pytest
from sqlalchemy import func, select, update

from bench.store import Store
from bench.store.errors import NotFoundError, StoreFileError, StoreStateError
from bench.store.schema import EVENT, EXPERIMENT, MODEL, SAMPLE_BLOCK, TRIAL
from tests.store.examples import begin, begin_trial, rows


def recorded(store: Store) -> int:
    experiment_id = begin(store)
    begin_trial(store, experiment_id).append(rows(0, 100), [(1.0, "note", "")])
    store.finish_experiment(experiment_id, "completed")
    return experiment_id


def calibrated(store: Store, **result: object) -> int:
    return store.calibrations.add(
        note="", source="simulated", rig={}, drive={}, provenance={}, experiment_ids=[], trial_ids=[], result=result
    )


def count(store: Store) -> list[int]:
    with store._database.reading() as connection:
        return [
            connection.execute(select(func.count()).select_from(table)).scalar_one()
            for table in (EXPERIMENT, TRIAL, SAMPLE_BLOCK, EVENT)
        ]


def test_an_experiment_goes_with_all_its_data(store: Store) -> None:
    kept, gone = recorded(store), recorded(store)
    assert store.removal.experiment(gone) == f"experiment {gone} (steps, completed, 1 trials, 100 rows)"
    assert count(store) == [1, 1, 1, 1]
    assert [one.id for one in store.experiments()] == [kept]
    with pytest.raises(NotFoundError, match=f"experiment {gone} is not in the store"):
        store.removal.experiment(gone)
    assert store.upkeep.check() == []


@pytest.mark.parametrize("backend", ["sqlite"])  # PostgreSQL keeps nothing that is no JSON
def test_what_cannot_be_read_any_more_can_be_removed(store: Store) -> None:
    gone = recorded(store)
    with store._database.writing() as connection:
        connection.exec_driver_sql(f"UPDATE experiment SET parameters = '[[[' WHERE id = {gone}")
    with pytest.raises(StoreFileError, match=f"experiment, row {gone}: its parameters cannot be read"):
        store.experiment(gone)
    store.removal.experiment(gone)
    assert store.experiments() == []


def test_one_that_runs_stays(store: Store) -> None:
    running = begin(store)
    with pytest.raises(StoreStateError, match="is running; stop it"):
        store.removal.experiment(running)
    assert store.experiment(running).outcome == "running"


def test_one_that_a_study_or_a_calibration_uses_stays(store: Store) -> None:
    used, rests = recorded(store), recorded(store)
    study_id = store.create_study("arm", {"trial_ids": [store.trials(used)[0].id]})
    calibration_id = calibrated(store)
    with store._database.writing() as connection:
        connection.exec_driver_sql(f"UPDATE calibration SET experiment_ids = '[{rests}]'")
    with pytest.raises(StoreStateError, match=rf"study {study_id} \(arm\) could not be followed back"):
        store.removal.experiment(used)
    with pytest.raises(StoreStateError, match=f"calibration {calibration_id} could not be followed back"):
        store.removal.experiment(rests)
    assert len(store.experiments()) == 2
    store.removal.study(study_id)
    store.removal.experiment(used)


def test_a_study_goes_with_its_models_and_leaves_its_trials(store: Store) -> None:
    used = recorded(store)
    study_id = store.create_study("arm", {"trial_ids": [store.trials(used)[0].id]})
    first = store.add_model(study_id, None, ["coulomb"], {})
    store.add_model(study_id, first, ["coulomb", "viscous"], {})
    assert store.removal.study(study_id) == f"study {study_id} (arm, 2 models)"
    assert store.studies() == []
    with store._database.reading() as connection:
        assert connection.execute(select(MODEL)).all() == []
    assert len(store.trials(used)) == 1
    with pytest.raises(NotFoundError, match="list the studies"):
        store.removal.study(study_id)


def test_a_study_whose_model_moves_the_joint_stays(store: Store) -> None:
    study_id = store.create_study("arm", {"trial_ids": []})
    calibration_id = calibrated(store, study={"study_id": study_id})
    with pytest.raises(StoreStateError, match=f"calibration {calibration_id} carries a model of it"):
        store.removal.study(study_id)


def test_a_removal_that_was_broken_off_is_ended_by_the_next_to_open_the_store(store: Store, store_url: str) -> None:
    gone = recorded(store)
    with store._database.writing() as connection:
        connection.execute(update(EXPERIMENT).where(EXPERIMENT.c.id == gone).values(outcome="removing", owner=None))
    with Store.open(store_url):
        assert count(store) == [0, 0, 0, 0]
