"""The report of a study: one file, complete, without a network."""

import re

import pytest

from bench.config.configuration import default_configuration
from bench.report import html_page
from bench.study.changes import add_effect
from bench.study.create import create_study, describe
from bench.study.ladder import ladder
from bench.study.report.model_sections import measured_section
from bench.study.report.report import report, report_html
from tests.lab.synthetic import Plan, plans
from tests.study.conftest import imported


@pytest.fixture(scope="module")
def number(store):
    made = create_study(
        store, "arm <1>", [imported(store, plans((0.0, 0.2), repeats=2))], hold_out=["repeat=2"], cutoff_hz=6.0
    )
    add_effect(store, made.study_id, "viscous_asymmetry")
    return made.study_id


@pytest.fixture(scope="module")
def sections(store, number):
    return {section.title: section for section in report(store, number, default_configuration())[1]}


def test_everything_that_a_lab_files_is_in_it(store, number, sections):
    first, newest = store.models(number)
    assert list(sections) == [
        "In short",
        "What was measured",
        "The ladder",
        f"Model {newest.id}",
        "What the models leave",
        "In closed loop",
        f"What was missing from the first model, {first.id}",
        f"What is missing from the newest model, {newest.id}",
        "Trials to record next",
        "Where it comes from",
    ]
    assert "12 trials, of which 6 are held out" in sections["What was measured"].sentences[0]
    study = describe(store, number)
    one = measured_section(study.model_copy(update={"trials": study.trials[:1]}), store)
    assert one.sentences[0].startswith("1 trial, ")
    (table,) = sections["The ladder"].tables
    rungs = ladder(store, number).rungs
    assert [row[3] for row in table.rows] == [f"{rung.held_out:.2%}" for rung in rungs]
    assert table.rows[1][1] == "+ viscous asymmetry"
    assert "as far as the best model can tell" in sections["The ladder"].sentences[0]


def test_who_files_it_finds_when_who_on_what_and_what_came_out(store, number, sections):
    short = sections["In short"]
    facts = dict(short.tables[0].rows)
    assert set(facts) == {"date", "recorded", "operator", "rig", "drive", "source", "version", "commit"}
    assert facts["source"] == "imported"
    assert re.match(r"\d{4}-\d\d-\d\d \d\d:\d\d", facts["date"])
    before, after = (f"{rung.held_out:.2%}" for rung in ladder(store, number).rungs)
    assert f"With viscous asymmetry the error goes from {before} to {after}" in short.sentences[1]
    page = report_html(store, number)
    assert page.count('href="#part-') == page.count("<h2 id=")
    assert "@media print" in page
    assert "prefers-color-scheme: dark" in page
    assert ">viscous_asymmetry<" not in page


def test_evidence_stands_in_words_and_pictures(store, number, sections):
    missing = sections[f"What was missing from the first model, {store.models(number)[0].id}"]
    assert missing.sentences[0].startswith("Direction-asymmetric viscous friction is missing")
    assert missing.figures[0].title.startswith("Direction-asymmetric viscous friction")
    residual = sections["What the models leave"].figures
    velocity = next(figure for figure in residual if figure.title == "Residual against velocity")
    assert len(velocity.drawn) == 4  # two directions, before and after


def test_another_rig_leaves_out_what_to_record_next_and_says_why(sections):
    (sentence,) = sections["Trials to record next"].sentences
    assert "of another rig than this bench" in sentence


def test_trials_that_show_nothing_are_filed_with_why(store):
    """A joint that is held at four angles: of all rows none slides."""
    holds = [Plan(f"hold-{n}", [], centre=0.3 * n - 0.5, load_kg=0.1 * n) for n in range(4)]
    study = create_study(store, "holds", [imported(store, holds)], cutoff_hz=6.0, rows="all").study_id
    title, sections = report(store, study, default_configuration())
    found = {section.title: section for section in sections}
    (missing,) = found[f"What is missing from the newest model, {store.models(study)[0].id}"].sentences
    assert missing.startswith("What is missing cannot be judged: ")
    assert "a diagnosis needs 20: record longer strokes at a steady speed" in missing
    assert missing in found["In short"].sentences
    assert found["The ladder"].tables
    assert title in html_page(title, sections)


def test_the_page_is_whole_and_escaped(store, number):
    page = report_html(store, number)
    assert page.startswith("<!doctype html>")
    assert page.rstrip().endswith("</html>")
    assert "arm &lt;1&gt;" in page
    assert "Trials to record next" not in page
    outside = re.findall(r'(?:src|href)="([^#"][^"]*)"', page.split("<script>")[0])
    assert outside == []
