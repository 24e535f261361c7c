"""`friction-bench challenge` and `reveal`."""

import json

import pytest

from bench.evaluation.challenge import difficulty
from bench.evaluation.challenge.difficulty import Difficulty


@pytest.fixture(autouse=True)
def _quick(monkeypatch):
    quick = Difficulty((0.0, 1.0, 0.0), (0.8, 1.0), 0.001, (1.0,), 3.0, 1, 0)
    monkeypatch.setitem(difficulty.DIFFICULTIES, "easy", quick)


@pytest.mark.timeout(400)
def test_from_the_draw_to_the_score(command):
    made = command("challenge", "--seed", 11, "--output", "set")
    assert made.exit_code == 0, made.output
    assert command("import", "set").exit_code == 0
    assert command("study", "new", "x", "--experiment", 1).exit_code == 0
    scored = json.loads(command("reveal", "set.answer", "--study", 1, "--recordings", "set", "--json").stdout)
    truths = [truth["name"] for truth in scored["answer"]["truths"]]
    assert sorted(scored["score"]["right"] + scored["score"]["missed"] + scored["score"]["untold"]) == sorted(truths)
    shown = command("reveal", "set.answer", "--guess", "nothing")
    assert "missed" in shown.stdout or "not to be told" in shown.stdout


def test_without_a_seed_nobody_knows_what_comes(command):
    assert command("challenge", "--output", "a").exit_code == 0
    assert command("challenge", "--output", "b").exit_code == 0
    seeds = [json.loads(command("reveal", f"{name}.answer", "--json").stdout)["answer"]["seed"] for name in "ab"]
    assert seeds[0] != seeds[1]


def test_refusals_leave_no_file(command, tmp_path):
    (tmp_path / "set").mkdir()
    for words in (
        ("challenge", "--seed", 1, "--output", "set"),
        ("reveal", "nowhere.answer"),
        ("reveal", "nowhere.answer", "--guess", "sprin"),
        ("reveal", "nowhere.answer", "--guess", "spring", "--study", 1),
    ):
        refused = command(*words)
        assert refused.exit_code == 3, refused.output
    assert [path.name for path in tmp_path.iterdir()] == ["set"]


def test_ranges_are_shown_with_their_reasons(command):
    shown = command("challenge", "--ranges").stdout
    assert "the paper: 60 of 490 mA" in shown
    assert "lubricant: Vogel temperature" in shown
