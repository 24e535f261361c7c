"""What a study says of breaking away: its errors and parameters, its rung, and what a change does to it."""

import numpy as np
import pytest

from bench.config.rig import Rig
from bench.recording_set import import_recording_set
from bench.recording_set.recording_set import RecordingSet
from bench.store import Store
from bench.study.changes import add_effect
from bench.study.compare import compare
from bench.study.create import create_study
from bench.study.ladder import ladder
from bench.study.models.change import Changed
from bench.study.models.comparison import Comparison
from bench.study.models.ladder import Ladder
from bench.study.report.report import report_html
from tests.lab.at_rest.test_breakaways import falling
from tests.lab.ramps import STATIC, ramp_recordings

EXPECTED_STARTS = 24  # of 36: the quickest ramps come up too quickly


@pytest.fixture(scope="module")
def told(tmp_path_factory) -> dict[str, dict]:
    """A study of ramps whose static friction falls with the rate, and the effect that says so added."""
    rig = Rig.model_validate({"name": "level joint", "horizontal": True})
    with Store.open(f"sqlite:///{tmp_path_factory.mktemp('ramps') / 'bench.sqlite'}") as store:
        number = import_recording_set(store, RecordingSet("ramps", rig, ramp_recordings(falling)), "level joint")
        base = ["inertia", "offset", "coulomb", "viscous"]
        study = create_study(store, "ramps", [number], cutoff_hz=12.0, base=base).study_id
        before = compare(store, study)
        changed = add_effect(store, study, "rate_dependent_breakaway")
        viscous = add_effect(store, study, "viscous_asymmetry")
        return {
            "before": before,
            "changed": changed,
            "other": viscous,
            "after": compare(store, study, changed.model_id),
            "ladder": ladder(store, study),
            "report": {"html": report_html(store, study)},
        }


def test_breakaway_is_a_regime_with_starts_for_rows(told):
    regime = told["before"].regimes[-1]
    assert (regime.name, regime.rows) == ("breakaway", EXPECTED_STARTS)
    assert regime.relative == told["before"].breakaway.training.relative > 0.0


def test_parameters_of_breakaway_are_those_of_the_joint(told):
    found = {(one.effect, one.name): one for one in told["after"].breakaway.parameters}
    static = next(one for (effect, _), one in found.items() if effect == "coulomb")
    assert static.low < STATIC < static.high or static.value == pytest.approx(STATIC, rel=0.1)
    assert static.low < static.value < static.high
    assert static.unit == "N m"
    assert ("rate_dependent_breakaway", "fall of static friction") in found
    own = [one for one in told["after"].breakaway.parameters if one.effect == "rate_dependent_breakaway"]
    assert [str(one) for one in told["changed"].breakaway.parameters] == [str(one) for one in own]  # no nan is one
    assert len(own) == 2
    assert told["other"].breakaway is None
    assert ("rate_dependent_breakaway", "rate that makes half the fall") in found


def test_a_change_that_shows_in_breakaway_is_judged_there_too(told):
    change = told["changed"].breakaway
    assert change.held_out_after < 0.7 * change.held_out_before
    assert change.gain_low > 0.0
    assert "held-out error of the breakaway effort" in told["changed"].sentence
    assert told["other"].breakaway is None


def test_the_ladder_falls_in_breakaway_too(told):
    base, added, _ = told["ladder"].rungs
    assert base.breakaway.starts == EXPECTED_STARTS
    assert added.breakaway.held_out < 0.7 * base.breakaway.held_out
    assert added.breakaway.held_out_low < added.breakaway.held_out < added.breakaway.held_out_high


def test_answers_follow_their_schemas_and_the_report_shows_them(told):
    for name, model in (("after", Comparison), ("changed", Changed), ("ladder", Ladder)):
        assert model.model_validate_json(told[name].model_dump_json())
    assert "Parameters of the breakaway effort" in told["report"]["html"]
    assert np.isfinite(told["after"].breakaway.held_out.relative)
