"""The main job on the simulated bench, as `make demo` runs it."""

import re

import pytest

from bench.evaluation.demo import run_demo
from bench.evaluation.demo.hidden_effect import draw
from bench.store import Store
from tests.paths import ROOT

pytestmark = pytest.mark.timeout(600)  # a minute by itself; a shared machine may take several


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    report = tmp_path_factory.mktemp("demo") / "demo.html"
    sections = []
    database = run_demo(report, sections.append, seed=2)
    return report, database, sections


def test_compensation_narrows_the_spread_of_the_steady_current(demo):
    (plain, compensated) = demo[2][0].tables[0].rows
    assert plain[3] > 20 * compensated[3]


def test_the_load_sweep_beats_the_papers_table_1(demo):
    mean, _, largest = demo[2][1].tables[1].rows
    assert mean[1] < mean[2] == pytest.approx(1.11, abs=0.005)
    assert largest[1] < largest[2] == pytest.approx(2.73, abs=0.005)


def test_the_hidden_effect_is_named_and_its_addition_lowers_the_held_out_error(demo):
    section = demo[2][2]
    assert draw(2).name == "viscous_asymmetry"
    assert section.tables[0].rows[0][0] == "Direction-asymmetric viscous friction"
    base, added, floor = (row[2] for row in section.tables[1].rows)
    assert floor < added < 0.6 * base
    promised = section.tables[0].rows[0][3]
    assert added == pytest.approx(promised, rel=1e-6), "the model that is added is the one that was judged"


def test_the_readme_states_what_the_demonstration_prints(demo):
    """Its figures, within 3 %: another processor rounds a little otherwise."""
    spreads, sweep, effect = demo[2]
    with_friction, compensated = (row[3] for row in spreads.tables[0].rows)
    mean, _, largest = sweep.tables[1].rows
    base, added, floor = (row[2] for row in effect.tables[1].rows)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    [told] = re.findall(r"25 steps \| ([\d.]+) mA \| ([\d.]+) mA", readme)
    told += re.findall(r"error of the load.* \| ([\d.]+) g \| ([\d.]+) g \|", readme)[0]
    told += re.findall(r"largest error of the load.* \| ([\d.]+) g \| ([\d.]+) g \|", readme)[0]
    told += re.findall(r"from ([\d.]+) % to ([\d.]+) %\. Repeated trials differ by ([\d.]+) %", readme)[0]
    given = [with_friction, compensated, *mean[1:], *largest[1:], base, added, floor]
    assert [float(one) for one in told] == pytest.approx(given, rel=0.03)


def test_the_report_is_one_file_that_asks_nothing_of_the_network(demo):
    page = demo[0].read_text(encoding="utf-8")
    assert page.count('class="figure"') == 5
    assert not re.findall(r'<(?:script|link|img)[^>]+(?:src|href)="', page)
    assert not list(demo[0].parent.glob("*.part"))


def test_every_figure_can_be_drawn_again_from_the_store(demo):
    with Store.open(f"sqlite:///{demo[1]}") as store:
        assert [experiment.kind for experiment in store.experiments()] == ["excitation", "load-sweep", "steps"]
        assert all(experiment.outcome == "completed" for experiment in store.experiments())
        assert len(store.models(store.studies()[0].id)) == 2
