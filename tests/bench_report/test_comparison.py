"""The test behind the bench report: how often it cries wolf, and what it sees."""

import json
from itertools import permutations
from xml.etree import ElementTree

import numpy as np
import pytest
from typer.testing import CliRunner

from bench.cli.app import app
from bench.errors import BaselineError
from bench.evaluation.bench_report import campaign
from bench.evaluation.bench_report.baseline import read_baseline, write_baseline
from bench.evaluation.bench_report.campaign import METRICS, SeedValues
from bench.evaluation.bench_report.comparison import FAMILY_RATE, compare, permutation_p
from bench.evaluation.bench_report.documents import is_bad, sections, write_junit
from bench.report.html import html_page

NAMES = [metric.name for metric in METRICS]


def drawn(generator: np.random.Generator, count: int = 6, **scale: float) -> list[SeedValues]:
    """Skewed values, as errors are."""
    return [
        SeedValues(seed, {name: float(generator.lognormal(0, 0.5) * scale.get(name, 1.0)) for name in NAMES})
        for seed in range(count)
    ]


def test_the_p_value_is_that_of_all_permutations():
    low, high = np.array([0.2, 1.0, 0.5]), np.array([0.7, 1.5])
    pooled = np.concatenate([low, high])
    sums = [pooled[list(order[:2])].sum() for order in permutations(range(5))]
    assert permutation_p(low, high) == pytest.approx(np.mean(np.array(sums) >= high.sum() - 1e-12))


def test_an_unchanged_program_is_never_called_worse():
    found = drawn(np.random.default_rng(1), 8)
    lines = compare(found, found)
    assert {line.verdict for line in lines} == {"as before"}
    assert {line.change for line in lines} == {0.0}


@pytest.mark.parametrize("seed", [1, 20260])
def test_false_alarms_are_as_rare_as_is_said(seed):
    generator, count, rate = np.random.default_rng(seed), 200, 0.05
    alarms = sum(is_bad(compare(drawn(generator), drawn(generator), rate)) for _ in range(count))
    # at most `rate`; three standard deviations of the binomial above it
    assert alarms <= count * rate + 3 * np.sqrt(count * rate * (1 - rate))


def test_what_is_worse_is_named_and_only_that():
    generator = np.random.default_rng(3)
    lines = compare(drawn(generator, 8), drawn(generator, 8, **{NAMES[0]: 10.0, NAMES[1]: 0.05}))
    assert [line.verdict for line in lines] == ["worse", "better", *["as before"] * (len(NAMES) - 2)]
    assert lines[0].low > 0 > lines[1].high
    assert "worse by +" in lines[0].sentence
    assert "--update-baseline" in lines[1].sentence


@pytest.mark.parametrize("scale", [0.05, 20.0])
def test_where_neither_way_is_better_both_are_told(scale):
    generator = np.random.default_rng(7)
    either = next(metric.name for metric in METRICS if not metric.lower_is_better)
    lines = compare(drawn(generator, 8), drawn(generator, 8, **{either: scale}))
    [told] = [line for line in lines if line.verdict != "as before"]
    assert (told.metric.name, told.verdict) == (either, "changed")
    assert "where that is meant, keep it with --update-baseline" in told.sentence
    assert is_bad(lines)


def test_a_seed_that_gave_nothing_is_a_failure():
    before = drawn(np.random.default_rng(4), 8)
    now = [*before[:-1], SeedValues(8, dict.fromkeys(NAMES[:2], 1.0), ("load-sweep, seed 8: tripped",))]
    lines = compare(before, now)
    assert [line.verdict for line in lines] == ["as before"] * 2 + ["failed"] * (len(NAMES) - 2)
    assert "1 of 8 seeds gave no value: load-sweep, seed 8: tripped" in lines[2].sentence


def test_too_few_seeds_are_refused():
    few = drawn(np.random.default_rng(5), 4)
    with pytest.raises(BaselineError, match="too few"):
        compare(few, few, FAMILY_RATE)


def test_the_documents_say_what_is_worse(tmp_path):
    generator = np.random.default_rng(6)
    lines = compare(drawn(generator, 8), drawn(generator, 8, **{NAMES[0]: 10.0}))
    write_junit(tmp_path / "out" / "junit.xml", lines, 12.5)
    root = ElementTree.parse(tmp_path / "out" / "junit.xml").getroot()
    assert (root.get("tests"), root.get("failures")) == (str(len(NAMES)), "1")
    [failure] = root.iter("failure")
    assert "worse by" in str(failure.get("message"))
    page = html_page("Bench report", sections(lines))
    assert "Worse than before" in page
    assert NAMES[0] in page


def test_a_baseline_reads_back_and_belongs_to_its_campaign(tmp_path):
    path, found = tmp_path / "baseline.json", drawn(np.random.default_rng(7), 8)
    with pytest.raises(BaselineError, match="there is no baseline"):
        read_baseline(path)
    write_baseline(path, found)
    assert read_baseline(path) == found
    kept = json.loads(path.read_text())
    kept["campaign"]["metrics"].append("another")
    path.write_text(json.dumps(kept))
    with pytest.raises(BaselineError, match="another campaign"):
        read_baseline(path)
    path.write_text("[]")
    with pytest.raises(BaselineError, match="is no baseline"):
        read_baseline(path)
    with pytest.raises(BaselineError, match="no baseline is made of failures"):
        write_baseline(path, [SeedValues(1, {}, ("steps: tripped",))])


def test_the_command_from_baseline_to_alarm(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    worse = dict.fromkeys(NAMES, 1.0)

    def fake(seed: int) -> SeedValues:
        generator = np.random.default_rng(seed)
        return SeedValues(seed, {name: float(generator.lognormal(0, 0.2) * worse[name]) for name in NAMES})

    monkeypatch.setattr(campaign, "run_seed", fake)
    monkeypatch.setattr("bench.parallel.over_cores.over_cores", map)

    def report(*words: str):
        return CliRunner().invoke(app, ["bench-report", *words])

    assert report().exit_code == 3
    assert report("--update-baseline").exit_code == 0
    assert report().exit_code == 0
    worse[NAMES[2]] = 3.0
    failed = report("--junit", "junit.xml", "--html", "report.html", "--json")
    assert failed.exit_code == 1
    assert f"{NAMES[2]} worse by" in failed.stderr
    assert [line["verdict"] for line in json.loads(failed.stdout)].count("worse") == 1
    assert (tmp_path / "junit.xml").exists()
    assert (tmp_path / "report.html").exists()


def test_a_seed_of_the_campaign_gives_every_metric():
    found = campaign.run_seed(3)
    assert found.failures == ()
    assert set(found.values) == set(NAMES)
    assert all(0 <= value < 100 for value in found.values.values())
