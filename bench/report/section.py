"""What a report is made of."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isfinite, isnan

from bench.json_types import Value
from bench.report.wording import spoken

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
_DARK, _LIGHT = (68, 1, 84), (253, 190, 60)  # of a row of shades: from a dark violet over green to a light orange
_MIDDLE = (33, 145, 140)
MANY_POINTS = 30
Numbers = Sequence[float | None]


@dataclass(frozen=True)
class Line:
    """A line through points; dashed for references. Without a colour it has the next one."""

    name: str
    x: Numbers
    y: Numbers
    dashed: bool = False
    colour: str = ""


@dataclass(frozen=True)
class Points:
    """Points, with bars from low to high where given. Without a colour they have the next one."""

    name: str
    x: Numbers
    y: Numbers
    low: Sequence[float] = ()
    high: Sequence[float] = ()
    colour: str = ""
    in_legend: bool = True


@dataclass(frozen=True)
class Bars:
    """Bars over names, with error bars from low to high where given."""

    name: str
    x: Sequence[str]
    y: Sequence[float]
    low: Sequence[float] = ()
    high: Sequence[float] = ()


@dataclass(frozen=True)
class Figure:
    """One plot: title, axis titles with units, and what is drawn."""

    title: str
    x_title: str
    y_title: str
    drawn: Sequence[Line | Points | Bars]

    def to_plotly(self) -> dict[str, Value]:
        """Data and layout as Plotly takes them."""
        traces = [_trace(one, COLOURS[i % len(COLOURS)]) for i, one in enumerate(self.drawn)]
        return {
            "data": traces,
            "layout": {
                "xaxis": {"title": {"text": spoken(self.x_title)}},
                "yaxis": {"title": {"text": spoken(self.y_title)}},
                "legend": {"orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0},
                "margin": {"l": 70, "r": 20, "t": 30, "b": 60},
                "template": "none",
            },
        }


def shades(count: int) -> list[str]:
    """Colours of a quantity that rises, from dark to light: told apart by lightness too."""
    return [_shade(index / max(count - 1, 1)) for index in range(count)]


def _shade(share: float) -> str:
    low, high, part = (_DARK, _MIDDLE, 2.0 * share) if share < 0.5 else (_MIDDLE, _LIGHT, 2.0 * share - 1.0)
    return "#" + "".join(f"{round(one + part * (two - one)):02x}" for one, two in zip(low, high, strict=True))


def _length(low: float, high: float) -> float | None:
    """Of one side of a bar; None where it is not known: a mean of one value."""
    return high - low if isfinite(high - low) else None


def _known(values: Sequence[float | None]) -> list[float | None]:
    """What is not known as None: JSON has no NaN, and a line is interrupted there."""
    return [None if value is None or isnan(value) else value for value in values]


def _alone(values: Sequence[float | None], colour: str) -> dict[str, Value]:
    """How a line is drawn: a point between two gaps is no line, and has a mark."""
    around = [None, *values, None]
    alone = [around[at] is None and around[at + 2] is None for at in range(len(values))]
    if not any(alone):
        return {"mode": "lines"}
    return {"mode": "lines+markers", "marker": {"color": colour, "size": [6 * one for one in alone]}}


def _trace(one: Line | Points | Bars, colour: str) -> dict[str, Value]:
    common: dict[str, Value] = {"name": one.name, "x": list(one.x), "y": _known(one.y)}
    if not isinstance(one, Bars):
        colour = one.colour or colour
    if isinstance(one, Line):
        look = {"color": colour, "dash": "dash" if one.dashed else "solid"}
        return {**common, "type": "scatter", "line": look, **_alone(_known(one.y), colour)}
    if len(one.low):
        measured = [float(value or 0.0) for value in one.y]
        common["error_y"] = {
            "type": "data",
            "symmetric": False,
            "array": [_length(value, high) for high, value in zip(one.high, measured, strict=True)],
            "arrayminus": [_length(low, value) for low, value in zip(one.low, measured, strict=True)],
        }
    if isinstance(one, Points):
        # many points in one figure: small ones
        marker = {"color": colour, "size": 7 if len(one.x) <= MANY_POINTS else 5}
        return {**common, "type": "scatter", "mode": "markers", "showlegend": one.in_legend, "marker": marker}
    return {**common, "type": "bar", "marker": {"color": colour}}


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
