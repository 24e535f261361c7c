"""A finding beside the answer of a diagnosis: a code for programs, its numbers, and one sentence for people."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

NoteCode = Literal[
    "absorbed",
    "also-missing",
    "at-rest",
    "differs-by-run",
    "helps",
    "recurs",
    "rings",
    "structure-remains",
    "swings",
    "too-few-starts",
    "unexplained-remains",
    "wanders",
]
"""
absorbed: a term that the model has may be an effect that hides in it.
also-missing: another family of effects has something missing, too.
at-rest: the joint at rest contradicts the model.
differs-by-run: a constant differs from run to run.
helps: an effect lowers the held-out error well and for sure, though noise alone would look as strong.
recurs: with the effect named, what is left comes back with the position.
rings: with it, what is left has a resonance.
structure-remains: with it, structure over a variable remains.
swings: with it, what is left swings at one frequency.
too-few-starts: starts from rest are too few to name anything.
unexplained-remains: with it, more than noise is left, over no variable that is measured.
wanders: with it, something constant differs for seconds at a time.
"""

Value = float | str | bool


@dataclass(frozen=True, slots=True)
class Note:
    """One finding.

    Attributes:
        code: of what was found.
        text: the same in one sentence.
        values: its numbers and names, the unit in the key.
    """

    code: NoteCode
    text: str
    values: Mapping[str, Value] = field(default_factory=dict)

    def __str__(self) -> str:
        return self.text
