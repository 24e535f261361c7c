"""What a report is made of."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from bench.report.figure import Figure


@dataclass(frozen=True)
class Table:
    """A table. Columns whose name ends in '#' hold numbers and stand to the right."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[object]]


@dataclass(frozen=True)
class Section:
    """One part of a report: a heading, sentences, tables, figures, in this order."""

    title: str
    sentences: Sequence[str] = ()
    tables: Sequence[Table] = ()
    figures: Sequence[Figure] = field(default=())
