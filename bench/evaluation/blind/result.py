"""What came of an item: answer of the lab, standing of the truth, and the trials that settle it."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field

from pydantic import ConfigDict, TypeAdapter

Classes = tuple[tuple[str, ...], ...]
_NOTHING_ELSE = ConfigDict(extra="forbid")  # of a file: what another version has written is refused


@dataclass(frozen=True, slots=True)
class Standing:
    """How far one true effect stands out.

    Attributes:
        ratio: r.
        detectability: d'.
        rival: the effect that is most like it.
        smallest: the r that theory needs to find any one of so many effects nine times in ten.
    """

    __pydantic_config__ = _NOTHING_ELSE
    ratio: float
    detectability: float
    rival: str
    smallest: float


@dataclass(frozen=True, slots=True)
class LabAnswer:
    """What the lab says.

    Attributes:
        verdict: of the first diagnosis; "likely" where it names nothing and says that an effect is likely.
        first: the class that it names; empty where it names none.
        named: the class that is named first; where several are searched for, those that are in the model at the end.
        unknown: the last step says that none of the catalogue is it, or that something remains.
        p_value, detectability: of the first diagnosis and its best candidate.
        error: held-out, of the model with all that was named in it.
        ranked: the first three effects of the first diagnosis, named or not; None in older results, which do not tell.
    """

    __pydantic_config__ = _NOTHING_ELSE
    verdict: str
    first: tuple[str, ...]
    named: Classes
    unknown: bool
    p_value: float
    detectability: float
    error: float
    ranked: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Settled:
    """What the lab said before and after the trials that it asked for.

    Attributes:
        rivals: that were to be separated at first.
        before, predicted: smallest d' of the truth, predicted on the trials measured and with the six first suggested;
            0 where it is none of the rivals, so that nothing is predicted of it.
        by_chance: the same with as many trials drawn at random from the same options.
        trials: that were recorded; failed: that did not complete.
        named: the class that is named at the end.
        stated: of each round, the truth's smallest d' as it was predicted, and as it came; 0 where it is no rival, or
            no candidate.
        promised: as `predicted`, of the d' that nine in ten of the sizes reach that the trials measured allow.
    """

    __pydantic_config__ = _NOTHING_ELSE
    rivals: tuple[str, ...]
    before: float
    predicted: float
    trials: int
    named: tuple[str, ...]
    by_chance: float = 0.0  # not known of older results, as all below
    failed: int = 0
    stated: tuple[tuple[float, float], ...] = ()
    promised: float = 0.0


@dataclass(frozen=True, slots=True)
class Result:
    """What came of an item.

    Attributes:
        key, family: of the item.
        truths: mechanisms hidden; names: what the catalogue calls each, "" where it does not.
        sizes: of the mechanisms.
        answer: of the lab; None where it refused the data, and `refusal` says why.
        standings: of the truths, by the oracle; None where it cannot say.
        unexplained: rms that the base model leaves with the mechanisms over that without them, where that was measured.
        oracle_error: held-out, of the model with the truth in it.
        rivals: rival -> what it names.
        seconds: that the lab took.
        withheld: answer of the lab to the same data where the catalogue has no name for the truth; None: not asked.
        withheld_left: standing of the truth beside what was named in its place; None where the oracle cannot say.
        settled: what came of the trials that the lab asked for; None where it was not asked, or had no rivals.
        laws: r of friction laws that the base model does not have, whatever else is hidden.
        own: what the catalogue calls these laws: names that are right as well.
        confidences: that intervals of the base model's parameters take to reach the truth, where that is known.
    """

    __pydantic_config__ = _NOTHING_ELSE
    key: str
    family: str
    truths: tuple[str, ...]
    names: tuple[str, ...]
    sizes: tuple[float, ...]
    answer: LabAnswer | None
    standings: tuple[Standing | None, ...]
    unexplained: float | None
    oracle_error: float
    rivals: dict[str, tuple[str, ...]] = field(default_factory=dict)
    seconds: float = 0.0
    refusal: str = ""
    settled: Settled | None = None
    withheld: LabAnswer | None = None
    withheld_left: Standing | None = None
    laws: float = 0.0
    own: tuple[str, ...] = ()
    confidences: tuple[float, ...] = ()

    def to_json(self) -> dict[str, object]:
        """Nested dicts."""
        return asdict(self)

    @classmethod
    def from_json(cls, values: Mapping[str, object]) -> "Result":
        """From nested dicts."""
        return _RESULT.validate_python(values)


_RESULT = TypeAdapter(Result)
