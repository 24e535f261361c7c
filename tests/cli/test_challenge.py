"""`friction-bench challenge` and `reveal`."""

import json
import re
import subprocess
import sys

import pytest

from bench.evaluation.challenge import difficulty
from bench.evaluation.challenge.answer import Answer, Truth
from bench.evaluation.challenge.difficulty import DIFFICULTIES, Difficulty
from bench.evaluation.challenge.seal import write_sealed

AS_THEY_ARE = dict(DIFFICULTIES)


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
    refused = command("study", "suggest", 1)
    assert refused.exit_code == 3
    assert "no trial of it can be recorded again" in " ".join(refused.stderr.split())
    for asked in ("diagnose", "search", "compare", "coverage"):
        shown = " ".join(command("study", asked, 1).stdout.split())
        assert shown.count("drawn for a challenge and recorded once") == 1, shown
        assert not re.search(r"to tell them apart|What would help|study (suggest|coverage)", shown), shown
        found = json.loads(command("study", asked, 1, "--json").stdout)["findings"]
        assert [one["code"] for one in found].count("recorded-once") == 1
    told = command("reveal", "set.answer", "--study", 1)
    scored = json.loads(command("reveal", "set.answer", "--study", 1, "--recordings", "set", "--json").stdout)
    truths = [truth["name"] for truth in scored["answer"]["truths"]]
    assert sorted(scored["score"]["right"] + scored["score"]["missed"] + scored["score"]["untold"]) == sorted(truths)
    assert f"guess: {scored['guessed']}\n" in told.stdout
    shown = command("reveal", "set.answer", "--guess", "nothing")
    assert "guess: nothing\n" in shown.stdout
    assert "missed" in shown.stdout or "not to be told" in shown.stdout


@pytest.mark.parametrize(
    ("at_most", "remark", "count"),
    [
        (1e-4, "a spring: these recordings hold next to nothing of it, at most 0.01 % of the effort", "faint"),
        (0.02, "a spring: with it and without it the motor current differs by no more than two runs", "missed"),
    ],
)
def test_a_mechanism_that_the_recordings_hardly_hold_is_remarked(command, tmp_path, at_most, remark, count):
    (tmp_path / "set").mkdir()
    truth = Truth("spring", "a spring", 1.0, "stiffness", "N m/rad", 0.0, {}, at_most)
    write_sealed(Answer(1, "hard", 0, (truth,), {}), tmp_path / "set", tmp_path / "set.answer")
    shown = " ".join(command("reveal", "set.answer", "--guess", "nothing").stdout.split())
    assert remark in shown
    assert "Share of the effort: rms of what the mechanism changes" in shown
    assert ("guess: nothing missed: spring" in shown) == (count == "missed")
    assert ("too little of it to count as missed: spring" in shown) == (count == "faint")
    scored = json.loads(command("reveal", "set.answer", "--guess", "nothing", "--json").stdout)
    assert scored["remarks"][0].startswith(remark)
    assert scored["score"][count] == ["spring"]


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
    assert "rise of the housing in" in " ".join(shown.split())


def test_the_difficulties_say_how_many_mechanisms_they_hide(command):
    told = " ".join(command("challenge", "--help").stdout.replace("│", " ").split())
    for name, one in AS_THEY_ARE.items():
        words = [word for word, chance in zip(("nothing", "one", "two"), one.counts, strict=True) if chance]
        assert f"{name}: {', '.join(words[:-1])} or {words[-1]}" in told


def test_a_place_that_is_taken_is_refused_before_anything_is_loaded(tmp_path):
    """What draws and records takes seconds to load."""
    (tmp_path / "set").mkdir()
    asked = "import sys; from bench.cli.app import app; app(['challenge', '--output', 'set'], standalone_mode=False)"
    watched = f"import sys\ntry:\n    {asked}\nfinally:\n    print('bench.evaluation.challenge.make' in sys.modules)"
    told = subprocess.run([sys.executable, "-c", watched], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "is there already" in told.stderr
    assert told.stdout.strip() == "False"


@pytest.mark.parametrize(
    ("guess", "told"),
    [
        ("nothing", "Not right: 0 of 2 hidden mechanisms found, no names wrong."),
        ("spring", "Not right: 1 of 2 hidden mechanisms found, no names wrong."),
        ("spring,cogging", "Not right: 1 of 2 hidden mechanisms found, 1 name wrong."),
    ],
)
def test_a_guess_that_is_not_right_gets_a_verdict_too(command, tmp_path, guess, told):
    (tmp_path / "set").mkdir()
    truths = tuple(Truth(name, name, 1.0, "size", "1", 0.2, {}, 0.2) for name in ("spring", "shaft"))
    write_sealed(Answer(1, "hard", 0, truths, {}), tmp_path / "set", tmp_path / "set.answer")
    shown = command("reveal", "set.answer", "--guess", guess).stdout.strip().splitlines()
    assert shown[-1] == told


@pytest.mark.parametrize(
    ("guess", "told"),
    [
        ("spring", "All of it, and nothing else."),
        ("spring/cogging/backlash", "All of it, and nothing else. A name in a class counts by its size: 0.33 of 1."),
    ],
)
def test_a_name_in_a_class_counts_by_its_size(command, tmp_path, guess, told):
    (tmp_path / "set").mkdir()
    truth = Truth("spring", "spring", 1.0, "size", "1", 0.2, {}, 0.2)
    write_sealed(Answer(1, "hard", 0, (truth,), {}), tmp_path / "set", tmp_path / "set.answer")
    assert command("reveal", "set.answer", "--guess", guess).stdout.strip().splitlines()[-1] == told


def test_where_nothing_is_hidden_a_name_is_wrong(command, tmp_path):
    (tmp_path / "set").mkdir()
    write_sealed(Answer(1, "hard", 0, (), {}), tmp_path / "set", tmp_path / "set.answer")
    shown = command("reveal", "set.answer", "--guess", "spring,cogging").stdout.strip().splitlines()
    assert shown[-1] == "Not right: nothing was hidden that could be found, 2 names wrong."
    assert command("reveal", "set.answer", "--guess", "nothing").stdout.strip().endswith("All of it, and nothing else.")
