"""What is missing in a model, how sure that is, and what adding it would bring."""

from typing import Literal

from pydantic import Field

from bench.json_types import Number, Numbers
from bench.study.models.base import LEAST_P, StudyModel
from compensator.lab.diagnosis.note import NoteCode

Verdict = Literal["missing", "nothing", "unknown-effect", "data-problem"]
ConclusionCode = Literal[
    "missing", "likely", "nothing", "not-confirmed", "too-short", "unexplained", "unknown-effect", "data-problem"
]
FindingCode = NoteCode | Literal["data-problem", "few-trials", "not-judged", "recorded-once"]
Joint = Literal["here", "elsewhere", "nowhere"]
Value = float | str | bool
ORDER = "those named, then those confirmed by their own numbers, then by score"


class Finding(StudyModel):
    """Something found beside the answer: a code for programs, its numbers, and the same in one sentence."""

    code: FindingCode = Field(examples=["not-judged"])
    values: dict[str, Value] = Field(
        description="names and numbers that the sentence is made of, SI", examples=[{"effect": "viscous_temperature"}]
    )
    text: str


class Conclusion(StudyModel):
    """The answer itself, finer than the verdict: a code for programs, its numbers, and the same in one sentence."""

    code: ConclusionCode = Field(
        description="of the verdict `nothing`: nothing that these trials can show; an effect is likely, but its gain "
        "on other trials is not sure; more than noise, but no effect is confirmed; trials too short; or something is "
        "left that nothing explains; else as the verdict"
    )
    values: dict[str, Value] = Field(description="names and numbers that the sentence is made of, SI")
    text: str


class EffectClass(StudyModel):
    """Effects that these data cannot tell apart."""

    effects: list[str]
    sentence: str
    separating_trial: str | None = Field(description="the trial that would tell them apart")


class Picture(StudyModel):
    """Why: the residual against the effect's driving variable, and the effect's curve over it."""

    driver: str
    unit: str
    against_motion: bool = Field(description="True where the residual is counted positive against the motion")
    x: Numbers
    residual: Numbers
    low: Numbers
    high: Numbers
    curve_x: Numbers
    curve: Numbers


class Ranked(StudyModel):
    """One effect of the ranking.

    Held-out errors are relative (0..1); gain is their fall, each row counting by how well it is known.
    """

    effect: str
    title: str
    score: Number
    p_value: Number = Field(description=f"of so much for any effect that was tried, if nothing were missing; {LEAST_P}")
    held_out_before: Number
    held_out_after: Number
    gain: Number
    gain_low: Number
    gain_high: Number
    in_class: bool = Field(description="one of the effects that the data name")
    confused_with: list[str]
    d_prime: Number = Field(description="how well it stands apart from its best rival; from 6 on the name is sure")
    physical: bool = Field(
        description="False where size, sign or shape are such that it cannot be what is missing: `badge` says which"
    )
    badge: str = Field(
        description="that in two or three words; empty where it can be what is missing", examples=["known from the rig"]
    )
    why_not: list[str] = Field(
        description="why it is not named: what it lacks, or where it lacks nothing, what is to be added first; of one "
        "that is named, what it lacks beside the one that it cannot be told from",
        examples=[["may be luck (p = 0.57)", "gain not sure"], ["viscous_asymmetry first"]],
    )
    sentence: str
    picture: Picture | None


class ProvisionalTerm(StudyModel):
    """A curve over the variable that something unknown varies with; held-out errors are relative (0..1)."""

    effect: str = Field(description="to be added like any effect", examples=["curve_of_temperature_against_motion"])
    title: str
    held_out_before: Number
    held_out_after: Number
    gain: Number
    gain_low: Number
    gain_high: Number
    sentence: str
    picture: Picture | None


class Diagnosis(StudyModel):
    """Is anything missing, what is it called, and does it help?"""

    study_id: int
    model_id: int
    verdict: Verdict = Field(
        description="what kind of answer it is; 'nothing' also where more than noise is left that nothing explains: "
        "the code of `conclusion` is then 'unexplained'"
    )
    sentence: str
    p_value: Number = Field(
        description=f"chance of such evidence in any of a diagnosis's screenings if nothing were missing; {LEAST_P}"
    )
    notes: list[str] = Field(description="sentences; `findings` has them with their codes")
    data_problems: list[str]
    classes: list[EffectClass]
    held_out_kind: str = Field(description="hold-out, leave-one-trial-out or leave-one-block-out")
    ranking: list[Ranked] = Field(description=f"of all families of effects, {ORDER}")
    slight: bool = Field(
        description="what is named is next to nothing beside what effects that were added explain: it may be what "
        "their formulas leave, and is no reason to add another"
    )
    advice: str = Field(description="what that means, in a sentence; empty where it is not slight")
    provisional: ProvisionalTerm | None = Field(description="null unless the verdict is unknown-effect")
    joint: Joint = Field(
        description="where more can be recorded: on a bench of this store, where the recordings were imported from, or "
        "nowhere, of the joint of a challenge"
    )
    conclusion: Conclusion
    findings: list[Finding] = Field(
        description="all that stands beside the answer, each once: problems of the data, notes, effects not judged"
    )

    @property
    def offered(self) -> str | None:
        """The effect, or the curve in its place, that is offered to be added; None where none is."""
        if self.classes and not self.slight:
            return self.classes[0].effects[0]
        return self.provisional.effect if self.provisional else None

    @property
    def helps(self) -> str | None:
        """The effect that lowers the held-out error for sure, and may be luck; None where there is none."""
        return next((str(one.values["effect"]) for one in self.findings if one.code == "helps"), None)


class NotDiagnosed(StudyModel):
    """A study whose newest model cannot be judged, and why."""

    study_id: int
    model_id: int
    error: str
