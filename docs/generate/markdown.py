"""Pieces of Markdown: tables, code, anchors."""

import json
from collections.abc import Iterable, Sequence
from typing import Any


def table(columns: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table; cells are Markdown already."""
    lines = [columns, ["---"] * len(columns), *rows]
    return "\n".join("| " + " | ".join(map(cell, line)) + " |" for line in lines) + "\n"


def cell(value: object) -> str:
    """A cell: one line, with bars that do not end it."""
    return " ".join(str(value).split()).replace("|", "\\|")


def code(value: object) -> str:
    """Text set as code; nothing where there is none."""
    text = str(value)
    return f"`{text}`" if text else ""


def as_json(value: Any) -> str:
    """A value as it is written in JSON, on one line."""
    return json.dumps(value, ensure_ascii=False)


def folded(title: str, language: str, text: str) -> str:
    """A block of code that is shown when its title is clicked."""
    return f"<details><summary>{title}</summary>\n\n```{language}\n{text}\n```\n\n</details>\n"


def anchor(name: str) -> str:
    """The line before a heading that links can name."""
    return f"({name})="
