"""What all answers of a study share: how they show themselves, names of roles, the quantity that is explained."""

from collections.abc import Callable, Mapping
from html import escape
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from compensator.lab.chance import LEAST_STATED

LONGEST = 80  # characters of a cell in a notebook
LEAST_P = f"{LEAST_STATED:g} stands for that and less: no smaller chance can be known"


ROWS_IN_WORDS = {"sliding": "steady sliding", "moving": "near reversals too", "all": "at rest too"}
"""Which rows an error is of: each holds those before it."""
NEAR_REVERSALS, STARTS = "near reversals", "at starts from rest"

Condition = float | str | bool
Role = Literal["training", "held_out"]


def short(value: object) -> str:
    """A cell: numbers of four digits; of lists only the length."""
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list):
        return f"[{len(value)}]"
    text = "-" if value is None or value == "" else str(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"


def in_a_line(values: Mapping[str, object], cell: Callable[[object], str] = short) -> str:
    """An answer by its sentence; by its values where it has none."""
    told = values.get("sentence") or ", ".join(f"{name}={cell(value)}" for name, value in values.items())
    return f"<{told}>"


def as_table(values: Mapping[str, object], cell: Callable[[object], str] = short) -> str:
    """The same as HTML, a row for each value."""
    rows = "".join(f"<tr><th>{escape(name)}</th><td>{escape(cell(value))}</td></tr>" for name, value in values.items())
    return f"<table>{rows}</table>"


class StudyModel(BaseModel):
    """An answer of a study, or a part of one. It shows itself by its sentence, or as a table in a notebook."""

    model_config = ConfigDict(frozen=True, from_attributes=True)

    def __repr__(self) -> str:
        return in_a_line(dict(self))

    __str__ = __repr__

    def _repr_html_(self) -> str:
        return as_table(dict(self))


class EffortName(StudyModel):
    """The quantity that the models explain."""

    name: str = Field(examples=["torque"])
    unit: str = Field(examples=["N m"])
