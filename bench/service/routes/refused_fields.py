"""What the limits of the bench refuse, told at the parameter that it is about."""

import re
from collections.abc import Iterator
from contextlib import contextmanager

from bench.errors import ConfigurationError, LimitError, OutOfRange
from bench.experiments.kind import ExperimentKind
from bench.service.http.problems import FieldProblem, InvalidFieldsError


@contextmanager
def told_at_its_fields(kind: ExperimentKind) -> Iterator[None]:
    """Name the parameters of a kind that a refusal is about.

    Raises:
        InvalidFieldsError: with each of them; none, where the refusal is about the bench itself.
    """
    try:
        yield
    except (LimitError, ConfigurationError) as error:
        raise InvalidFieldsError(str(error), type(error).__name__, _fields_of(error, kind)) from error


def _fields_of(error: LimitError | ConfigurationError, kind: ExperimentKind) -> list[FieldProblem]:
    found = error.out_of_range if isinstance(error, LimitError) else None
    # messages of limits begin with the quantity: "angle_rad is ...", "a load of loads_kg is ..."
    quantity, is_one, _ = str(error).partition(" is ")
    if not is_one:
        return []
    # not of another thing: of `motion.speed_rad_s` the configuration is to be changed, not the parameter `speed_rad_s`
    names = [name for name in kind.parameters.model_fields if re.search(rf"(?<![\w.]){name}(?!\w)", quantity)]
    if found is not None and len(names) == 1 and re.fullmatch(rf"(an? \w+ of )?{names[0]}", found.quantity):
        return [_with_numbers(f"parameters.{names[0]}", str(error), found)]
    # of a product or a sum of parameters the value found is none of theirs
    return [FieldProblem(field=f"parameters.{name}", message=str(error)) for name in names]


def _with_numbers(field: str, message: str, found: OutOfRange) -> FieldProblem:
    bounds = {"ge": found.low, "le": found.high, "margin": found.margin or None}
    allowed = {key: value for key, value in bounds.items() if value is not None}
    return FieldProblem(field=field, message=message, found=found.found, allowed=allowed, unit=found.unit)
