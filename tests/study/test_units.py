"""Units of one kind: simulated joints that scatter about one type, one of them with another friction."""

from dataclasses import replace

import numpy as np
import pytest

from bench.recording_set import RecordingSet, import_recording_set
from bench.store import Store
from bench.study.changes import add_effect
from bench.study.create import create_study
from bench.study.errors import StudyError
from bench.study.units import compare_units
from tests.lab.synthetic import Bench, Joint, plans, recordings
from tests.study.conftest import RIG, imported

UNITS = 7
SCATTER = 0.06  # of Coulomb and viscous friction, as a share
ODD, EXCESS = 4, 0.06  # N m
TYPE = Joint(static_excess=0.0)
MODEL = ["inertia", "gravity", "offset", "coulomb", "viscous"]
SHORT = Bench(duration_s=8.0)


def scattered(random: np.random.Generator) -> Joint:
    """One unit of the type."""
    friction, viscous = (1.0 + SCATTER * random.standard_normal(2)).tolist()
    return replace(TYPE, coulomb=TYPE.coulomb * friction, viscous=TYPE.viscous * viscous)


@pytest.fixture(scope="module")
def joints() -> list[Joint]:
    random = np.random.default_rng(11)
    found = [scattered(random) for _ in range(UNITS)]
    found[ODD] = replace(found[ODD], coulomb=found[ODD].coulomb + EXCESS)
    return found


@pytest.fixture(scope="module")
def study_ids(store: Store, joints: list[Joint]) -> list[int]:
    found = []
    for number, joint in enumerate(joints):
        experiment = imported(store, plans(loads_kg=(0.0, 0.1, 0.2), seed=number), joint, bench=SHORT)
        made = create_study(store, f"unit {number}", [experiment], base=MODEL, cutoff_hz=6.0 + number)
        found.append(made.study_id)
    return found


def parameter(found, effect):
    return next(one for one in found.parameters if one.effect == effect)


def test_the_odd_unit_is_found_with_how_far_it_is_off(store, study_ids, joints):
    found = compare_units(store, study_ids[0], study_ids[1:])
    odd = [(one.effect, value.name) for one in found.parameters for value in one.values if value.outlier]
    assert odd == [("coulomb", f"unit {ODD}")]
    coulomb = parameter(found, "coulomb")
    value = coulomb.values[ODD]
    others = np.mean([joint.coulomb for number, joint in enumerate(joints) if number != ODD])
    assert value.deviation_low < joints[ODD].coulomb - others < value.deviation_high
    assert value.value > value.expected_high
    assert value.p_value < 0.05
    assert f"'unit {ODD}' in {coulomb.name}" in found.sentence


def test_what_units_share_and_how_they_scatter(store, study_ids):
    found = compare_units(store, study_ids[0], study_ids[1:])
    assert found.cutoff_hz == 6.0  # the lowest of all
    assert [one.name for one in found.units] == [f"unit {number}" for number in range(UNITS)]
    coulomb, viscous = parameter(found, "coulomb"), parameter(found, "viscous")
    assert coulomb.mean_low < TYPE.coulomb < coulomb.mean_high
    assert coulomb.scatter_low < SCATTER * TYPE.coulomb < coulomb.scatter_high
    assert coulomb.differs
    assert viscous.mean_low < TYPE.viscous < viscous.mean_high
    for effect in ("inertia", "gravity"):  # the same in all
        assert not parameter(found, effect).differs
    assert len(found.notes) == 1


def test_effects_with_shapes_are_fitted_at_the_same_shapes(store, study_ids):
    model = add_effect(store, study_ids[0], "stribeck").model_id
    found = compare_units(store, study_ids[0], study_ids[1:4], model)
    assert found.effects == [*MODEL, "stribeck"]
    assert "4 units: intervals are wide" in found.notes[1]
    base = store.models(study_ids[0])[0].id
    assert compare_units(store, study_ids[0], study_ids[1:4], base).effects == MODEL


def test_of_two_units_the_differences_are_told(store, study_ids, joints):
    found = compare_units(store, study_ids[0], [study_ids[ODD]])
    assert found.parameters == []
    assert len(found.notes) == 1
    told = {one.effect: one for one in found.differences}
    assert list(told) == MODEL
    coulomb, truth = told["coulomb"], joints[ODD].coulomb - joints[0].coulomb
    assert coulomb.low < truth < coulomb.high
    assert coulomb.low > 0.0
    assert coulomb.difference == pytest.approx(coulomb.second - coulomb.first)
    assert coulomb.name in found.sentence
    assert told["inertia"].low < 0.0 < told["inertia"].high  # the same in both
    assert "two cannot tell" in found.sentence


def test_too_few_units_and_other_kinds_are_refused(store, study_ids):
    with pytest.raises(StudyError, match="1 unit; to see a difference takes 2"):
        compare_units(store, study_ids[0], [study_ids[0]])
    lying = RIG.model_copy(update={"horizontal": True})
    experiment = imported(store, plans(loads_kg=(0.1,)), TYPE, rig=lying, bench=SHORT)
    other = create_study(store, "lying", [experiment], base=["inertia", "coulomb", "viscous"], cutoff_hz=6.0).study_id
    with pytest.raises(StudyError, match=r"not of one kind: horizontal is None and True|False and True"):
        compare_units(store, study_ids[0], [study_ids[1], other])
    moving = store.study(study_ids[1]).definition
    experiment_ids = list(moving["experiment_ids"])
    wider = create_study(store, "all rows", experiment_ids, base=MODEL, cutoff_hz=6.0, rows="moving").study_id
    with pytest.raises(StudyError, match="counts sliding rows"):
        compare_units(store, study_ids[0], [study_ids[1], wider])


def test_units_whose_efforts_are_different_quantities_are_refused(store, study_ids):
    made = recordings(TYPE, SHORT, plans(loads_kg=(0.0, 0.1)), seed=3)
    for one in made:
        one.channels["voltage_v"] = one.channels.pop("torque_n_m")
    experiment = import_recording_set(store, RecordingSet("set", RIG, made), "by voltage")
    other = create_study(store, "by voltage", [experiment], base=MODEL, cutoff_hz=6.0).study_id
    words = r"not of one kind: the effort is joint torque \[N m\] and terminal voltage \[V\]; record the same"
    with pytest.raises(StudyError, match=words):
        compare_units(store, study_ids[0], [study_ids[1], other])
