"""What the documents name is there: files, places, targets of make, commands and their options, versions."""

import ast
import re
import shlex
from pathlib import Path

import pytest
import typer
import yaml
from typer.core import TyperGroup

import bench
from bench.cli.app import ListedCommand
from bench.cli.commands import COMMANDS
from bench.config.drives.registry import drive_kind
from tests.docs.documents import DOCUMENTS, GENERATED, commands_in, name_of, text_of
from tests.paths import ROOT

MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
TARGETS = set(re.findall(r"^([a-z-]+):.*##", MAKEFILE, re.MULTILINE))
COMMAND_LINES = sorted({(name_of(file), line) for file in DOCUMENTS for line in commands_in(text_of(file))})


def test_the_readme_is_short() -> None:
    lines = text_of(ROOT / "README.md").splitlines()
    assert len(lines) <= 120
    assert max(map(len, lines)) <= 120


@pytest.mark.parametrize("file", DOCUMENTS, ids=name_of)
def test_links_lead_to_files(file: Path) -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", text_of(file)):
        path = link.partition("#")[0]
        if path and ":" not in link:
            target = (file.parent / path).resolve()
            is_written_later = GENERATED in target.parents and "`make docs`" in text_of(file)
            assert target.exists() or is_written_later, link


@pytest.mark.parametrize("folder", ["bench", "compensator", "drivers", "sim_backend", "tests", "docs"])
def test_documents_that_programs_name_are_there(folder: str) -> None:
    for file in (ROOT / folder).rglob("*.py"):
        for path in re.findall(r"\bdocs/[\w/-]+\.md", file.read_text(encoding="utf-8")):
            assert (ROOT / path).is_file(), (name_of(file), path)


def _texts_of(file: Path) -> list[str]:
    """What a program may print: its strings, and of commands the docstrings, too, which are their help."""
    nodes = list(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))
    is_help = file.name == "device.py" or "cli" in file.parts
    remarks = set() if is_help else {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    texts = [node for node in nodes if isinstance(node, ast.Constant) and id(node) not in remarks]
    return [node.value for node in texts if isinstance(node.value, str)]


@pytest.mark.parametrize("folder", ["bench", "compensator", "drivers", "sim_backend", "web"])
def test_nothing_printed_sends_a_user_to_a_document(folder: str) -> None:
    """Users of the wheel have no folder of documents."""
    texts = {name_of(file): _texts_of(file) for file in (ROOT / folder).rglob("*.py")}
    pages = [file for end in ("js", "html") for file in (ROOT / folder).rglob(f"*.{end}")]
    texts |= {name_of(file): re.sub(r"(?m)//.*$", "", text_of(file)).splitlines() for file in pages}
    assert texts
    assert [(name, text) for name, each in texts.items() for text in each if re.search(r"\bdocs/.+\.md", text)] == []


@pytest.mark.parametrize("file", DOCUMENTS, ids=name_of)
def test_targets_of_make_are_there(file: Path) -> None:
    named = re.findall(r"(?:`|^ {4})make ((?:[a-z]+-?)+)", text_of(file), re.MULTILINE)
    assert set(named) <= TARGETS


def test_every_target_of_make_is_explained() -> None:
    phony = re.search(r"\.PHONY: ((?:.*\\\n)*.*)", MAKEFILE)
    assert phony is not None
    assert set(phony[1].replace("\\\n", "").split()) == TARGETS


def test_there_are_commands_in_the_documents() -> None:
    assert len(COMMAND_LINES) > 50


@pytest.mark.parametrize(("place", "line"), COMMAND_LINES)
def test_commands_and_options_are_there(place: str, line: str) -> None:
    words = shlex.split(line)[1:]
    while words and words[0].startswith("--"):  # what stands before every command takes a value
        assert words[0] in ("--config", "--store", "--log", "--help"), place
        words = words[2:]
    if not words or words[0].isupper():
        return
    command = next(ListedCommand(entry).loaded for entry in COMMANDS if entry.name == words[0])
    words = words[1:]
    while isinstance(command, TyperGroup) and words and not words[0].startswith("--"):
        command = command.get_command(typer.Context(command), words.pop(0))
        assert command is not None, place
    known = {"--help"} | {option for parameter in command.params for option in parameter.opts}
    assert {word.partition("=")[0] for word in words if word.startswith("--")} <= known, place


OUR_KINDS = sorted({file.parent.name for file in (ROOT / "bench" / "drives").glob("*/kind.py")} - {"sim"})
REAL_DRIVE = "docs/how-to/real-drive.md"


def test_the_guide_says_how_fast_the_first_trial_is() -> None:
    assert "out at 0.5 to 1 rad/s, back at `motion.speed_rad_s`" in " ".join(text_of(ROOT / REAL_DRIVE).split())


@pytest.mark.parametrize("guide", [*(f"docs/how-to/{kind}.md" for kind in OUR_KINDS), REAL_DRIVE])
def test_the_first_trial_on_a_real_drive_is_slow(guide: str) -> None:
    trials = [line for place, line in COMMAND_LINES if place == guide and " run steps" in line]
    assert trials, f"{guide} has no first trial: a line with `friction-bench ... run steps`"
    assert all("--fastest-rad-s 1" in line for line in trials), trials
    text = text_of(ROOT / guide)
    assert guide == REAL_DRIVE or "(real-drive.md#first-trial)" in text, f"{guide} does not link to the first trial"
    assert "stand clear" in text.lower(), f"{guide} tells nobody to stand clear"


@pytest.mark.parametrize("kind", OUR_KINDS)
def test_a_kind_of_drive_stands_in_both_tables_of_hardware(kind: str) -> None:
    """A kind without a watchdog is marked in both."""
    assert (ROOT / "examples" / kind / "bench.toml").is_file()
    unwatched = not all(way.has_watchdog for way in drive_kind(kind).conformance)
    for file, name in (("README.md", f"(`{kind}`)"), (REAL_DRIVE, f"]({kind}.md)")):
        cells = [line.split("|")[1] for line in text_of(ROOT / file).splitlines() if line.startswith("|")]
        found = [cell for cell in cells if name in cell]
        assert len(found) == 1, f"one row of {file} has to begin with {name}"
        assert ("no watchdog" in found[0]) is unwatched, found[0]


def test_the_release_is_described() -> None:
    changes = text_of(ROOT / "CHANGELOG.md")
    assert re.findall(r"^## \[([^\]]+)\]", changes, re.MULTILINE)[:2] == ["Unreleased", bench.__version__]
    citation = yaml.safe_load(text_of(ROOT / "CITATION.cff"))
    assert citation["version"] == bench.__version__
    assert citation["license"] == "Apache-2.0"


def test_pre_commit_runs_what_make_check_runs() -> None:
    recipe = re.search(r"^check:.*\n((?:\t.*\n)+)", MAKEFILE, re.MULTILINE)
    assert recipe is not None
    checks = [line.strip().replace("$(BIN)", ".venv/bin") for line in recipe[1].splitlines()]
    hooks = yaml.safe_load(text_of(ROOT / ".pre-commit-config.yaml"))["repos"][0]["hooks"]
    assert [hook["entry"] for hook in hooks] == checks


@pytest.mark.parametrize("file", sorted((ROOT / "docs" / "decisions").glob("0*.md")), ids=name_of)
def test_a_decision_is_one_page(file: Path) -> None:
    text = text_of(file)
    assert len(text.splitlines()) <= 40
    assert re.findall(r"^## (.*)$", text, re.MULTILINE) == ["Context", "Decision", "Consequences"]
