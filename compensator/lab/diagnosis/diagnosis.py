"""What a diagnosis says; how it is found is in `diagnose`."""

from dataclasses import dataclass, field
from typing import Literal

from compensator.lab.diagnosis.note import Note
from compensator.lab.effects.effect import Effect, MotionRows, Shape
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain
from compensator.lab.rows.picture import BinnedMean
from compensator.lab.screening.evidence import Evidence

JudgedRows = Literal[MotionRows, "breakaway"]
Verdict = Literal["missing", "nothing", "unknown-effect", "data-problem"]


@dataclass(frozen=True)
class Picture:
    """Why: what the effect has to explain against its driving variable, and the effect's own curve over it.

    Attributes:
        driver: key of `DRIVERS`.
        against_motion: values are counted positive against the motion, as friction is.
        residual: partial residual: what the model with the effect leaves, plus the effect.
        curve: the effect alone, in the same bins.
    """

    driver: str
    against_motion: bool
    residual: BinnedMean
    curve: BinnedMean


@dataclass(frozen=True)
class Candidate:
    """One effect that may be missing.

    Attributes:
        effect: which; shape: its best nonlinear shape.
        score: evidence for naming, in units of 2 ln L after the price of parameters and shapes.
        p_value: chance of so much evidence for any effect that was tried, if nothing were missing.
        detectability: d', how far the data can tell it from its nearest rival.
        rivals: effects whose evidence mostly vanishes once this one is in the model.
        before, after: relative held-out error without and with it.
        gain: relative fall of that error, rows counting by how well the other trials can predict them.
        picture: why.
        refused: why it is not the answer though its own numbers confirm it; empty where nothing speaks against it.
        evidence: what the rows say for it; None of starts from rest.
        explained: the model with it; None of starts from rest.
        impossible: why its size, sign or shape are not physical, in words; empty where they are.
        badge: the same in two or three words.
        rows: on which it was judged: for "breakaway", errors and picture are of the effort of breaking away.
    """

    effect: Effect
    shape: Shape
    score: float
    p_value: float
    detectability: float
    rivals: tuple[str, ...]
    before: float
    after: float
    gain: Gain
    picture: Picture | None
    rows: JudgedRows = "sliding"
    refused: str = ""
    impossible: str = ""
    evidence: Evidence | None = field(default=None, repr=False)
    explained: Fit | None = field(default=None, repr=False)
    badge: str = ""

    @property
    def physical(self) -> bool:
        """Whether size, sign and shape are such that it can be the effect."""
        return not self.impossible


@dataclass(frozen=True)
class Diagnosis:
    """The answer.

    Attributes:
        verdict: what kind of answer it is; "data-problem": the data are wrong, and nothing is ranked.
        sentence: the answer in words.
        p_value: chance of evidence as strong as the best one's if nothing were missing; NaN where nothing was judged.
        classes: effects that these trials cannot tell apart, best first; the first is the answer.
        candidates: ranked.
        driver: for "unknown-effect", what the residual varies with.
        data_problems: sentences.
        notes: findings beside the answer.
        left_out: effect -> why it could not be judged.
        too_short: there are too few independent stretches for anything to be sure, so that ranks mean nothing.
        remains: something is left that nothing named explains: a curve that no effect follows, or more than noise.
    """

    verdict: Verdict
    sentence: str
    p_value: float
    classes: list[tuple[str, ...]]
    candidates: list[Candidate]
    driver: str | None = None
    data_problems: list[str] = field(default_factory=list)
    notes: list[Note] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)
    too_short: bool = False
    remains: bool = False

    @property
    def named(self) -> tuple[str, ...]:
        """Effects of the class that is named, without those that no trial can tell from it; none where none is."""
        judged = {one.effect.name for one in self.candidates}
        return tuple(name for name in self.classes[0] if name in judged) if self.verdict == "missing" else ()
