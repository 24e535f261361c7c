"""The tree keeps to its limits: `python -m tests.house -v` shows where it does not."""

import pytest

from tests import house
from tests.house import Figure, figures


def test_the_tree_keeps_to_its_limits() -> None:
    over = [figure for figure in figures() if not figure.is_kept]
    assert over == [], "\n".join(example for figure in over for example in (figure.name, *figure.examples))


def test_what_is_above_its_limit_is_marked(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(house, "figures", lambda: [Figure("lines", 20, 20), Figure("folders", 3, 2, ("bench: 3",))])
    assert house.main() == 1
    lines, folders, place = capsys.readouterr().out.splitlines()
    assert "NOT KEPT" not in lines
    assert folders.endswith("at most 2   NOT KEPT")
    assert place.strip() == "bench: 3"
