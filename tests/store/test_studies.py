"""Studies and the lineage of their models."""

import pytest

from bench.store import Store
from bench.store.errors import NotFoundError, StoreStateError


def test_models_form_a_lineage(store: Store) -> None:
    study_id = store.create_study("gear 12", {"trials": [1, 2], "held_out": [3]})
    base = store.add_model(study_id, None, ["inertia", "coulomb"], {"error": 0.24})
    child = store.add_model(study_id, base, ["inertia", "coulomb", "load_friction"], {"error": 0.12})
    assert store.study(study_id).definition == {"trials": [1, 2], "held_out": [3]}
    found = store.models(study_id)
    assert [(model.id, model.parent_id) for model in found] == [(base, None), (child, base)]
    assert found[1].effects == ["inertia", "coulomb", "load_friction"]
    assert store.model(child).result == {"error": 0.12}


def test_only_a_model_without_children_is_removed(store: Store) -> None:
    study_id = store.create_study("s", {})
    base = store.add_model(study_id, None, [], {})
    child = store.add_model(study_id, base, [], {})
    with pytest.raises(StoreStateError, match=f"made from it are {child}"):
        store.remove_model(base)
    store.remove_model(child)
    store.remove_model(base)
    assert store.models(study_id) == []


def test_a_parent_belongs_to_the_same_study(store: Store) -> None:
    first, second = store.create_study("a", {}), store.create_study("b", {})
    model_id = store.add_model(first, None, [], {})
    with pytest.raises(NotFoundError, match="belongs to another study"):
        store.add_model(second, model_id, [], {})


def test_studies_are_listed_newest_first(store: Store) -> None:
    ids = [store.create_study(name, {}) for name in "abc"]
    assert [study.id for study in store.studies()] == ids[::-1]
    assert [study.id for study in store.studies(limit=1, offset=1)] == [ids[1]]


def test_what_is_not_there_is_named(store: Store) -> None:
    with pytest.raises(NotFoundError, match="study 5 is not in the store"):
        store.study(5)
    with pytest.raises(NotFoundError, match="study 5"):
        store.models(5)
    with pytest.raises(NotFoundError, match="study 5"):
        store.add_model(5, None, [], {})
    with pytest.raises(NotFoundError, match="model 5 is not in the store"):
        store.remove_model(5)
