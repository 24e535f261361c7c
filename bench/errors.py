"""Errors of the bench.

Each message names the file or the quantity, what was found, what is allowed, the unit and the
next step. Each class has the matching builtin as a second base.
"""

from dataclasses import dataclass


class BenchError(Exception):
    """Base of all errors of the bench. Raised only through a subclass."""


class ConfigurationError(BenchError, ValueError):
    """Raised when a configuration or a rig cannot be used.

    - a file that is missing or is no TOML
    - an unknown key, a value of the wrong type or out of range
    - a value that is needed and was left out (a torque constant, an arm length)
    """


class ParameterError(BenchError, ValueError):
    """Raised before motion when the parameters of an experiment are unknown, of the wrong type or out of range."""


@dataclass(frozen=True, slots=True)
class OutOfRange:
    """A quantity outside its bounds, as numbers: for who shows it in other units than the message has.

    Attributes:
        quantity: in words, with the name of the parameter ("a load of loads_kg").
        found: the value, in `unit`.
        unit: SI unit; "" where the quantity has none.
        low, high: least and greatest value allowed, in `unit`; None where there is no such bound.
        margin: what the bounds keep from the limits of the bench, in `unit`.
    """

    quantity: str
    found: float
    unit: str
    low: float | None = None
    high: float | None = None
    margin: float = 0.0


class LimitError(BenchError, ValueError):
    """Raised before motion when what is asked lies outside the limits of the bench.

    Attributes:
        out_of_range: what the message says, as numbers; None where it is about something else than one quantity.
    """

    def __init__(self, message: str, out_of_range: OutOfRange | None = None) -> None:
        super().__init__(message)
        self.out_of_range = out_of_range


class LimitTrip(BenchError, RuntimeError):
    """Raised during motion when a measured quantity leaves its limits; the loop powers off."""


class ExperimentError(BenchError, RuntimeError):
    """Raised by a procedure that cannot go on: the joint does not settle, a search ends without an estimate."""


class RecordingError(BenchError, OSError):
    """Raised when the rows of a running trial cannot be kept; the loop powers off."""


class BusyError(BenchError, RuntimeError):
    """Raised when an experiment is started while another one runs."""


class NotCommissionedError(BenchError, RuntimeError):
    """Raised when a real drive is to be used that has not passed the commissioning move with this configuration."""


class FaultChangedError(BenchError, RuntimeError):
    """Raised when a fault is to be cleared that is not the one that a person has seen."""


class PromptError(BenchError, RuntimeError):
    """Raised when a question is answered that is not the one asked now."""


class UnknownKindError(BenchError, KeyError):
    """Raised when an experiment kind is asked for that is not in the registry."""

    def __str__(self) -> str:
        return Exception.__str__(self)  # KeyError would show the message in quotes


def quantity_message(quantity: str, found: float, allowed: str, unit: str, next_step: str = "", why: str = "") -> str:
    """One sentence that names a quantity, what was found, what is allowed and its unit.

    Args:
        quantity: what is out of range, in words ("speed", "load_kg of trial 3").
        found: the value, in `unit`.
        allowed: the allowed range in words and numbers ("at most 2", "-1 .. 1"), in `unit`.
        unit: SI unit; "" where the quantity has none.
        next_step: what the reader can do about it.
        why: where the allowed range comes from, in a few words; in brackets behind it.
    """
    suffix = f" {unit}" if unit else ""
    message = f"{quantity} is {found:.6g}{suffix}; allowed is {allowed}{suffix}{f' ({why})' if why else ''}"
    return f"{message}. {next_step}" if next_step else message


class BaselineError(BenchError, ValueError):
    """Raised when there is no baseline, or one that these measurements cannot be held against."""
