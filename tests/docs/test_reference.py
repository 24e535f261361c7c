"""The generated reference has everything that the program has, and the check of the site sees what is wrong."""

import re
from pathlib import Path
from typing import get_args

import pytest
from pydantic import BaseModel, Field

from bench.cli.commands import COMMANDS
from bench.config.configuration import BenchConfiguration
from bench.drives.sim.settings import FaultSettings
from bench.experiments.registry import KINDS
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.recordings.recording import CHANNELS
from docs.generate import command_line, docstrings, effects, experiments, pages, recording_set, rest_interface, site
from docs.generate.schema import keys
from docs.generate.settings import bench_toml
from tests.docs.documents import text_of
from tests.paths import ROOT


def test_every_command_has_a_section_with_its_options() -> None:
    page = command_line.page()
    for entry in COMMANDS:
        assert f"\n## `friction-bench {entry.name}`\n" in page
    assert "\n### `friction-bench study diagnose`\n" in page
    assert "* `--hold-out" in page


def test_every_route_has_a_section() -> None:
    written = "".join(rest_interface.pages().values())
    for path, item in rest_interface.document()["paths"].items():
        for method in item:
            assert f"\n## `{method.upper()} {path}`\n" in written


def test_every_setting_stands_with_unit_and_default() -> None:
    page = bench_toml()
    for section in BenchConfiguration.model_fields:
        assert f"[{section}]" in page or f"`{section}`" in page
    assert "| `period_s` | `s` | `0.005` | number; at least 0.0005; at most 0.1 | Control period |" in page
    assert "## `[drive]` of kind `canopen`" in page
    assert "## `[master.rig]`\n\nThe master's joint; that of the slave where left out." in page


def test_every_effect_and_every_kind_is_there() -> None:
    of_effects, of_kinds = effects.page(), experiments.page()
    assert all(f"\n## {effect.title}\n" in of_effects for effect in catalogue().values())
    assert all(f"\n## {kind.title}\n" in of_kinds for kind in KINDS.values())


def test_the_table_of_columns_is_that_of_the_program() -> None:
    table = recording_set.channels()
    assert all(f"| `{name}` |" in table for name in CHANNELS)
    page = text_of(ROOT / "docs" / "reference" / "recording-set.md")
    assert table in page, f"write this into docs/reference/recording-set.md:\n{table}"


def test_the_guide_to_faults_names_every_kind_and_its_key() -> None:
    page = text_of(ROOT / "docs" / "how-to" / "faults.md")
    for one in FaultSettings.__subclasses__():
        [kind] = get_args(one.model_fields["kind"].annotation)
        own = one.model_fields.keys() - FaultSettings.model_fields.keys() - {"kind"}
        assert re.search(rf"^\| `{kind}` \| .* \| {''.join(f'`{name}` ' for name in own)}\|$", page, re.MULTILINE), kind


class Painted(BaseModel):
    """With what a table of keys has to say."""

    colour: str = "red"
    layers: list[int] = Field(description="One | two", json_schema_extra={"unit": "um"}, min_length=1)


def test_a_table_of_keys() -> None:
    assert keys(Painted.model_json_schema()).splitlines() == [
        "| key | unit | default | allowed | meaning |",
        "| --- | --- | --- | --- | --- |",
        '| `colour` |  | `"red"` | text |  |',
        "| `layers` | `um` | required | list of whole number; entries: at least 1 | One \\| two |",
    ]


def test_pages_that_are_no_longer_made_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pages, "pages", lambda: {"a/one.md": "1", "two.txt": "2"})
    pages.write(tmp_path)
    (tmp_path / "a" / "old.md").write_text("left over")
    pages.write(tmp_path)
    assert sorted(str(file.relative_to(tmp_path)) for file in tmp_path.rglob("*.*")) == ["a/one.md", "two.txt"]


def test_docstrings_become_restructured_text() -> None:
    lines = ["With |x| and `a|b`.", "", "    code |y|", "", "Args:", "    n: a * b.", "        More.", ""]
    assert list(docstrings.restructured(lines)) == [
        "With \\|x\\| and `a|b`.", "", "::", "", "    code |y|", "", "Args:", "    n: a \\* b.", "        More.", "",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("page", "wrong"),
    [
        ('<a href="other.html">', ""),
        ('<a href="other.html#there">', ""),
        ('<a href="https://example.org/x.html#y">', ""),
        ('<a href="missing.html">', "index.html: missing.html: there is no such file"),
        ('<a href="other.html#gone">', "index.html: other.html#gone: there is no such place on that page"),
        ('<script src="https://cdn.org/a.js">', "index.html: loads https://cdn.org/a.js from elsewhere"),
        ('<link rel="stylesheet" href="//cdn.org/a.css">', "index.html: loads //cdn.org/a.css from elsewhere"),
    ],
)  # fmt: skip
def test_the_site_is_checked(tmp_path: Path, page: str, wrong: str) -> None:
    (tmp_path / "index.html").write_text(page)
    (tmp_path / "other.html").write_text('<h1 id="there">')
    assert site.problems(tmp_path) == [wrong] * bool(wrong)


def test_a_site_without_pages_is_wrong(tmp_path: Path) -> None:
    assert site.problems(tmp_path) == [f"{tmp_path}: no page is there; build the documents first"]
