"""The record of what was found, how, and how sure it is."""

from collections.abc import Iterator

from pydantic import BaseModel, ConfigDict, Field

from bench.json_types import Value, Values, number
from compensator.line_fit import Interval


class Finding(BaseModel):
    """One thing that was found."""

    model_config = ConfigDict(frozen=True)

    name: str = Field(description="Key of bench.toml, or what it is")
    value: float | str
    unit: str = ""
    low: float | None = Field(default=None, description="End of the 95 % interval; null where there is none")
    high: float | None = None
    how: str = Field(description="From what it was told")
    experiment_id: int | None = Field(default=None, description="Record of the motion that told it")


class Evidence:
    """What was found so far, in order."""

    def __init__(self) -> None:
        self._findings: list[Finding] = []

    def __iter__(self) -> Iterator[Finding]:
        return iter(self._findings)

    def add(self, name: str, value: float | str, unit: str, how: str, experiment_id: int | None = None) -> None:
        """Keep something without an interval."""
        self._findings.append(Finding(name=name, value=value, unit=unit, how=how, experiment_id=experiment_id))

    def add_interval(self, name: str, found: Interval, unit: str, how: str, experiment_id: int | None = None) -> None:
        """Keep something with its interval; its note goes to how it was told."""
        ends = {} if found.low != found.low else {"low": found.low, "high": found.high}
        told = f"{how}; {found.note}" if found.note else how
        self._findings.append(
            Finding(name=name, value=found.value, unit=unit, how=told, experiment_id=experiment_id, **ends)
        )


def interval(results: Values, name: str) -> Interval:
    """A result [value, low, high, note] of an experiment as an interval; NaN for what is not known.

    Raises:
        TypeError: the result is no such list.
    """
    found = results[name]
    if isinstance(found, str) or not isinstance(found, list | tuple):
        raise TypeError(f"{name} is {found!r}; [value, low, high, note] is wanted")
    value, low, high, note = found
    return Interval(_number(value), _number(low), _number(high), str(note))


def _number(value: Value) -> float:
    return float("nan") if value is None else number(value)
