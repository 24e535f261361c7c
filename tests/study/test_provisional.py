"""A provisional curve over a study's life: offered, added, kept, shown, and dropped for the physics."""

import numpy as np
import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.store import Store
from bench.study.changes import add_effect, drop_effect
from bench.study.closed_loop import simulate
from bench.study.compare import compare
from bench.study.create import create_study
from bench.study.diagnosis.diagnose import diagnose
from bench.study.ladder import ladder
from bench.study.report.report import report_html
from tests.lab.synthetic import Joint, plans
from tests.study.conftest import imported

CATCHES = Joint(extra=lambda x: 0.12 * np.exp(-(((x.q - 0.2) / 0.25) ** 2)) * np.sign(x.v))
CURVE = "curve_of_position_against_motion"


@pytest.fixture(scope="module")
def number(store) -> int:
    return create_study(store, "catches", [imported(store, plans(loads_kg=(0.0, 0.2), repeats=2), CATCHES)]).study_id


def test_an_unknown_effect_is_offered_as_a_curve_and_stands_in_the_model(store, number):
    found = diagnose(store, number)
    assert found.verdict == "unknown-effect"
    offered = found.provisional
    assert offered.effect == CURVE
    assert CURVE in offered.sentence
    assert len(offered.picture.x) == len(offered.picture.curve)
    changed = add_effect(store, number, offered.effect)
    assert changed.after.held_out == pytest.approx(offered.held_out_after, rel=1e-6)
    assert changed.after.held_out < 0.6 * changed.before.held_out
    assert ladder(store, number).rungs[-1].added == CURVE


def test_the_model_with_the_curve_is_like_any_other(store, number):
    told = compare(store, number)
    assert next(one.name for one in told.parameters if one.effect == CURVE) == "at the second knot"
    assert not any("knot" in note for note in told.notes)
    assert simulate(store, number).held_out.position > 0.0
    assert "Curve over position" in report_html(store, number)
    again = diagnose(store, number).provisional
    assert again is None or again.effect != CURVE
    after = drop_effect(store, number, CURVE).after.held_out
    assert after == pytest.approx(ladder(store, number).rungs[0].held_out)


def test_the_command_says_what_to_add(tmp_path):
    url = f"sqlite:///{tmp_path / 'bench.sqlite'}"
    with Store.open(url) as own:
        made = imported(own, plans(loads_kg=(0.0, 0.2), repeats=2), CATCHES)
        study_id = create_study(own, "catches", [made]).study_id
    told = CliRunner().invoke(app, ["--store", url, "study", "diagnose", str(study_id)], env={"COLUMNS": "300"})
    assert f"{CURVE} can stand in the model as a provisional term" in told.stdout
    assert told.stdout.splitlines()[-1].endswith(f"study add {study_id} {CURVE}")
