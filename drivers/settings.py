"""What the settings of a driver are made of: values with a unit, which forms, help texts and error messages show."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field


class Settings(BaseModel):
    """Values that somebody writes: unknown names are refused, numbers are finite."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def quantity(default: Any, unit: str, description: str, **constraints: Any) -> Any:
    """A pydantic field with a unit; `...` as default makes it required.

    Args:
        default: SI value.
        unit: shown beside the value; "" for a number or a name.
        description: one line for forms and help.
        constraints: `ge`, `le`, `gt`, `lt`, `min_length`, `max_length` ..., as for `pydantic.Field`.
    """
    return Field(default, description=description, json_schema_extra={"unit": unit}, **constraints)
