"""Many studies at once: the same answers as one by one, in order, and what cannot be judged says so."""

import pytest

from bench.store.errors import NotFoundError
from bench.study.create import create_study
from bench.study.diagnosis.diagnose import diagnose
from bench.study.diagnosis.diagnose_many import diagnose_many
from tests.lab.synthetic import plans
from tests.study.conftest import imported


@pytest.fixture(scope="module")
def study_ids(store) -> list[int]:
    """Two studies of the same six trials, with other ones held out."""
    made = imported(store, plans(loads_kg=(0.0, 0.2)))
    held = (["style=2"], ["load_kg=0.2"])
    return [create_study(store, f"study {h}", [made], hold_out=h, cutoff_hz=6.0).study_id for h in held]


def test_answers_are_those_of_one_by_one_in_the_order_asked(store, study_ids):
    shown = []
    found = diagnose_many(store, study_ids[::-1], lambda *done: shown.append(done), workers=1)
    assert found == [diagnose(store, study_id) for study_id in study_ids[::-1]]
    assert shown == [(0, 2), (1, 2), (2, 2)]


def test_a_study_that_cannot_be_judged_does_not_hide_the_others(store, study_ids):
    still = imported(store, plans(loads_kg=(0.0,), repeats=1))
    everything = ["inertia", "gravity", "offset", "coulomb", "viscous"]
    made = create_study(store, "one load", [still], base=everything, cutoff_hz=6.0).study_id
    store.add_model(made, None, ["weight_friction"], {"shapes": {}})
    found = diagnose_many(store, [made, study_ids[0]], lambda *_: None, workers=1)
    assert "weight_friction needs load_kg to differ" in found[0].error
    assert found[1] == diagnose(store, study_ids[0])


def test_an_unknown_study_is_refused(store):
    with pytest.raises(NotFoundError):
        diagnose_many(store, [999], lambda *_: None, workers=1)
