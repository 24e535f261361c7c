"""Answers of the service as dicts that show themselves well in a notebook."""

from collections.abc import Iterable, Mapping
from html import escape
from typing import Any

LONGEST = 80  # characters of a cell
SHOWN_ROWS = 20


def short(value: Any) -> str:
    """A cell: short numbers, what is inside of lists and tables only counted."""
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, Mapping):
        return "{" + ", ".join(map(str, value)) + "}" if value else "-"
    if isinstance(value, list):
        return f"[{len(value)}]"
    text = "-" if value is None or value == "" else str(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"


class Answer(dict[str, Any]):
    """One answer; a dict, as the interface describes it."""

    def __repr__(self) -> str:
        if sentence := self.get("sentence"):
            return f"<{sentence}>"
        return "<" + ", ".join(f"{name}={short(value)}" for name, value in self.items()) + ">"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{escape(name)}</th><td>{escape(short(self[name]))}</td></tr>" for name in self)
        return f"<table>{rows}</table>"


class Answers(list[Answer]):
    """A list of answers; a table in a notebook."""

    def __init__(self, items: Iterable[Mapping[str, Any]]) -> None:
        super().__init__(map(Answer, items))

    def _repr_html_(self) -> str:
        if not self:
            return "<p>none</p>"
        head = "".join(f"<th>{escape(name)}</th>" for name in self[0])
        rows = "".join(
            "<tr>" + "".join(f"<td>{escape(short(value))}</td>" for value in one.values()) + "</tr>"
            for one in self[:SHOWN_ROWS]
        )
        more = f"<p>and {len(self) - SHOWN_ROWS} more</p>" if len(self) > SHOWN_ROWS else ""
        return f"<table><tr>{head}</tr>{rows}</table>{more}"
