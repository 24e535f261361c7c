"""What a diagnosis says; how it is found is in `diagnose`."""

import math
from dataclasses import dataclass, field
from typing import Literal

from compensator.lab.diagnosis.note import Note
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.effects.effect import Effect, EffectRows, Shape
from compensator.lab.model.gain import Gain
from compensator.lab.rows.picture import BinnedMean

SLIGHT_GAIN = 0.10  # of the held-out error, at the high end of its interval
SLIGHT_PART = 0.05  # of what effects that were added explain, root mean square: a formula is rarely right to more

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
        p_value: of this effect alone, robust against autocorrelation.
        detectability: d', how far the data can tell it from its nearest rival.
        rivals: effects whose evidence mostly vanishes once this one is in the model.
        before, after: relative held-out error without and with it.
        gain: relative fall of that error, rows counting by how well the other trials can predict them.
        physical: all its coefficients lie within their physical bounds when fitted freely.
        picture: why.
        rows: on which it was judged: for "breakaway", errors and picture are of the effort of breaking away.
        beside_chain: gain beside the chain's columns that it stands in for near reversals (`beside_chain`); None: it
            stands in for none there, or was not confirmed without.
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
    physical: bool
    picture: Picture | None
    rows: EffectRows = "sliding"
    beside_chain: Gain | None = None


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

    def slight_one(self, explained: float) -> Candidate | None:
        """What is named, where it is next to nothing beside what was added; None where it is not slight.

        A formula leaves what it is not right to. With enough rows that is surely there, and some other effect follows
        it best; it is no reason to add that one.

        Args:
            explained: by effects that were added to the first model, root mean square as a share of the effort, held
                out; with 0 nothing is slight.
        """
        if self.verdict != "missing" or not self.classes:
            return None
        one = next((each for each in self.candidates if each.effect.name == self.classes[0][0]), None)
        if one is None or one.gain.high >= SLIGHT_GAIN or _opens_others(one.effect):
            return None
        return one if explained_part(one.before, one.after) < SLIGHT_PART * explained else None


def _opens_others(effect: Effect) -> bool:
    """Whether it is of the measuring chain, and others cannot be judged before it is in the model, as a filter."""
    return effect.pipeline and any(effect.name in other.after for other in catalogue().values())


def explained_part(before: float, after: float) -> float:
    """What took an error from one to the other, root mean square, in their unit; 0 where it rose."""
    return math.sqrt(max(0.0, before**2 - after**2))
