"""Answers of the service as dicts that show themselves well in a notebook."""

from collections.abc import Iterable, Mapping
from html import escape
from typing import Any

from bench.study.models import base

SHOWN_ROWS = 20


def short(value: object) -> str:
    """As in the answers of a study; of tables only the names."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(map(str, value)) + "}" if value else "-"
    return base.short(value)


class Answer(dict[str, Any]):
    """One answer; a dict, as the interface describes it."""

    def __repr__(self) -> str:
        return base.in_a_line(self, short)

    def _repr_html_(self) -> str:
        return base.as_table(self, short)


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
