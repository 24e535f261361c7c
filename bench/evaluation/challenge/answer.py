"""The answer to a challenge: what is hidden, how much of it, and what share of the effort it makes."""

from dataclasses import asdict, dataclass
from typing import Any

from bench.json_types import Values


@dataclass(frozen=True, slots=True)
class Truth:
    """One hidden mechanism.

    Attributes:
        name: of the mechanism; title: in words.
        size: how much of it; measure: of what; unit: of the size.
        share: RMS of what it changes in the motor current over the current's RMS, 0..1.
        parameters: of the plant, that make it.
        share_at_most: the same with what two runs differ by anyway; None in answers of earlier versions.
    """

    name: str
    title: str
    size: float
    measure: str
    unit: str
    share: float
    parameters: Values
    share_at_most: float | None = None


@dataclass(frozen=True, slots=True)
class Answer:
    """The whole answer.

    Attributes:
        seed, difficulty: of the challenge.
        attempt: how many joints were drawn before one that completed the protocol.
        truths: what is hidden; none where nothing is.
        plant: all parameters of the plant.
    """

    seed: int
    difficulty: str
    attempt: int
    truths: tuple[Truth, ...]
    plant: Values

    def to_json(self) -> dict[str, object]:
        """Nested dicts."""
        return asdict(self)

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> "Answer":
        """From nested dicts."""
        return cls(**{**values, "truths": tuple(Truth(**one) for one in values["truths"])})
